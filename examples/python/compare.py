# SPDX-License-Identifier: Apache-2.0
"""Compare two libraries of one body: the same presses in both, and how much their forces differ.

    python3 compare.py out/liver/library.h5 out/liver-stiffer/library.h5

The presses are those of the fitted vertices of the first; the second may have another triangulation.
"""
import argparse

import numpy as np

import palpate

FITTED = 0
STEPS = 100


def presses(library, depth):
    """Vertices, and for each the positions of a tip that presses it: (S, STEPS + 2, 3)."""
    vertices = np.intersect1d(np.flatnonzero(library.vertex_status == FITTED), library.triangles)
    z = np.concatenate([[-1e-3, 1e-9], depth * np.arange(1, STEPS + 1) / STEPS])
    return vertices, library.vertices[vertices][:, None] + z[:, None] * library.normals[vertices][:, None]


def forces(library, positions):
    """(S, STEPS + 2, 3) N, of the body on the tool."""
    state = library.state()
    made = []
    for press in positions:
        state.reset()
        made.append(state.run(press, dt=1e-3).force)
    return np.stack(made)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("first")
    parser.add_argument("second")
    options = parser.parse_args()

    first, second = palpate.Library(options.first), palpate.Library(options.second)
    depth = min(first.depth, second.depth)
    vertices, positions = presses(first, depth)
    a, b = forces(first, positions), forces(second, positions)
    largest = np.linalg.norm(a, axis=2).max(axis=1)
    difference = np.linalg.norm(b - a, axis=2).max(axis=1) / largest
    worst = np.argmax(difference)
    print(f"{len(vertices)} presses to {1e3 * depth:.2f} mm, forces up to {largest.max():.4f} N")
    print(f"difference: median {100 * np.median(difference):.2f} %, 95 % {100 * np.percentile(difference, 95):.2f} %, "
          f"worst {100 * difference[worst]:.2f} % at vertex {vertices[worst]}")


if __name__ == "__main__":
    main()
