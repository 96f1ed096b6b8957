#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# check_library.sh LIBRARY DEVICES HEADER PRIVATE_HDF5: what libpalpate.so exports, contains and needs. DEVICES is
# the archive of the device bindings, HEADER is palpate.h, PRIVATE_HDF5 is TRUE where HDF5 is linked into it.
set -euo pipefail
library=$1 devices=$2 header=$3 private_hdf5=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'libpalpate.so: %s\n' "$*"; exit 1; }

readelf -d "$library" > "$work/dynamic"
grep -q 'SONAME.*libpalpate\.so\.[0-9]*\]' "$work/dynamic" || fail "it has no SONAME"

# The exported symbols are the functions of the header, no more and no fewer.
nm -D --defined-only "$library" | awk '{print $3}' | sort -u > "$work/exported"
grep -ozP 'PALPATE_API[^;(]*\bpalpate_\w+(?=\()' "$header" | tr '\0' '\n' | grep -oP 'palpate_\w+$' | sort -u > "$work/declared"
[ -s "$work/declared" ] || fail "no function found in $header"
diff "$work/declared" "$work/exported" || fail "declared functions (<) and exported symbols (>) differ"

# No function of a device binding is in it. The local symbols are there as the build does not strip.
nm --defined-only "$library" | awk '$2 ~ /[tT]/ {print $3}' | sort -u > "$work/contained"
grep -q ContactState "$work/contained" || fail "its local symbols are stripped: the bindings cannot be looked for"
nm --defined-only "$devices" | awk '$2 == "T" {print $3}' | sort -u > "$work/bindings"
[ "$(wc -l < "$work/bindings")" -gt 50 ] || fail "no functions found in $devices"
strays=$(comm -12 "$work/bindings" "$work/contained" | c++filt)
[ -z "$strays" ] || fail "it contains device bindings: $strays"

# What it needs, directly and in turn: the run-time of the compiler and compression. Where the static HDF5 cannot be
# linked into it, also the shared HDF5 and all that this needs.
allowed='lib(stdc\+\+|gcc_s|m|c|z|sz|aec)\.so(\.[0-9.]+)?|(/.*/)?ld-linux.*|linux-vdso.*'
needed=$(ldd "$library" | awk '{print $1}')
extra=$(grep -vxE "$allowed" <<< "$needed" || true)
[ -z "$extra" ] || [ "$private_hdf5" != TRUE ] || fail "it needs $extra"
echo "libpalpate.so: $(wc -l < "$work/exported") functions exported; needs $(tr '\n' ' ' <<< "$needed")"
