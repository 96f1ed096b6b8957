# SPDX-License-Identifier: Apache-2.0
"""Press a vertex of a library and print, or plot, its force-deflection curve.

    python3 press.py out/liver/library.h5 [VERTEX] [--plot curve.png]

Without VERTEX: the stiffest of the vertices that can be pressed.
"""
import argparse

import numpy as np

import palpate

FITTED = 0


def stiffest(library):
    """The fitted vertex with the largest force at the deepest sample."""
    fitted = np.flatnonzero(library.vertex_status == FITTED)
    touchable = np.intersect1d(fitted, library.triangles)
    forces = [library.response(v).normal(library.depth) for v in touchable]
    return int(touchable[np.argmax(forces)])


def plot(curve, library, vertex, file):
    import matplotlib
    matplotlib.use("Agg")  # no window
    from matplotlib import pyplot
    figure, axes = pyplot.subplots()
    axes.plot(1e3 * curve.depth, curve.force, label="rendered")
    stored = library.response(vertex).normal
    relaxing = len(library.relaxation_times) > 0
    axes.plot(1e3 * stored.knots, stored(stored.knots), "o",
              label="knots of the library" + (", before it relaxes" if relaxing else ""))
    axes.set(xlabel="depth (mm)", ylabel="force (N)")
    axes.legend()
    figure.savefig(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("library")
    parser.add_argument("vertex", type=int, nargs="?")
    parser.add_argument("--plot", metavar="FILE", help="needs matplotlib")
    options = parser.parse_args()

    library = palpate.Library(options.library)
    vertex = stiffest(library) if options.vertex is None else options.vertex
    curve = palpate.press(library, vertex, np.linspace(0, library.depth, 101))
    print(f"{library.name}, vertex {vertex} at {np.round(1e3 * library.vertices[vertex], 1)} mm")
    print(" depth/mm  force/N  energy/mJ")
    for depth, force, energy in zip(curve.depth[::10], curve.force[::10], curve.energy[::10]):
        print(f"{1e3 * depth:9.2f} {force:8.4f} {1e3 * energy:10.4f}")
    if options.plot:
        plot(curve, library, vertex, options.plot)


if __name__ == "__main__":
    main()
