#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# run.sh SOURCE LIBPALPATE CMAKE CC WINE: builds the runtime for Windows by mingw-w64 and a program that steps libraries, and
# compares what it prints under Wine with what the same program prints here: the bits of every force.
set -euo pipefail
source=$1 library=$2 cmake=$3 cc=$4 wine=$5
work=$(mktemp -d)
end() {
  for server in "$(dirname "$(readlink -f "$wine")")"/wineserver*; do "$server" --kill > /dev/null 2>&1 || true; done
  rm -rf "$work"
}
trap end EXIT
export WINEPREFIX=$work/prefix WINEDEBUG=-all
fail() { printf 'windows: %s\n' "$*"; exit 1; }

"$cmake" -S "$source" -B "$work/build" -G Ninja --toolchain "$source/cmake/mingw-w64.cmake" -DPALPATE_HDF5=OFF \
  -DBUILD_TESTING=OFF -DPALPATE_WITH_WASM=OFF -DCMAKE_BUILD_TYPE=Release -DPALPATE_WARNINGS_AS_ERRORS=ON > "$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
"$cmake" --build "$work/build" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
dll=$work/build/bin/libpalpate.dll

# It exports the functions of the header and needs nothing of the compiler.
grep -ozP 'PALPATE_API[^;(]*\bpalpate_\w+(?=\()' "$source/runtime/palpate.h" | tr '\0' '\n' | grep -oP 'palpate_\w+$' | sort -u > "$work/declared"
x86_64-w64-mingw32-objdump -p "$dll" > "$work/headers"
sed -n '/Ordinal\/Name Pointer/,$ s/^\t\[ *[0-9]*\] //p' "$work/headers" | sort -u > "$work/exported"
diff "$work/declared" "$work/exported" || fail "declared functions (<) and exported symbols (>) differ"
strays=$(sed -n 's/^\tDLL Name: //p' "$work/headers" | grep -viE '^(kernel32|msvcrt|ucrtbase|user32|advapi32|api-ms-win-.*)\.dll$' || true)
[ -z "$strays" ] || fail "it needs $strays"

x86_64-w64-mingw32-gcc-posix -std=c11 -D__USE_MINGW_ANSI_STDIO=1 -Wall -Wextra -Werror -I"$source/runtime" "$source/tests/windows/steps.c" \
  -o "$work/steps.exe" "$dll"
cp "$dll" "$work"
"$cc" -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Werror -I"$source/runtime" "$source/tests/windows/steps.c" -o "$work/steps" "$library"
export LD_LIBRARY_PATH=$(dirname "$library")
windows() { "$wine" "$work/steps.exe" "$@" | tr -d '\r'; }

# Libraries that relax use exp() of the C library, which may round otherwise: gel is elastic.
"$work/steps" "$source/data/libraries/gel.plib" > "$work/here"
windows "$source/data/libraries/gel.plib" > "$work/there"
[ "$(wc -l < "$work/here")" -gt 500 ] || fail "too few steps are in contact"
cmp "$work/here" "$work/there" || { diff "$work/here" "$work/there" | head -n 6; fail "the forces differ"; }
# The loop keeps its rate as far as Wine and the load of the machine let it, and never runs ahead.
said=$(windows "$source/data/libraries/liver.plib" loop)
steps=${said%% steps*}
[ "$steps" -gt 50 ] && [ "$steps" -lt 600 ] || fail "the loop says: $said"
if said=$(windows "$source/README.md" 2>&1); then fail "a file that is no library was accepted"; fi
case $said in *"is not a flat library"*) ;; *) fail "it says: $said" ;; esac
echo "windows: $(wc -l < "$work/here") steps have the same bits; the loop: $(windows "$source/data/libraries/gel.plib" loop)"
