#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The nodule of the liver that scripts/demo presses is felt, and only where it is.

Usage: test_liver.py PALPATE CASE. The case is run on larger patches and elements and along a strip around its slide: once with
its nodule, once on the same tetrahedra with the constants of liver in all of them.
"""
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

PALPATE = None
CASE = None
STRIP = """[[press]]
shape = "box"
low = ["-118 mm", "-120 mm", "1502 mm"]
high = ["-32 mm", "-70 mm", "1536 mm"]
"""


def palpate(*arguments):
    result = subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: {result.stdout}{result.stderr}")


def substituted(text, pattern, replacement, count=1):
    text, found = re.subn(pattern, replacement, text, flags=re.MULTILINE | re.DOTALL)
    assert found == count, (pattern, found)
    return text


def coarse(text):
    for key, value in {"patch_spacing": '"10 mm"', "element_size": '"10 mm"', "increments": "3",
                       "lateral_increments": "2"}.items():
        text = substituted(text, rf"^{key} = [^\n]*$", f"{key} = {value}")
    text = substituted(text, r"^\[\[press\]\].*?(?=^\n?\[)", STRIP)
    return text.replace('"../', f'"{CASE.parent.parent}/')


def metres(quantities):
    return np.array([float(text.removesuffix(" mm")) for text in quantities]) * 1e-3


class Run:
    """The artifacts of a case: energy of the deepest state and place of each site, and the session."""

    def __init__(self, root, name, text):
        case, out = root / f"{name}.toml", root / name
        case.write_text(text, encoding="utf-8")
        palpate("build", case, "--out", out, "--threads", 2)
        palpate("simulate", case, "--out", out)
        with h5py.File(out / "library.h5") as library:
            positions = library["surface/position"][...]
            self.slip = library["certificate/triangle/slip"][...]
            self.stick = library["certificate/triangle/stick"][...]
            self.lowest_rate = library["certificate/device/lowest_rate"][...]
        with h5py.File(out / "curves.h5") as curves:
            self.vertex = curves["site/vertex"][...]
            normal = curves["site/first_path"][...]
            assert np.all(curves["path/kind"][...][normal] == 0)
            last = curves["path/first_sample"][...][normal] + curves["path/sample_count"][...][normal] - 1
            self.energy = curves["sample/strain_energy"][...][last] + curves["sample/contact_energy"][...][last]
            self.force = np.linalg.norm(curves["sample/force"][...][last], axis=1)
        self.site = positions[self.vertex]
        with h5py.File(out / "recording.h5") as recording:
            self.contact = recording["step/contact_point"][...]
            self.felt = np.linalg.norm(recording["step/force"][...], axis=1)
            self.absorbed = recording["step/absorbed"][...]

    def slide(self, sections=60):
        """Places along the slide, and the mean force in each section of it: by the place, as the two bodies are not equally fast."""
        pressed = self.felt > 0.25 * self.felt.max()
        contact, felt = self.contact[pressed], self.felt[pressed]
        way = (contact - contact[0]) @ (contact[-1] - contact[0]) / np.linalg.norm(contact[-1] - contact[0])
        part = np.clip(way / way.max() * sections, 0, sections - 1e-9).astype(int)
        of = [part == s for s in range(sections)]
        return np.array([contact[o].mean(axis=0) for o in of]), np.array([felt[o].mean() for o in of])


class Liver(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = CASE.read_text(encoding="utf-8")
        case = tomllib.loads(text)
        inclusion, = case["inclusion"]
        liver, nodule = ({m["region"]: m["young"] for m in case["material"]}[r] for r in ("liver", "nodule"))
        cls.ratio_of_moduli = float(nodule.split()[0]) / float(liver.split()[0])
        points = np.array([line.split() for line in (CASE.parent / inclusion["file"]).read_text().splitlines()[3:645]],
                          dtype=float) * 1e-3
        centre = points.mean(axis=0)
        cls.radius = np.linalg.norm(points - centre, axis=1).max()
        cls.above = metres(case["press"][0]["centre"])
        cls.cover = np.linalg.norm(cls.above - centre) - cls.radius
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.diseased = Run(root, "diseased", coarse(text))
        cls.healthy = Run(root, "healthy", substituted(coarse(text), f'"{nodule}"', f'"{liver}"'))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def distance(self):
        """Of the sites from the point of the surface above the nodule, m."""
        return np.linalg.norm(self.diseased.site - self.above, axis=1)

    def test_the_nodule_lies_where_the_case_says(self):
        self.assertAlmostEqual(self.radius, 0.012, delta=1e-5)
        self.assertAlmostEqual(self.cover, 0.004, delta=1e-4)

    def test_a_stiffer_part_stores_more_energy_but_no_more_than_if_all_were_stiff(self):
        """The law of the nodule is that of liver times the ratio of the moduli. The equilibrium has the least energy at a depth,
        so that of the body with the nodule lies between that of liver and the ratio times it, whatever the contact."""
        np.testing.assert_array_equal(self.diseased.vertex, self.healthy.vertex)
        ratio = self.diseased.energy / self.healthy.energy
        self.assertGreater(ratio.min(), 1 - 1e-4)
        self.assertLess(ratio.max(), self.ratio_of_moduli)

    def test_over_the_nodule_the_press_is_harder_and_far_from_it_the_same(self):
        """By more than the 23 % that people need to tell two stiffnesses apart [Jones & Hunter 1990]. The disturbance of a sphere
        fades with the third power of the distance, or faster."""
        ratio = self.diseased.force / self.healthy.force
        near, far = self.distance() < 0.5 * self.radius, self.distance() > 3 * self.radius
        self.assertGreaterEqual(near.sum(), 2)
        self.assertGreaterEqual(far.sum(), 5)
        self.assertGreater(ratio[near].min(), 1.25)
        self.assertLess(np.abs(ratio[far] - 1).max(), 0.01)
        self.assertGreater(self.diseased.force[near].min(), self.diseased.force[~near].max())

    def test_the_slide_is_hardest_over_the_nodule(self):
        """Against the healthy body at the same place: how fast the hand is there, and how long, is the same for both."""
        place, felt = self.diseased.slide()
        ratio = felt / self.healthy.slide()[1]
        distance = np.linalg.norm(place - self.above, axis=1)
        self.assertLess(distance[np.argmax(ratio)], self.radius)
        self.assertGreater(ratio.max(), 1.15)
        self.assertLess(np.abs(ratio[distance > 2.5 * self.radius] - 1).max(), 0.1)
        self.assertLess(np.linalg.norm(self.diseased.contact[np.argmax(self.diseased.felt)] - self.above), self.radius)
        for run in (self.diseased, self.healthy):
            self.assertGreaterEqual(run.absorbed[-1], 0)

    def test_every_triangle_is_certified(self):
        for run in (self.diseased, self.healthy):
            self.assertGreater(len(run.slip), 40)
            self.assertTrue(np.all(np.isfinite(run.slip)) and np.all(np.isfinite(run.stick)))
            self.assertTrue(np.all(np.isfinite(run.lowest_rate)) and np.all(run.lowest_rate > 0))
        # A stiffer body needs a faster force loop.
        self.assertGreater(self.diseased.lowest_rate[0], self.healthy.lowest_rate[0])


if __name__ == "__main__":
    PALPATE, CASE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1], verbosity=2)
