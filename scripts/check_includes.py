#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Who may include whom: fails on an #include that crosses the rooms the wrong way.

Usage: check_includes.py [ROOT] | --self-test
"""
import re
import sys

from source_check import main

STAGES = ("format", "mesher", "fem", "fitting", "runtime", "app")
ROOMS = STAGES + ("tests", "bench")

# Other rooms a room may include. Tests and benchmarks may include everything.
MAY_INCLUDE = {
    "format": set(),
    "mesher": {"format"},
    "fem": {"format"},
    "fitting": {"format", "runtime"},
    "runtime": {"format"},
    "app": set(STAGES),
}

# Folders of another room that a room may include all the same.
MAY_INCLUDE_FOLDER = {"fitting": ("fem/laws/",)}
# Folders that include nothing else of their own room.
ENCLOSED = ("fem/laws/", "fitting/measurement/")

# What an include belongs to, by the first pattern its path matches.
LIBRARIES = (
    (r"(hdf5|H5\w*)\.h", "HDF5"),
    (r"boost/math/", "Boost.Math"),
    (r"(CGAL/|boost/|gmp|mpfr)", "CGAL"),
    (r"tetgen\.h", "TetGen"),
    (r"(Eigen|unsupported)/", "Eigen"),
    (r"(suitesparse/|cholmod|metis)", "CHOLMOD"),
    (r"(cblas|lapacke|openblas)", "BLAS"),
    (r"omp\.h", "OpenMP"),
    (r"ceres/", "Ceres"),
    (r"readerwriterqueue/", "readerwriterqueue"),
    (r"CLI/", "CLI11"),
    (r"toml\+\+/", "toml++"),
    (r"nlohmann/", "nlohmann-json"),
    (r"fmt/", "fmt"),
    (r"spdlog/", "spdlog"),
)

# fmt and spdlog are texts and lines, not arrows; the embeddable rooms do without them all the same.
TEXT = {"fmt", "spdlog"}
MAY_USE = {
    "format": {"HDF5"},
    "mesher": {"Eigen", "CGAL", "TetGen"} | TEXT,
    "fem": {"Eigen", "CHOLMOD", "BLAS", "OpenMP"} | TEXT,
    "fitting": {"Eigen", "Ceres", "Boost.Math"} | TEXT,
    "runtime": {"readerwriterqueue"},
    "app": {"CLI11", "toml++", "nlohmann-json"} | TEXT,
}

# A file that sees these takes a minute to compile: no header may carry them out of its room.
STAY_INSIDE = {"CGAL", "TetGen"}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SOURCES = (".hpp", ".h", ".cpp", ".c")


def includes_of(path):
    """Line number and path of each include of a file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def room_of(header):
    first = header.split("/")[0]
    return first if "/" in header and first in ROOMS else None


def library_of(header):
    return next((name for pattern, name in LIBRARIES if re.match(pattern, header)), None)


def carries(root, header, seen):
    """Libraries of STAY_INSIDE that including `header` brings along."""
    path = root / header
    if header in seen or not path.is_file():
        return set()
    seen.add(header)
    found = set()
    for _, inner in includes_of(path):
        if room_of(inner):
            found |= carries(root, inner, seen)
        elif library_of(inner) in STAY_INSIDE:
            found.add(library_of(inner))
    return found


def fault_of(root, source, header):
    """What is wrong with `header` included from the file `source`, or None."""
    room, other, library = source.split("/")[0], room_of(header), library_of(header)
    if other == room:
        folder = next((f for f in ENCLOSED if source.startswith(f)), "")
        if not header.startswith(folder):
            return f"{folder} may include nothing else of {room}/"
    if other and other != room:
        allowed = other in MAY_INCLUDE.get(room, ROOMS) or header.startswith(MAY_INCLUDE_FOLDER.get(room, ()))
        if not allowed:
            return f"{room}/ may not include {other}/"
        carried = carries(root, header, set())
        if carried:
            return f"{header} carries {', '.join(sorted(carried))} out of {other}/"
    if library and library not in MAY_USE.get(room, {library}):
        return f"{room}/ may not use {library}"
    return None


def faults(root):
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in SOURCES or not path.is_file():
                continue
            for number, header in includes_of(path):
                fault = fault_of(root, str(path.relative_to(root)), header)
                if fault:
                    yield f"{path.relative_to(root)}:{number}: {fault}"


# The check must see each kind of fault, and nothing in sound files.
SAMPLES = {
    "format/a.hpp": "#include <vector>\n",
    "format/a.cpp": '#include "format/a.hpp"\n#include <hdf5.h>\n',
    "mesher/inner.hpp": "#include <CGAL/Surface_mesh.h>\n",
    "mesher/inner.cpp": '#include "mesher/inner.hpp"\n',
    "fitting/good.cpp": '#include "runtime/palpate.h"\n#include "fem/laws/law_table.hpp"\n',
    "fitting/measurement/bad.cpp": '#include "fitting/fitting.hpp"\n',
    "fem/laws/bad.hpp": '#include "fem/solid/element.hpp"\n',
    "fem/bad.cpp": '#include <vector>\n#include "mesher/mesher.hpp"\n',
    "fitting/bad.cpp": ' # include "fem/campaign/campaign.hpp"\n',
    "runtime/bad.hpp": "#include <Eigen/Dense>\n",
    "format/bad.cpp": "#include <fmt/format.h>\n",
    "app/bad.cpp": '#include "mesher/inner.hpp"\n',
}
FAULTY = ["app/bad.cpp:1", "fem/bad.cpp:2", "fem/laws/bad.hpp:1", "fitting/bad.cpp:1", "fitting/measurement/bad.cpp:1",
          "format/bad.cpp:1", "runtime/bad.hpp:1"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))
