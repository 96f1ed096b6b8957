#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Make the records of data/measured/pad: what a testing machine and a robot would have recorded of a
gel pad. They are synthetic, and say so: Hertz's force of a sphere on a half space with a first-order
term for depth, plus offset, drift, machine compliance, hysteresis and noise of known size.

Only the Python standard library; the same files come out on every machine. Run from anywhere:
scripts/make_pad_records.py [folder]
"""

import math
import pathlib
import random
import sys

RADIUS = 6.0  # mm, of the tool
MODULUS = 16.7e-3  # MPa, E/(1 - nu^2) of the pad at its middle
DEPTH = 1.4  # mm
COMPLIANCE = 0.05  # mm/N, of the machine
TOP = 20.0  # mm, height of the pad
SITES = [(x, y) for x in (10, 20, 30, 40) for y in (10, 20, 30, 40)]
REPEATED = (20, 20)  # pressed three times, and dragged by the robot


def force(depth, stiffness=1.0):
    """N, at a depth in mm."""
    if depth <= 0:
        return 0.0
    hertz = 4 / 3 * MODULUS * math.sqrt(RADIUS) * depth**1.5
    return stiffness * hertz * (1 + 0.1 * depth / RADIUS)


def press(rng, stiffness, contact):
    """Rows of time s, displacement mm, force N: approach, press, release."""
    rows = []
    speed, rate = 0.5, 60
    leg = (contact + DEPTH) / speed
    for i in range(int(2 * leg * rate)):
        t = i / rate
        back = t > leg
        x = speed * (2 * leg - t if back else t)
        # The release is softer, the more the farther it has come.
        loss = 0.5 * (1 - (x - contact) / DEPTH) if back and x > contact else 0.0
        f = force(x - contact, stiffness) * (1 - loss)
        rows.append((t, x + COMPLIANCE * f, f + 0.05 + 2e-4 * t + rng.gauss(0, 3e-4)))
    return rows


def bluehill(path, label, rows):
    with open(path, "w", encoding="utf-8", newline="") as out:
        out.write(f'"Specimen label","{label}"\r\n"Method","indentation, synthetic record"\r\n"Rate","0.5","mm/s"\r\n\r\n')
        out.write('"Time","Compressive extension","Compressive load"\r\n"(s)","(mm)","(N)"\r\n')
        for t, x, f in rows:
            out.write(f'"{t:.3f}","{x:.4f}","{f:.5f}"\r\n')


def robot(path, rng, x, y):
    """A press, then a drag along x at that depth; positions of the tip in the frame of the pad."""
    rate, speed, travel, approach = 100, 0.5, 0.6, 1.0
    down, side = (approach + DEPTH) / speed, travel / speed
    tangential = 2 / 3 * (force(DEPTH + 1e-3) - force(DEPTH - 1e-3)) / 2e-3  # N/mm [Mindlin 1949]
    with open(path, "w", encoding="utf-8", newline="") as out:
        out.write("t (s);x (mm);y (mm);z (mm);Fx (N);Fy (N);Fz (N)\n")
        for i in range(int((down + side) * rate)):
            t = i / rate
            depth = min(t, down) * speed - approach
            s = max(0.0, t - down) * speed
            fx, fy, fz = tangential * s + 0.02, -0.01, -force(depth) + 0.3
            noisy = [f + rng.gauss(0, 3e-4) for f in (fx, fy, fz)]
            out.write(f"{t:.2f};{x + s:.4f};{y:.4f};{TOP - depth:.4f};{noisy[0]:.5f};{noisy[1]:.5f};{noisy[2]:.5f}\n")


def main(folder):
    rng = random.Random(1)
    folder.mkdir(parents=True, exist_ok=True)
    for number, (x, y) in enumerate(SITES):
        # The pad differs by a few percent over its top.
        repeats = 3 if (x, y) == REPEATED else 1
        local = 1 + 0.04 * math.sin(number)
        for repeat in range(repeats):
            stiffness = local * (1 + rng.gauss(0, 0.01))
            rows = press(rng, stiffness, 0.8 + 0.05 * rng.random())
            bluehill(folder / f"press-{x:g}-{y:g}-{repeat + 1}.csv", f"pad, site {x:g} {y:g}", rows)
    robot(folder / "drag-20-20.csv", rng, *REPEATED)


if __name__ == "__main__":
    default = pathlib.Path(__file__).resolve().parent.parent / "data" / "measured" / "pad"
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default)
