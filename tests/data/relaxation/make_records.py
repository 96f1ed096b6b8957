#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Makes held.csv and cycles.csv: a synthetic gel pad that relaxes, pressed by a sphere of 6 mm at one site of the
pad in data/measured. The force is the hereditary integral by fine quadrature, with an offset of 30 mN and noise of
0.5 mN. Usage: make_records.py FOLDER
"""
import csv
import sys
from pathlib import Path

import numpy as np

SERIES = ((0.3, 0.25), (0.2, 4.0))
HELD = [(0, -0.5e-3), (2, 0), (2.4, 1e-3), (32.4, 1e-3)]
CYCLES = [(0, -0.5e-3), (2, 0)] + [(2 + 1.5 * k, 1e-3 if k % 2 else 0.5e-3) for k in range(1, 9)]


def law(depth):
    """As in scripts/make_pad_records.py, of the site in the middle, which is 1 + 0.04 sin 5 times as stiff."""
    depth = np.maximum(depth, 0)
    return (1 + 0.04 * np.sin(5)) * 4 / 3 * 16.7e3 * np.sqrt(0.006) * depth**1.5 * (1 + 0.1 * depth / 0.006)


def relaxing(time, depth, series=SERIES):
    """f = g_inf e + sum of g_i m_i, dm_i/dt = de/dt - m_i/tau_i, in steps of a fortieth of the sampling."""
    fine = np.interp(np.arange(0, len(time) - 1 + 1e-9, 1 / 40), np.arange(len(time)), time)
    elastic = law(np.interp(fine, time, depth))
    force = (1 - sum(g for g, _ in series)) * elastic
    for g, tau in series:
        memory, decay = np.zeros_like(elastic), np.exp(-np.diff(fine) / tau)
        for i in range(1, len(fine)):
            memory[i] = decay[i - 1] * memory[i - 1] + np.sqrt(decay[i - 1]) * (elastic[i] - elastic[i - 1])
        force += g * memory
    return force[::40]


def motion(points, step):
    time = np.arange(points[0][0], points[-1][0] + 1e-9, step)
    return time, np.interp(time, *zip(*points))


def write(folder):
    noise = np.random.default_rng(4)
    for name, points in (("held", HELD), ("cycles", CYCLES)):
        time, travel = motion(points, 0.02)
        force = relaxing(time, travel) + 0.03 + noise.normal(0, 5e-4, len(time))
        with open(folder / f"{name}.csv", "w", encoding="ascii", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["time (s)", "travel (mm)", "force (N)"])
            rows.writerows([f"{a:.4f}", f"{1e3 * b + 4:.6f}", f"{c:.6f}"] for a, b, c in zip(time, travel, force))


if __name__ == "__main__":
    write(Path(sys.argv[1]))
