#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# without_hdf5.sh SOURCE CONSUMER WRITE_PLATE CMAKE CC CXX: a program that was linked without HDF5 renders a flat library,
# refuses an HDF5 file, and the project configures without HDF5.
set -euo pipefail
source=$1 consumer=$2 write_plate=$3 cmake=$4 cc=$5 cxx=$6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ldd "$consumer" | grep -i hdf5; then
  echo "the consumer needs HDF5"
  exit 1
fi
"$write_plate" "$work/plate.plib" 0.3
"$consumer" "$work/plate.plib"

"$write_plate" "$work/plate.h5" 0.3
if said=$("$consumer" "$work/plate.h5" 2>&1); then
  echo "a program without HDF5 accepted an HDF5 file"
  exit 1
fi
case $said in *"is not a flat library (.plib)"*"palpate export runtime"*) ;; *) echo "it says: $said"; exit 1 ;; esac

"$cmake" -G Ninja -S "$source" -B "$work/build" -DPALPATE_HDF5=OFF -DCMAKE_C_COMPILER="$cc" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON > "$work/log" || { cat "$work/log"; exit 1; }
if grep "libhdf5" "$work/build/build.ninja"; then
  echo "the build without HDF5 links it"
  exit 1
fi
echo "install: the runtime works without HDF5"
