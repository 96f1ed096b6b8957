#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Every source has a test of its name at the mirrored place.

Usage: check_tests.py [ROOT] | --self-test

For app/run/x.cpp that is tests/unit/app/run/test_x.cpp. A header counts as a source where no .cpp has its
name. Sources that are tested elsewhere stand in scripts/tested_elsewhere.txt, a line each: a path, which may
hold a *, and behind two blanks where the test is, or why there is none. A line without a source is a fault.
"""
import fnmatch
import sys

from source_check import main

ROOMS = ("format", "mesher", "fem", "fitting", "runtime", "app", "python")
LIST = "scripts/tested_elsewhere.txt"


def sources(root):
    """Names without their endings -> names of the sources."""
    found = {}
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".h") and "vendor" not in path.parts:
                name = path.relative_to(root)
                stem = name.with_suffix("")
                if stem not in found or path.suffix == ".cpp":
                    found[stem] = name
    return found


def exceptions(root):
    """(line, pattern, reason) of the list."""
    file = root / LIST
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines() if file.exists() else [], 1):
        if line.strip() and not line.startswith("#"):
            pattern, _, reason = line.partition("  ")
            yield number, pattern, reason.strip()


def faults(root):
    excused = list(exceptions(root))
    used = set()
    for stem, name in sources(root).items():
        if (root / "tests" / "unit" / stem.parent / f"test_{stem.name}.cpp").exists():
            continue
        matching = [number for number, pattern, _ in excused if fnmatch.fnmatchcase(str(name), pattern)]
        used.update(matching)
        if not matching:
            yield f"{name}: has no tests/unit/{stem.parent}/test_{stem.name}.cpp; write it, or say in {LIST} where it is tested"
    for number, pattern, reason in excused:
        if not reason:
            yield f"{LIST}:{number}: {pattern} without a reason"
        if number not in used:
            yield f"{LIST}:{number}: {pattern} fits no source without a test; remove the line"


SAMPLES = {
    "fem/solid/element.cpp": "", "fem/solid/element.hpp": "", "tests/unit/fem/solid/test_element.cpp": "",
    "fem/solid/forgotten.hpp": "", "app/command_run.cpp": "", "app/main.cpp": "",
    "tests/unit/fem/test_forgotten.cpp": "",
    LIST: "# list\napp/command_*.cpp  tests/pipeline\napp/main.cpp\napp/gone.cpp  removed\n"
          "fem/solid/element.cpp  has one\n",
}
FAULTY = ["fem/solid/forgotten.hpp", f"{LIST}:3", f"{LIST}:4", f"{LIST}:5"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))
