#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Why slides over a library have no bound: the terms of r in (10b) of docs/theory-fitting.md, where r is least.

Usage: slide_terms.py LIBRARY [--friction MU] [--tolerance FRACTION]

r is sampled over contact points, azimuths and depths of each triangle of decoupled responses, so that its least value
is an upper bound of the true one: triangles that the certificate leaves without a bound can be missing here, others not.
Prints a row for each triangle with r <= 0, and how many would have a bound if the responses did not vary over the
triangle, or if they varied less by what the tolerance of the fit allows.
"""
import argparse

import h5py
import numpy as np

HOLE = 2
AZIMUTHS = np.linspace(0, 2 * np.pi, 24, endpoint=False)
POINTS = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, .5, 0), (.5, 0, .5), (0, .5, .5), (1 / 3, 1 / 3, 1 / 3),
                   (.7, .15, .15), (.15, .7, .15), (.15, .15, .7)])
DEPTHS = np.concatenate(([.002, .01, .03, .06], np.linspace(.1, 1, 12)))  # over the deepest knot
COLUMNS = ("t.tau", "depth", "lift", "lift turned", "variation")


class Curve:
    """A force whose slope is linear between knots."""

    def __init__(self, knot, slope):
        self.knot, self.slope = knot.astype(float), slope.astype(float)
        self.force = np.concatenate(([0], np.cumsum(np.diff(self.knot) * (self.slope[1:] + self.slope[:-1]) / 2)))

    def __call__(self, x):
        """(force, slope)"""
        slope = np.interp(x, self.knot, self.slope)
        i = np.clip(np.searchsorted(self.knot, x, side="right") - 1, 0, len(self.knot) - 1)
        return self.force[i] + 0.5 * (self.slope[i] + slope) * (x - self.knot[i]), slope


class Library:
    def __init__(self, path):
        with h5py.File(path) as file:
            if file.attrs.get("coupled") == 1:
                raise SystemExit(f"{path}: its responses are coupled; this is for decoupled ones")
            if file.attrs.get("leans") == 1:
                raise SystemExit(f"{path}: its responses lean; fit them with lean = false for this")
            self.position, self.inward = (file["surface"][k][()].astype(float) for k in ("position", "inward"))
            response = {name: data[()] for name, data in file["response"].items()}
            triangles = file["surface/triangles"][()]
        self.normal, self.lateral = (self.curves(response, kind) for kind in ("normal", "lateral"))
        self.depth = max(curve.knot[-1] for curve in self.normal.values())
        self.triangles = [t for t in triangles if all(v in self.normal for v in t)]

    @staticmethod
    def curves(response, kind):
        offset = response[f"{kind}_offset"]
        rows = lambda v, name: response[f"{kind}_{name}"][offset[v]:offset[v + 1]]
        return {v: Curve(rows(v, "knot"), rows(v, "slope")) for v, status in enumerate(response["status"]) if status != HOLE}


class Triangle:
    def __init__(self, library, corners, friction):
        self.u, self.friction = library.inward[corners], friction
        p = library.position[corners]
        area = np.cross(p[1] - p[0], p[2] - p[0])
        self.N = -area / np.linalg.norm(area)
        x = (p[1] - p[0]) / np.linalg.norm(p[1] - p[0])
        self.axes = x, np.cross(self.N, x)
        self.gradient = np.array([np.cross(area / area.dot(area), p[(k + 2) % 3] - p[(k + 1) % 3]) for k in range(3)])
        self.z = DEPTHS * library.depth
        self.g, self.dg = (np.array(x) for x in zip(*(library.normal[v](self.z) for v in corners)))
        self.lateral = [library.lateral[v] for v in corners]
        self.rho = np.linspace(0, 3 * library.depth, 400)
        self.h = np.array([curve(self.rho)[0] for curve in self.lateral])

    def states(self):
        """(terms of r by depth, least change of r per relative change of the responses, m) at each state."""
        for n in POINTS:
            mu_g = self.friction * n.dot(self.g)
            rho = np.interp(mu_g, n.dot(self.h), self.rho)
            h, dh = (np.array(x) for x in zip(*(curve(rho) for curve in self.lateral)))
            stiffness = np.maximum(n.dot(dh), 1e-12)
            m = self.friction * n.dot(self.dg) / stiffness
            U = n.dot(self.u)
            for azimuth in AZIMUTHS:
                tau = np.cos(azimuth) * self.axes[0] + np.sin(azimuth) * self.axes[1]
                yield self.terms(tau, U, m, rho, h, stiffness), m

    def terms(self, tau, U, m, rho, h, stiffness):
        n = U / np.linalg.norm(U)
        t = n.dot(self.N) * tau - n.dot(tau) * self.N
        t /= np.linalg.norm(t)
        along = self.gradient.dot(tau)
        turn = t.dot(along.dot(self.u)) / np.linalg.norm(U)
        deepest = self.z[-1] if turn < 0 else self.z
        variation = -along.dot(h - self.friction * self.g) / stiffness
        slack = 2 * np.abs(along).dot(self.friction * self.g) / stiffness
        ones = np.ones_like(self.z)
        return np.array((t.dot(tau) * ones, deepest * turn * ones, -m * n.dot(tau), m * rho * turn, variation, slack))

    def least(self, varies=True):
        """The terms where r is least, and m there."""
        best, where = np.inf, None
        for terms, m in self.states():
            r = terms[:5 if varies else 4].sum(axis=0)
            i = r.argmin()
            if r[i] < best:
                best, where = r[i], (terms[:, i], m[i])
        return best, *where


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("library")
    parser.add_argument("--friction", type=float, default=0.3)
    parser.add_argument("--tolerance", type=float, default=0.02, help="of the fit, over the force (default: 0.02)")
    arguments = parser.parse_args()
    library = Library(arguments.library)
    print("| triangle | r | " + " | ".join(COLUMNS) + " | mu g'/h' |\n" + "|---" * (len(COLUMNS) + 3) + "|")
    without = smoothed = steep = 0
    triangles = [Triangle(library, corners, arguments.friction) for corners in library.triangles]
    for index, triangle in enumerate(triangles):
        r, terms, m = triangle.least()
        if r > 0:
            continue
        print(f"| {index} | {r:.2f} | " + " | ".join(f"{x:.2f}" for x in terms[:5]) + f" | {m:.2f} |")
        steep += 1
        without += triangle.least(varies=False)[0] > 0
        smoothed += r + arguments.tolerance * terms[5] > 0
    print(f"\n{steep} of {len(triangles)} triangles have r <= 0; {without} of them not where responses do not vary, "
          f"{smoothed} not where they vary less by {100 * arguments.tolerance:g} % of the force")


if __name__ == "__main__":
    main()
