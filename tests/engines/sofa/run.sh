#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# run.sh BUILD SOURCE CMAKE CC CXX WRITE_BODIES SOFA: examples/sofa compiles without warnings with the headers of SOFA, and is a
# plug-in that registers its component. It is not loaded: SOFA itself is not built.
set -euo pipefail
build=$1 source=$2 cmake=$3 cc=$4 cxx=$5 sofa=$7
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for component in runtime development; do
  "$cmake" --install "$build" --component $component --prefix "$work/prefix" > /dev/null
done
"$cmake" -S "$source/examples/sofa" -B "$work/build" -G Ninja -DSOFA="$sofa" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wconversion -Wshadow -Werror" \
  -DCMAKE_PREFIX_PATH="$source/tests/engines/sofa;$work/prefix" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" > "$work/log" ||
  { cat "$work/log"; exit 1; }
"$cmake" --build "$work/build" > "$work/log" || { cat "$work/log"; exit 1; }
nm -D "$work/build/libPalpateSofa.so" > "$work/symbols"
for symbol in initExternalModule getModuleName getModuleVersion registerObjects; do
  grep -q " T $symbol\$" "$work/symbols" || { echo "the plug-in has no $symbol"; exit 1; }
done
for symbol in palpate_step palpate_deform; do
  grep -q " U $symbol\$" "$work/symbols" || { echo "the plug-in does not call $symbol"; exit 1; }
done
echo "sofa: the plug-in compiles with SOFA $(sed -n 's/.*SOFA_VERSION_STR "\(.*\)"/\1/p' "$work/build/sofa/sofa/version.h")"
