#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Make the record of data/measured/slice: what a micro-indenter would have recorded of a slice of brain.
It is synthetic, and says so: Hertz's force of a sphere on a half space, with an offset and noise.

Only the Python standard library; the same file comes out on every machine. Run from anywhere:
scripts/make_slice_record.py [folder]
"""
import math
import pathlib
import random
import sys

RADIUS = 25e-6  # m, of the sphere
YOUNG, POISSON = 1200, 0.45  # Pa, -
APPROACH, DEPTH, SPEED = 20e-6, 12e-6, 2e-6  # m, m, m/s
OFFSET, NOISE = 35e-9, 20e-9  # N
STEP = 0.05  # s


def force(depth):
    """N, at a depth in m."""
    return 4 / 3 * YOUNG / (1 - POISSON**2) * math.sqrt(RADIUS) * max(depth, 0) ** 1.5


def main():
    home = pathlib.Path(__file__).resolve().parent.parent / "data" / "measured" / "slice"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else home
    noise = random.Random(3)
    turn = (APPROACH + DEPTH) / SPEED
    with open(folder / "press.csv", "w", encoding="ascii", newline="\n") as out:
        out.write("time (s),piezo (um),force (nN)\n")
        for i in range(round(2 * turn / STEP)):
            time = i * STEP
            piezo = SPEED * (time if time <= turn else 2 * turn - time)
            measured = force(piezo - APPROACH) + OFFSET + noise.gauss(0, NOISE)
            out.write(f"{time:.2f},{1e6 * piezo:.3f},{1e9 * measured:.1f}\n")


if __name__ == "__main__":
    main()
