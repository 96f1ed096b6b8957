#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# run.sh BUILD SOURCE CMAKE CC CXX WRITE_BODIES CHAI3D CHAI3D_PART SAME_BITS: a tool of CHAI3D has the forces and the skin of the C
# interface; examples/chai3d builds by its CMakeLists.txt and prints what feel.c prints. No display is needed.
set -euo pipefail
build=$1 source=$2 cmake=$3 cc=$4 cxx=$5 write_bodies=$6 chai3d=$7 part=$8 same_bits=$9
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$write_bodies" "$work"
"$same_bits" "$work/plate.plib" "$work/plate.pdef"

for component in runtime development; do
  "$cmake" --install "$build" --component $component --prefix "$work/prefix" > /dev/null
done
"$cmake" -S "$source/examples/chai3d" -B "$work/build" -G Ninja -DCHAI3D_DIR="$source/tests/engines/chai3d" -DCHAI3D="$chai3d" \
  -DCHAI3D_PART="$part" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" > "$work/log" ||
  { cat "$work/log"; exit 1; }
"$cmake" --build "$work/build" > "$work/log" || { cat "$work/log"; exit 1; }
library=$(find "$work/prefix" -name libpalpate.so)
export LD_LIBRARY_PATH=$(dirname "$library")
"$cc" -I"$source/runtime" "$source/examples/feel.c" "$library" -o "$work/feel"
for side in "0 0 1" "0.3 0.2 1"; do
  felt=$("$work/feel" "$source/data/libraries/gel.plib" $side)
  said=$("$work/build/press" "$source/data/libraries/gel.plib" $side)
  [ "${said//-0.0000/0.0000}" = "${felt//-0.0000/0.0000}" ] || { echo "press says $said, feel $felt"; exit 1; }
done
if said=$("$work/build/press" "$source/README.md" 0 0 1 2>&1); then echo "a file that is no library was accepted"; exit 1; fi
case $said in "press: "*"README.md"*) ;; *) echo "press says: $said"; exit 1 ;; esac
echo "chai3d: the forces and the skin are those of the C interface"
