# SPDX-License-Identifier: Apache-2.0
"""Stroke a body: come down on a vertex, slide along the skin, leave; print what was felt.

    python3 trajectory.py out/liver/library.h5 [VERTEX] [--depth-mm 2] [--length-mm 10] [--plot stroke.png]
"""
import argparse

import numpy as np

import palpate

RATE = 1000  # Hz, of the force loop
SPEED = 0.02  # m/s


def path_through(points):
    """Positions from point to point at SPEED, a step of the loop apart."""
    parts = [points[:1]]
    for a, b in zip(points, points[1:]):
        count = max(1, int(np.linalg.norm(b - a) / SPEED * RATE))
        parts.append(a + np.linspace(0, 1, count + 1)[1:, None] * (b - a))
    return np.concatenate(parts)


def stroke(library, vertex, depth, length):
    """Down, half the length to one side, all of it back, and up again."""
    touch, inward = library.vertices[vertex], library.normals[vertex]
    aside = np.cross(inward, np.eye(3)[np.argmin(np.abs(inward))])
    aside *= length / 2 / np.linalg.norm(aside)
    above, below = touch - 2e-3 * inward, touch + depth * inward
    return path_through(np.stack([above, below, below + aside, below - aside, below, above]))


def plot(run, file):
    import matplotlib
    matplotlib.use("Agg")  # no window
    from matplotlib import pyplot
    figure, axes = pyplot.subplots()
    time = np.arange(len(run)) / RATE
    axes.plot(time, run.force, label=["x", "y", "z"])
    axes.set(xlabel="time (s)", ylabel="force on the tool (N)")
    axes.legend()
    figure.savefig(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("library")
    parser.add_argument("vertex", type=int, nargs="?")
    parser.add_argument("--depth-mm", type=float, default=2)
    parser.add_argument("--length-mm", type=float, default=10)
    parser.add_argument("--plot", metavar="FILE", help="needs matplotlib")
    options = parser.parse_args()

    library = palpate.Library(options.library)
    vertex = int(library.triangles[0, 0]) if options.vertex is None else options.vertex
    positions = stroke(library, vertex, 1e-3 * options.depth_mm, 1e-3 * options.length_mm)
    run = library.state().run(positions, dt=1 / RATE)

    touching = run.status & palpate.Status.CONTACT != 0
    sliding = run.status & palpate.Status.SLIDING != 0
    print(f"{len(run)} steps at {RATE} Hz, {touching.sum()} in contact, {sliding.sum()} sliding")
    print(f"largest force {np.linalg.norm(run.force, axis=1).max():.4f} N, deepest {1e3 * run.depth.max():.2f} mm")
    print(f"work of the tool {1e3 * run.absorbed[-1]:.4f} mJ, at most {1e3 * run.energy.max():.4f} mJ stored")
    seen = np.bitwise_or.reduce(run.status)
    print("status bits:", " ".join(bit.name for bit in palpate.Status if bit & int(seen)))
    if options.plot:
        plot(run, options.plot)


if __name__ == "__main__":
    main()
