#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Who may include whom: fails on an #include that crosses the rooms the wrong way.

Usage: check_includes.py [ROOT] | --self-test
"""
import re
import sys

from source_check import main

STAGES = ("format", "mesher", "fem", "fitting", "runtime", "app")
ROOMS = STAGES + ("python", "tests", "bench")

# What the sources of a room or of a folder may include outside it. A folder that is not listed follows the
# rules of the folder or room around it. Tests and benchmarks may include everything.
MAY_INCLUDE = {
    "format": set(),
    "mesher": {"format", "mesher/geometry", "mesher/read", "mesher/repair", "mesher/response", "mesher/skin",
               "mesher/support", "mesher/volume"},
    "mesher/geometry": {"format"},
    "mesher/patch": {"format"},
    "mesher/read": {"format", "mesher", "mesher/geometry", "mesher/repair", "mesher/volume"},
    "mesher/repair": {"format", "mesher/geometry"},
    "mesher/response": {"format", "mesher", "mesher/geometry", "mesher/skin", "mesher/support"},
    "mesher/skin": {"format", "mesher/geometry"},
    "mesher/support": {"format", "mesher", "mesher/geometry", "mesher/read"},
    "mesher/volume": {"format", "mesher", "mesher/geometry", "mesher/skin"},
    "fem": {"format"},
    "fem/laws": {"format"},
    "fem/mesh": {"format", "fem/solid"},
    "fem/factor": {"format"},
    "fem/solid": {"format", "fem/laws", "fem/mesh", "fem/factor"},
    "fem/contact": {"format", "fem/laws", "fem/mesh", "fem/factor", "fem/solid"},
    "fem/solve": {"format", "fem/laws", "fem/mesh", "fem/factor", "fem/solid", "fem/contact"},
    "fem/campaign": {"format", "fem/laws", "fem/mesh", "fem/factor", "fem/solid", "fem/contact", "fem/solve"},
    "fem/relaxation": {"format", "fem/laws", "fem/mesh", "fem/factor", "fem/solid", "fem/contact", "fem/solve",
                       "fem/campaign"},
    "fem/specimen": {"format", "fem/laws", "fem/mesh", "fem/factor", "fem/solid", "fem/contact", "fem/solve",
                     "fem/campaign"},
    "fitting": {"format", "runtime"},
    "fitting/response": {"format", "runtime"},
    "fitting/deformation": {"format", "runtime", "fitting/response"},
    "fitting/sampling": {"format", "fitting/response"},
    "fitting/certificate": {"format", "runtime", "fitting/measurement"},
    "fitting/fidelity": {"format", "runtime", "fitting/measurement", "fitting/measurement/compare"},
    "fitting/measurement": {"format"},
    "fitting/measurement/records": {"format", "fitting/measurement"},
    "fitting/measurement/calibrate": {"format", "fem/laws", "fitting/measurement", "fitting/measurement/records"},
    "fitting/measurement/identify": {"format", "fitting/measurement"},
    "fitting/measurement/relaxation": {"format", "fitting/measurement", "fitting/measurement/calibrate",
                                       "fitting/measurement/records"},
    "fitting/measurement/compare": {"format", "runtime", "fitting/measurement", "fitting/measurement/records",
                                    "fitting/measurement/relaxation", "fitting/response"},
    "runtime": {"format"},
    "runtime/devices": {"format", "runtime"},
    "app": set(STAGES),
    "python": {"format", "runtime"},
}

# In these, no header and source of one name may include itself through others.
NO_CIRCLES = ("mesher", "fitting/response", "fitting/sampling", "fitting/certificate", "fitting/fidelity")

# What an include belongs to, by the first pattern its path matches.
LIBRARIES = (
    (r"(hdf5|H5\w*)\.h", "HDF5"),
    (r"boost/math/", "Boost.Math"),
    (r"boost/(asio|beast)", "Boost.Beast"),
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
    (r"pugi(xml|config)\.hpp", "pugixml"),
    (r"zlib\.h", "zlib"),
    (r"pybind11/", "pybind11"),
    (r"minizip/", "minizip"),
    (r"matio\.h", "matio"),
    (r"fmt/", "fmt"),
    (r"spdlog/", "spdlog"),
)

# fmt and spdlog are texts and lines, not arrows; the embeddable rooms do without them all the same.
TEXT = {"fmt", "spdlog"}
MAY_USE = {
    "format": {"HDF5"},
    "mesher": {"Eigen", "CGAL", "TetGen", "pugixml", "zlib"} | TEXT,
    "fem": {"Eigen", "CHOLMOD", "BLAS", "OpenMP"} | TEXT,
    "fem/laws": {"Eigen"} | TEXT,
    "fitting": {"Eigen"} | TEXT,
    "fitting/measurement": {"Eigen", "Ceres", "Boost.Math"} | TEXT,
    "fitting/measurement/records": {"Eigen", "Boost.Math", "matio", "minizip", "pugixml"} | TEXT,
    "runtime": {"readerwriterqueue"},
    "app": {"CLI11", "toml++", "nlohmann-json"} | TEXT,
    "app/watch": {"nlohmann-json", "Boost.Beast"} | TEXT,
    "app/report": {"nlohmann-json", "zlib"} | TEXT,
    "python": {"pybind11"},
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


def folder_of(name, table):
    """The longest key of `table` that is `name` or a folder around it, or None."""
    parts = name.split("/")
    around = ("/".join(parts[:n]) for n in range(len(parts), 0, -1))
    return next((folder for folder in around if folder in table), None)


def fault_of(root, source, header):
    """What is wrong with `header` included from the file `source`, or None."""
    room, other, library = source.split("/")[0], room_of(header), library_of(header)
    here = folder_of(source, MAY_INCLUDE)
    there = folder_of(header, MAY_INCLUDE) if other else None
    if here and other and there != here:
        # app may include whole rooms; the other rules name folders.
        if there not in MAY_INCLUDE[here] and not (room == "app" and other in MAY_INCLUDE[here]):
            return f"{here}/ may not include {there or other}/"
    if other and other != room:
        carried = carries(root, header, set())
        if carried:
            return f"{header} carries {', '.join(sorted(carried))} out of {other}/"
    user = folder_of(source, MAY_USE)
    if library and user and library not in MAY_USE[user]:
        return f"{user}/ may not use {library}"
    return None


def circles(root):
    """Units (a header and the source of its name) that include themselves through others."""
    graph = {}
    for room in NO_CIRCLES:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in SOURCES and path.is_file():
                unit = path.relative_to(root).with_suffix("").as_posix()
                names = (header.rsplit(".", 1)[0] for _, header in includes_of(path))
                graph.setdefault(unit, set()).update(name for name in names if name != unit)
    for unit in graph:
        reached, ahead = set(), set(graph[unit])
        while ahead:
            name = ahead.pop()
            reached.add(name)
            ahead |= graph.get(name, set()) - reached
        if unit in reached:
            yield f"{unit}: it includes itself through others"


def faults(root):
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in SOURCES or not path.is_file():
                continue
            source = path.relative_to(root).as_posix()
            for number, header in includes_of(path):
                fault = fault_of(root, source, header)
                if fault:
                    yield f"{source}:{number}: {fault}"
    yield from circles(root)


# The check must see each kind of fault, and nothing in sound files.
SAMPLES = {
    "format/a.hpp": "#include <vector>\n",
    "format/a.cpp": '#include "format/a.hpp"\n#include <hdf5.h>\n',
    "mesher/inner.hpp": "#include <CGAL/Surface_mesh.h>\n",
    "mesher/inner.cpp": '#include "mesher/inner.hpp"\n',
    "fitting/response/good.cpp": '#include "runtime/palpate.h"\n#include "fitting/response/other.hpp"\n',
    "fitting/measurement/calibrate/good.cpp": '#include "fem/laws/law_table.hpp"\n#include <ceres/ceres.h>\n',
    "fem/solid/good.cpp": '#include "fem/mesh/good.hpp"\n#include "fem/solid/good.hpp"\n',
    "app/good.cpp": '#include "fem/campaign/campaign.hpp"\n',
    "python/good.cpp": '#include <pybind11/numpy.h>\n#include "runtime/palpate.h"\n',
    # Rooms
    "fem/bad.cpp": '#include <vector>\n#include "mesher/mesher.hpp"\n',
    "fitting/bad.cpp": ' # include "fem/campaign/campaign.hpp"\n',
    "app/bad.cpp": '#include "mesher/inner.hpp"\n',
    "python/bad.cpp": '#include "app/good.hpp"\n',
    # Folders of a room
    "fem/laws/bad.hpp": '#include "fem/solid/element.hpp"\n',
    "fem/solid/bad.hpp": '#include "fem/solve/newton.hpp"\n',
    "fitting/measurement/bad.cpp": '#include "fitting/response/fit.hpp"\n',
    "fitting/measurement/records/bad.cpp": '#include "fitting/measurement/compare/compare.hpp"\n',
    "fitting/measurement/compare/bad.cpp": '#include "fem/laws/law_table.hpp"\n',
    "runtime/bad.cpp": '#include "runtime/devices/device.hpp"\n',
    # Circles
    "mesher/one.hpp": '#include "mesher/other.hpp"\n',
    "mesher/other.hpp": "#include <vector>\n",
    "mesher/other.cpp": '#include "mesher/other.hpp"\n#include "mesher/one.hpp"\n',
    # Libraries
    "runtime/bad.hpp": "#include <Eigen/Dense>\n",
    "format/bad.cpp": "#include <fmt/format.h>\n",
    "fitting/certificate/bad.cpp": "#include <ceres/ceres.h>\n",
}
FAULTY = ["app/bad.cpp:1", "fem/bad.cpp:2", "fem/laws/bad.hpp:1", "fem/solid/bad.hpp:1", "fitting/bad.cpp:1",
          "fitting/certificate/bad.cpp:1", "fitting/measurement/bad.cpp:1",
          "fitting/measurement/compare/bad.cpp:1", "fitting/measurement/records/bad.cpp:1", "format/bad.cpp:1",
          "mesher/one", "mesher/other", "python/bad.cpp:1", "runtime/bad.cpp:1", "runtime/bad.hpp:1"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))
