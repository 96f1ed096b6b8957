#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Which surfaces of a collection become a body: runs `palpate mesh` on every file with the same settings.

Usage: surfaces.py PALPATE FOLDER... [--details FILE]

Patches are 1/12 of the largest extent, elements 1/20, the lowest tenth is fixed, the tool has a radius of 1/20
and presses 1/40 deep. Lengths are those of the part with the largest area, which the case keeps. No file gets settings
of its own, and a copy of an earlier file is left out. Prints one row a folder: files, bodies at the first try, how many
of them after a repair, as an alpha wrap and by Delaunay refinement, bodies that are too thin for the depth at most
sites, refusals, the longest time of the processor.
"""
import argparse
import collections
import hashlib
import pathlib
import resource
import subprocess
import tempfile

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "um": 1e-6}
USUAL_EXTENT = 0.15  # m
READERS = {".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader}
ENDINGS = (".off", ".obj", *READERS)
LIMIT_S = 300
TOO_THIN = "of the thickness at"  # the body was made, and refused for the depth of the press
CASE = """
[surface]
file = "{file}"
unit = "{unit}"
parts = "largest"
[mesh]
patch_spacing = "{patch} mm"
element_size = "{element} mm"
[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "{floor} mm"]
normal = [0, 0, -1]
[[material]]
region = "matrix"
law = "neo-hookean"
young = "10 kPa"
poisson = 0.49
[tool]
radius = "{radius} mm"
[indentation]
depth = "{depth} mm"
lateral_travel = "{depth} mm"
lateral_depths = ["{depth} mm"]
"""


def obj_faces(path):
    """Points and faces, or None; vtkOBJReader crashes on some of the files."""
    points, faces = [], []
    for words in (line.split() for line in path.read_text(errors="replace").splitlines()):
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(w.split("/")[0]) for w in words[1:]]
            faces.append([c - 1 if c > 0 else len(points) + c for c in corners])
    return points, faces


def off_faces(path):
    words = [w for line in path.read_text(errors="replace").splitlines()
             if not line.lstrip().startswith("#") for w in line.split()]
    start = 1 if not words[0][:1].isdigit() else 0
    point_count, face_count = int(words[start]), int(words[start + 1])
    at = start + 3 + 3 * point_count
    points = numpy.array(words[start + 3:at], dtype=float)
    faces = []
    for _ in range(face_count):
        corners = int(words[at])
        faces.append([int(w) for w in words[at + 1:at + 1 + corners]])
        at += 1 + corners
        while at < len(words) and "." in words[at]:  # colours
            at += 1
    return points, faces


def vtk_faces(path):
    reader = READERS[path.suffix.lower()]()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    ids = vtk.vtkIdList()
    faces = []
    for cell in range(data.GetNumberOfCells()):
        data.GetCellPoints(cell, ids)
        faces.append([ids.GetId(k) for k in range(ids.GetNumberOfIds())])
    return vtk_to_numpy(data.GetPoints().GetData()) if data.GetPoints() else [], faces


def triangles_of(path):
    """Corners of the triangles, (n, 3, 3), or None where this script cannot read the file."""
    read = {".obj": obj_faces, ".off": off_faces}.get(path.suffix.lower(), vtk_faces)
    try:
        points, faces = read(path)
        points = numpy.array(points, dtype=float).reshape(-1, 3)
        fans = [[f[0], f[k - 1], f[k]] for f in faces for k in range(2, len(f))]
        corners = points[numpy.array(fans, dtype=int).reshape(-1, 3)]
    except (IndexError, ValueError):
        return None
    return corners[numpy.isfinite(corners).all(axis=(1, 2))]


def largest_part(corners):
    """The triangles of the connected part with the largest area."""
    _, point = numpy.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = point.reshape(-1, 3)
    label = numpy.arange(point.max() + 1)
    while True:
        lowest = label[triangles].min(axis=1)
        joined = label.copy()
        for k in range(3):
            numpy.minimum.at(joined, triangles[:, k], lowest)
        joined = joined[joined]
        if (joined == label).all():
            break
        label = joined
    part = label[triangles[:, 0]]
    sides = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = numpy.bincount(part, weights=numpy.linalg.norm(sides, axis=1) / 2)
    return corners[part == area.argmax()]


def points_of(path):
    """Coordinates of the points of the body, or None."""
    corners = triangles_of(path)
    return None if corners is None or len(corners) == 0 else largest_part(corners).reshape(-1, 3)


def case_for(path, points):
    low, high = points.min(axis=0), points.max(axis=0)
    raw = float((high - low).max())
    unit = min(UNITS, key=lambda name: abs(numpy.log(raw * UNITS[name] / USUAL_EXTENT)))
    mm = 1e3 * UNITS[unit]
    extent = raw * mm
    return CASE.format(file=path.resolve(), unit=unit, patch=extent / 12, element=extent / 20,
                       floor=mm * (low[2] + 0.1 * (high[2] - low[2])), radius=extent / 20, depth=extent / 40)


def processor_seconds():
    """Of all commands that have ended: unlike the time on the clock, it leaves out what else the machine does."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def mesh(palpate, path, scratch):
    """(outcome, seconds, last line of the output) of one file."""
    points = points_of(path)
    if points is None or not (numpy.ptp(points, axis=0) > 0).all():
        points = numpy.array([[0, 0, 0], [150, 150, 150]])
    case = scratch / "case.toml"
    case.write_text(case_for(path, points), encoding="utf-8")
    start = processor_seconds()
    try:
        run = subprocess.run([palpate, "mesh", case, "--out", scratch / "out"], capture_output=True, text=True,
                             timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        return "over the time limit", LIMIT_S, ""
    seconds = processor_seconds() - start
    output = (run.stdout + run.stderr).strip()
    last = output.splitlines()[-1] if output else ""
    if run.returncode == 3:
        return "too thin" if TOO_THIN in last else "refused", seconds, last
    if run.returncode != 0:
        return f"exit {run.returncode}", seconds, last
    ways = "Delaunay" if "does not make a sound mesh" in output else "isotropic"
    repair = "repaired, " if ": repaired:" in output else ""
    return repair + ("wrapped, " if "alpha wrap" in output else "") + ways, seconds, last


def without_copies(files, seen):
    """The files whose content none before them has."""
    for path in files:
        digest = hashlib.sha256(path.read_bytes()).digest()
        if digest not in seen:
            seen.add(digest)
            yield path


def parse_arguments(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--details", type=argparse.FileType("w"))
    return parser.parse_args()


def main():
    arguments = parse_arguments(__doc__)
    vtk.vtkObject.GlobalWarningDisplayOff()
    print("| collection | files | bodies | of them repaired | wrapped | Delaunay | too thin | refused | other | longest, s |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    seen = set()
    for folder in arguments.folders:
        files = sorted(p for p in folder.rglob("*") if p.suffix.lower() in ENDINGS)
        files = list(without_copies(files, seen))
        outcomes, longest = collections.Counter(), 0.0
        for path in files:
            with tempfile.TemporaryDirectory() as scratch:
                outcome, seconds, last = mesh(arguments.palpate, path, pathlib.Path(scratch))
            outcomes[outcome] += 1
            longest = max(longest, seconds)
            if arguments.details:
                print(f"{path}\t{outcome}\t{seconds:.1f}\t{last}", file=arguments.details, flush=True)
        total = lambda word: sum(n for name, n in outcomes.items() if word in name)
        bodies = total("isotropic") + total("Delaunay")
        other = len(files) - bodies - outcomes["too thin"] - outcomes["refused"]
        ways = " | ".join(str(total(word)) for word in ("repaired", "wrapped", "Delaunay"))
        print(f"| {folder.name} | {len(files)} | {bodies} | {ways} | "
              f"{outcomes['too thin']} | {outcomes['refused']} | {other} | {longest:.0f} |", flush=True)


if __name__ == "__main__":
    main()
