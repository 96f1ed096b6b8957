#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""How long `palpate mesh` takes: fine meshes of a surface of 40k vertices, and a surface of 500k triangles.

Usage: mesh_times.py PALPATE

The body is a lumpy ball, 100 mm across, its surface a grid of meridians and parallels. Prints one row a mesh: points
and triangles of the file, way of meshing, nodes and tetrahedra of the body, processor time, and that time over the
nodes. Times are those of the processor, so that other work of the machine counts little; compare rows of one run.
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

import numpy

from surfaces import CASE, processor_seconds

RADIUS = 50.0  # mm
# (meridians, element size in mm, method): 40k points and 250k points.
MESHES = ((200, 5.0, "isotropic"), (200, 5.0, "delaunay"), (200, 2.5, "isotropic"), (200, 2.5, "delaunay"),
          (500, 5.0, "isotropic"), (500, 5.0, "delaunay"))


def lumpy_ball(meridians):
    """Points and triangles of a ball with waves of a tenth of its radius."""
    polar = numpy.linspace(0, numpy.pi, meridians + 1)[1:-1]
    turn = numpy.linspace(0, 2 * numpy.pi, meridians, endpoint=False)
    t, u = numpy.meshgrid(polar, turn, indexing="ij")
    r = RADIUS * (1 + 0.1 * numpy.sin(3 * u) * numpy.sin(t) ** 3 + 0.05 * numpy.cos(4 * t))
    rings = numpy.stack((r * numpy.sin(t) * numpy.cos(u), r * numpy.sin(t) * numpy.sin(u), r * numpy.cos(t)), axis=-1)
    pole = RADIUS * 1.05
    points = numpy.concatenate(([[0, 0, pole], [0, 0, -pole]], rings.reshape(-1, 3)))
    i, j = numpy.meshgrid(numpy.arange(meridians - 2), numpy.arange(meridians), indexing="ij")
    at = lambda a, b: 2 + a * meridians + b % meridians
    quads = numpy.stack((at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)), axis=-1).reshape(-1, 4)
    k = numpy.arange(meridians)
    last = meridians - 2
    caps = numpy.concatenate((numpy.stack((0 * k, at(0, k), at(0, k + 1)), axis=-1),
                              numpy.stack((0 * k + 1, at(last, k + 1), at(last, k)), axis=-1)))
    return points, numpy.concatenate((caps, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))


def write_off(path, points, triangles):
    with path.open("w", encoding="ascii") as out:
        out.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        numpy.savetxt(out, points, fmt="%.9g")
        numpy.savetxt(out, numpy.insert(triangles, 0, 3, axis=1), fmt="%d")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate")
    palpate = parser.parse_args().palpate
    print("| points | triangles | way | element, mm | nodes | tetrahedra | processor, s | s / 1000 nodes |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for meridians, element, method in MESHES:
            points, triangles = lumpy_ball(meridians)
            surface = folder / f"ball_{meridians}.off"
            if not surface.exists():
                write_off(surface, points, triangles)
            text = CASE.format(file=surface, unit="mm", patch=2 * element, element=element, floor=-0.8 * RADIUS,
                               radius=5, depth=3)
            case = folder / "case.toml"
            case.write_text(text.replace("[mesh]\n", f'[mesh]\nmethod = "{method}"\n'), encoding="utf-8")
            start = processor_seconds()
            run = subprocess.run([palpate, "mesh", case, "--out", folder / "out"], capture_output=True, text=True)
            seconds = processor_seconds() - start
            found = re.search(r"mesh: (\d+) nodes, (\d+) tetrahedra", run.stdout + run.stderr)
            if not found:
                raise SystemExit(f"{method}, {element} mm: {(run.stdout + run.stderr).strip().splitlines()[-1]}")
            nodes, tetrahedra = int(found[1]), int(found[2])
            print(f"| {len(points)} | {len(triangles)} | {method} | {element} | {nodes} | {tetrahedra} | {seconds:.1f} "
                  f"| {1000 * seconds / nodes:.2f} |", flush=True)


if __name__ == "__main__":
    main()
