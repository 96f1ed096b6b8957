#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Make data/measured/liver-patch/probing.csv: what a robot would have logged that presses an organ with a ball at many
sites, each along the normal that it measured. Synthetic, with the layout and the size of the forces of a published
record of a pig's liver; the true force of every place is `force` below.

Only the Python standard library; the same file comes out on every machine. Run from anywhere:
scripts/make_liver_patch_records.py [folder]
"""

import math
import pathlib
import random
import sys

RADIUS = 4.0  # mm, of the ball
SPACING = 5.4  # mm
COLUMNS, ROWS = 9, 7
STEPS, DEPTH = 10, 3.0  # presses of ten samples to 3 mm
CURVATURE = 70.0  # mm, radius of the surface
SCATTER = 0.02  # relative standard deviation of a press: what a second press of the same place would differ by
NOISE = 2e-3  # N, of a sample
TILT = 1.0  # degrees, standard deviation of the measured normal about each axis
STUCK = 0.04  # lateral over normal force


def stiffness(u, v):
    """N/mm^1.5 at a place of the surface, mm: four to one over the patch."""
    return 0.055 * math.exp(0.45 * math.sin(2 * math.pi * u / 55) + 0.35 * math.cos(2 * math.pi * v / 60))


def force(u, v, depth):
    """N, at a depth in mm: of a ball on soft tissue that stiffens."""
    return stiffness(u, v) * depth**1.5 * (1 + (depth / 2) ** 2) if depth > 0 else 0.0


def normal(u, v):
    """Out of the organ, in the frame of the surface."""
    length = math.sqrt(u * u + v * v + CURVATURE**2)
    return (u / length, v / length, CURVATURE / length)


def surface(u, v):
    return (u, v, -(u * u + v * v) / (2 * CURVATURE))


def robot(x):
    """From the frame of the surface to that of the robot: a turn of 25 degrees about y, then a shift."""
    c, s = math.cos(math.radians(25)), math.sin(math.radians(25))
    return (c * x[0] + s * x[2], x[1], -s * x[0] + c * x[2])


def sites():
    """Places of the surface, mm: a grid with its lines askew, as a robot follows a surface."""
    return [(SPACING * (i - 4) + 0.12 * SPACING * (j - 3), SPACING * (j - 3) - 0.15 * SPACING * (i - 4))
            for j in range(ROWS) for i in range(COLUMNS)]


def tilted(rng, n):
    off = [a + math.radians(TILT) * rng.gauss(0, 1) for a in n]
    length = math.sqrt(sum(a * a for a in off))
    return tuple(a / length for a in off)


def press(rng, out, site, u, v):
    """Rows of one site. The centre of the ball moves against the measured normal."""
    n = robot(tilted(rng, normal(u, v)))
    centre = [a + RADIUS * b + c for a, b, c in zip(robot(surface(u, v)), n, (20, -40, -140))]
    strength = 1 + SCATTER * rng.gauss(0, 1)
    level = math.hypot(n[0], n[1])
    across = (n[1] / level, -n[0] / level, 0.0)
    for step in range(STEPS):
        depth = DEPTH * (step + 0.2) / (STEPS - 0.8)
        f = strength * force(u, v, depth)
        at = [a - depth * b for a, b in zip(centre, n)]
        reaction = [f * b + STUCK * f * c + rng.gauss(0, NOISE) for b, c in zip(n, across)]
        row = [*centre, *n, *at, *reaction]
        out.write(f"{site},{step}," + ",".join(f"{value:.6g}" for value in row) + "\n")


def main(folder):
    rng = random.Random(7)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "probing.csv", "w", encoding="utf-8", newline="") as out:
        out.write("site,step,cx_mm,cy_mm,cz_mm,nx,ny,nz,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n")
        for site, (u, v) in enumerate(sites()):
            press(rng, out, site, u, v)


if __name__ == "__main__":
    default = pathlib.Path(__file__).resolve().parent.parent / "data" / "measured" / "liver-patch"
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default)
