#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# run.sh BUILD_FOLDER SOURCE_FOLDER WRITE_PLATE CMAKE CC CXX PYTHON: install the runtime and its header, move the installed tree, build an
# outside consumer against it with CMake and with pkg-config, and run both.
set -euo pipefail
build=$1 source=$2 write_plate=$3 cmake=$4 cc=$5 cxx=$6 python=$7
examples=$source/../../examples
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for component in runtime development; do
  "$cmake" --install "$build" --component $component --prefix "$work/first" > /dev/null
done
mv "$work/first" "$work/moved"
prefix=$work/moved
"$write_plate" "$work/plate.h5" 0.3

"$cmake" -G Ninja -S "$source/consumer" -B "$work/by_cmake" -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DEXAMPLES="$examples" > "$work/log" || { cat "$work/log"; exit 1; }
"$cmake" --build "$work/by_cmake" > "$work/log" || { cat "$work/log"; exit 1; }
"$work/by_cmake/consumer" "$work/plate.h5"
"$work/by_cmake/consumer_cpp" "$work/plate.h5"

# The examples in C, C++ and Python print the same force, 100 k z^2 along the normal of the plate at depth z.
library=$(find "$prefix" -name 'libpalpate.so')
said=$("$work/by_cmake/feel_c" "$work/plate.h5" 0 0 1)
"$python" - "$said" <<'CHECK' || { echo "the example in C says: $said"; exit 1; }
import re, sys
x, y, z, depth = map(float, re.findall(r"-?[0-9.]+", sys.argv[1]))
sys.exit(not (3 <= depth < 3.1 and x == y == 0 and abs(z - 100 * 170 * (1e-3 * depth) ** 2) < 2e-4))
CHECK
[ "$("$work/by_cmake/feel_cpp" "$work/plate.h5" 0 0 1)" = "$said" ] || { echo "the example in C++ differs"; exit 1; }
[ "$("$python" "$examples/feel.py" "$library" "$work/plate.h5" 0 0 1)" = "$said" ] || { echo "the example in Python differs"; exit 1; }

# The surface of the plate: 9 x 9 vertices at z = 0, 128 triangles of 1 cm legs, normals that point out of it (+z).
"$work/by_cmake/surface_c" "$work/plate.h5" > "$work/plate.obj"
"$python" - "$work/plate.obj" <<'CHECK' || { echo "the surface of the example in C is not the plate"; exit 1; }
import sys
lines = [line.split() for line in open(sys.argv[1])]
v = [tuple(map(float, l[1:])) for l in lines if l[0] == "v"]
n = [tuple(map(float, l[1:])) for l in lines if l[0] == "vn"]
f = [[int(corner.split("//")[0]) - 1 for corner in l[1:]] for l in lines if l[0] == "f"]
def twice_area(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
assert len(set(v)) == 81 and max(x for x, _, _ in v) == 0.08 and all(z == 0 for _, _, z in v)
assert all(normal == (0, 0, 1) for normal in n)
assert len(f) == 128 and all(abs(twice_area(*(v[i] for i in t)) - 1e-4) < 1e-12 for t in f)
CHECK

pc=$(find "$prefix" -name palpate.pc)
export PKG_CONFIG_PATH=$(dirname "$pc")
"$cc" -std=c99 -Wall -Wextra -Wpedantic -Werror "$source/consumer/consumer.c" -o "$work/by_pkg_config" \
  $(pkg-config --cflags --libs palpate) -lm -Wl,-rpath,"$(pkg-config --variable=libdir palpate)"
"$work/by_pkg_config" "$work/plate.h5"
# As README.md says.
"$cc" "$examples/feel.c" $(pkg-config --cflags --libs palpate) -o "$work/feel"
[ "$(LD_LIBRARY_PATH=$(pkg-config --variable=libdir palpate) "$work/feel" "$work/plate.h5" 0 0 1)" = "$said" ]

# The licence comes with the library.
cmp "$(find "$prefix" -path '*/share/doc/palpate/LICENSE')" "$source/../../runtime/LICENSE" || { echo "no licence"; exit 1; }
echo "install: the consumers and the examples run"
