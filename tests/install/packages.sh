#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# packages.sh BUILD_FOLDER SOURCE_FOLDER CPACK CC [PYTHON]: makes the Debian packages of a build, unpacks them into a root of their own
# and uses them there: what they need, what they state, the command with its data, and a program built against the
# development package alone.
set -euo pipefail
build=$1 source=$2 cpack=$3 cc=$4 python=${5:-/usr/bin/python3}
examples=$source/examples
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'packages: %s\n' "$*"; exit 1; }

# Packages by xz are smaller, and take as long to compress as all that follows.
(cd "$build" && "$cpack" -G DEB -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -B "$work/packages" > "$work/log" 2>&1) || { cat "$work/log"; exit 1; }
rm -rf "$work/packages/_CPack_Packages"
declare -A file
for deb in "$work"/packages/*.deb; do file[$(dpkg-deb --field "$deb" Package)]=$deb; done
packages=(palpate libpalpate0 libpalpate-dev)
[ -z "${file[python3-palpate]:-}" ] || packages+=(python3-palpate)
for package in "${packages[@]}"; do
  [ -n "${file[$package]:-}" ] || fail "there is no $package among ${!file[*]}"
  dpkg-deb --extract "${file[$package]}" "$work/$package"
  dpkg-deb --extract "${file[$package]}" "$work/root"
done
version=$(dpkg-deb --field "${file[palpate]}" Version)

# Each needs the others of its own version, and of Debian what its programs are linked with.
field() { dpkg-deb --field "${file[$1]}" "$2"; }
field palpate Depends | grep -qF "libpalpate0 (= $version)" || fail "palpate needs $(field palpate Depends)"
field palpate Depends | grep -qE 'libhdf5.*libtet1.5|libtet1.5.*libhdf5' || fail "palpate needs $(field palpate Depends)"
field libpalpate-dev Depends | grep -qF "libpalpate0 (= $version)" || fail "libpalpate-dev needs $(field libpalpate-dev Depends)"
field libpalpate0 Depends | grep -qE 'libc6 \(>= ' || fail "libpalpate0 needs $(field libpalpate0 Depends)"
! field libpalpate0 Depends | grep -qE 'libpalpate|tet|blas' || fail "libpalpate0 needs $(field libpalpate0 Depends)"
dpkg-deb --ctrl-tarfile "${file[libpalpate0]}" | tar -xO ./shlibs | grep -qx "libpalpate 0 libpalpate0 (>= $version)" ||
  fail "libpalpate0 has no shlibs file"

# No file is in two packages, and each has its copyright and changelog.
for package in "${packages[@]}"; do
  (cd "$work/$package" && find . -type f -o -type l) >> "$work/files"
  grep -q "^License: " "$work/$package/usr/share/doc/$package/copyright" || fail "$package has no copyright"
  zcat "$work/$package/usr/share/doc/$package/changelog.gz" | head -n 1 | grep -qF "palpate ($version)" || fail "$package has no changelog"
  [ -n "$(field $package Description | sed 1d)" ] || fail "$package is not described"
done
twice=$(sort "$work/files" | uniq -d)
[ -z "$twice" ] || fail "in two packages: $twice"

# The command finds its libraries, its manual and its completion in that root.
root=$work/root/usr
lib=$(dirname "$(find "$root/lib" -name 'libpalpate.so.0')")
unset LD_LIBRARY_PATH
palpate() { LD_LIBRARY_PATH=$lib "$root/bin/palpate" "$@"; }
palpate --version | grep -qF "$version" || fail "palpate says $(palpate --version)"
palpate play | grep -qE '^  liver +[0-9]+ kB  A ' || fail "it plays: $(palpate play)"
palpate play gel --no-open --out "$work/gel.html" > /dev/null
[ "$(stat -c %s "$work/gel.html")" -gt 100000 ] || fail "its page is empty"
palpate check "$root/share/palpate/bodies/organ.off" > /dev/null || fail "it cannot read its own data"
for command in $(palpate --help | sed -n '/^Subcommands:/,$ s/^  \([a-z]\+\)  .*/\1/p'); do
  zcat "$root/share/man/man1/palpate-$command.1.gz" | grep -q '^\.TH' || fail "no manual page of palpate $command"
done
grep -q '\bplay\b' "$root/share/bash-completion/completions/palpate" || fail "completion does not know play"

# The command without the runtime package does not start, and nothing points into the build.
if readelf -d "$root/bin/palpate" "$lib/libpalpate.so.0" | grep -E 'RPATH|RUNPATH'; then fail "a search path is left"; fi
if grep -rlF "$build" "$root"; then fail "the path of the build is in these files"; fi

# The development package makes a program, and the runtime package alone runs it.
export PKG_CONFIG_PATH=$lib/pkgconfig
"$cc" "$examples/feel.c" $(pkg-config --cflags --libs palpate) -o "$work/feel"
rm -rf "$work/palpate" && said=$(LD_LIBRARY_PATH=$(dirname "$(find "$work/libpalpate0" -name 'libpalpate.so.0')") "$work/feel" \
  "$root/share/palpate/libraries/gel.plib" 0 0 1)
case $said in *" N, 3."*" mm deep") ;; *) fail "the example says: $said" ;; esac

# Python finds the module where its package has it, and reads the libraries of the command.
if [ -n "${file[python3-palpate]:-}" ]; then
  field python3-palpate Depends | grep -qE 'python3 \(<< 3\.[0-9]+\)' || fail "python3-palpate needs $(field python3-palpate Depends)"
  ! field python3-palpate Depends | grep -q libpalpate || fail "python3-palpate needs $(field python3-palpate Depends)"
  folder=$(dirname "$(dirname "$(find "$root/lib" -path '*dist-packages/palpate/__init__.py')")")
  said=$(cd "$work" && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$folder "$python" -c "
import palpate
print(len(palpate.Library('$root/share/palpate/libraries/gel.plib').vertices), palpate.__file__.startswith('$folder'))")
  [ "$said" = "348 True" ] || fail "Python says: $said"
fi

if command -v lintian > /dev/null; then
  lintian --fail-on error --suppress-tags bad-distribution-in-changes-file "$work"/packages/*.deb > "$work/lintian" 2>&1 ||
    { cat "$work/lintian"; fail "lintian finds errors"; }
fi
echo "packages: $(cd "$work/packages" && ls -s --block-size=1K | sed 1d | tr '\n' ';')"
