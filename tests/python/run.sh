#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# run.sh BUILD CMAKE PYTHON SCRIPT ARGUMENT...: installs the Python package under a new prefix and runs a test with it.
set -euo pipefail
build=$1 cmake=$2 python=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cmake" --install "$build" --component python --prefix "$work/prefix" > /dev/null
package=$(find "$work/prefix" -path '*/dist-packages/palpate/__init__.py')
[ -n "$package" ] || { echo "there is no dist-packages/palpate in what was installed"; exit 1; }
cd "$work"
PYTHONPATH=$(dirname "$(dirname "$package")") OPENBLAS_NUM_THREADS=1 "$python" -B -W error "$@"
