#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Each source file states its licence: Apache-2.0 in format/, runtime/, python/ and examples/, AGPL elsewhere.

A file of somebody else stands unchanged in a folder vendor/, with its licence in FILE.license beside it.

Usage: check_spdx.py [ROOT] | --self-test
"""
import subprocess
import sys
from pathlib import Path

from source_check import main

APACHE_ROOMS = ("format", "runtime", "python", "examples")
SUFFIXES = {".hpp", ".h", ".cpp", ".c", ".cmake", ".py", ".pyi", ".js", ".mjs", ".css", ".html", ".sh", ".in"}
SKIPPED = {"build", "out", "node_modules", "install", ".git"}
TAG = "SPDX-License-Identifier: "
LINES_SEARCHED = 3  # a script has its interpreter on the first line


def is_source(path):
    if path.name == "CMakeLists.txt" or path.suffix in SUFFIXES:
        return True
    return path.suffix == "" and path.read_bytes()[:2] == b"#!"


def files_of(root):
    """Files of the project: what git tracks or would track, else everything."""
    listing = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False)
    if listing.returncode == 0:
        names = [Path(name) for name in listing.stdout.decode().split("\0") if name]
    else:
        names = [path.relative_to(root) for path in sorted(root.rglob("*"))]
    for name in names:
        if (root / name).is_file() and not SKIPPED.intersection(name.parts):
            yield name


def fault_of(root, name):
    if not is_source(root / name):
        return None
    if "vendor" in name.parts:
        beside = root / name.with_name(name.name + ".license")
        stated = beside.is_file() and TAG in beside.read_text(encoding="utf-8")
        return None if stated else f"{name}: expected {TAG}... in {name.name}.license"
    expected = "Apache-2.0" if name.parts[0] in APACHE_ROOMS else "AGPL-3.0-or-later"
    head = (root / name).read_text(encoding="utf-8").splitlines()[:LINES_SEARCHED]
    stated = [line.split(TAG)[1].split()[0] for line in head if TAG in line]
    if stated == [expected]:
        return None
    return f"{name}: expected {TAG}{expected}, found {stated[0] if stated else 'none'}"


def faults(root):
    return [fault for fault in (fault_of(root, name) for name in files_of(root)) if fault]


# The check must see each kind of fault, and nothing in sound files.
SAMPLES = {
    "format/good.hpp": "// SPDX-License-Identifier: Apache-2.0\n",
    "app/good.cpp": "// SPDX-License-Identifier: AGPL-3.0-or-later\n",
    "scripts/good": "#!/bin/sh\n# SPDX-License-Identifier: AGPL-3.0-or-later\n",
    "app/vendor/good.js": "// somebody else's\n",
    "app/vendor/good.js.license": "SPDX-License-Identifier: MIT\n",
    "app/vendor/bad.js": "// somebody else's\n",
    "docs/page.md": "no licence line is asked of texts\n",
    "runtime/bad.cpp": "// SPDX-License-Identifier: AGPL-3.0-or-later\n",
    "app/bad.cpp": "// SPDX-License-Identifier: Apache-2.0\n",
    "fem/bad.cpp": "int main() {}\n",
    "scripts/bad": "#!/bin/sh\necho\n",
}
FAULTY = ["app/bad.cpp", "app/vendor/bad.js", "fem/bad.cpp", "runtime/bad.cpp", "scripts/bad"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))
