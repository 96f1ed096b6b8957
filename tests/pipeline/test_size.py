#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The same block of 0.4 mm and 0.6 kPa, of 5 cm and 10 kPa, and of 6.4 m and 5 MPa, from its surface to a session.

Usage: test_size.py PALPATE. A hyperelastic solid has no length and no force of its own: where every length of the
case is s times as long and Young's modulus m times as large, every force is m s^2 times and every stiffness m s
times as large. Powers of two scale without rounding, so that the meshes are the same, too. The case gives no length but those of its supports, no force and
no stiffness: the defaults are those of the body.
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import CASE, SIZE, block, write_case  # noqa: E402

PALPATE = None
BEYOND_DEPTH, CONTACT, SLIDING = 64, 1, 8


def by_default(case):
    """The case without what it may leave out. What is added keeps the test quick."""
    for section in ("tool", "fit", "simulate", "indentation", "mesh"):
        case = re.sub(rf"^\[{section}\]\n(?:.+\n)*\n?", "", case, flags=re.MULTILINE)
    return case + ("\n[mesh]\ninterior_coarsening = 3.0\n"
                   "\n[[press]]\nshape = \"sphere\"\ncentre = [\"25 mm\", \"25 mm\", \"20 mm\"]\nradius = \"6 mm\"\n"
                   "\n[indentation]\nincrements = 4\nlateral_increments = 2\n")


def resized(case, scale, modulus):
    """The case with every length `scale` times as long and a modulus `modulus` times as large; nearly incompressible."""
    case = case.replace('young = "10 kPa"', f'young = "{10 * modulus:.17g} kPa"')
    case = re.sub(r"poisson = [\d.]+", "poisson = 0.499", case)
    return re.sub(r"(-?[\d.]+) mm\"", lambda match: f'{float(match[1]) * scale:.17g} mm"', case)


class Size(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.reference = cls.run_on(1, 1)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_on(cls, scale, modulus):
        """What the stages make of the block, SI: forces, bounds, the fit, a session."""
        root = Path(cls.folder.name) / f"{scale:g}"
        root.mkdir()
        vertices, triangles = block(SIZE, 5)
        surface = [tuple(scale * x for x in vertex) for vertex in vertices], triangles
        case = write_case(root, resized(by_default(CASE), scale, modulus), surface)
        said = ""
        for stage in ("build", "simulate"):
            done = subprocess.run([PALPATE, stage, case, "--out", root / "out"] + ["--threads", "2"] * (stage == "build"),
                                  capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
            said += done.stdout
        if scale < 1:
            said += cls.press_again(case, root / "out")
        with h5py.File(root / "out" / "curves.h5") as curves, h5py.File(root / "out" / "library.h5") as library, \
                h5py.File(root / "out" / "recording.h5") as session:
            return {"force": curves["sample/force"][:], "displacement": curves["sample/displacement"][:],
                    "knots": library["response/normal_offset"][:], "error": library["response/normal_error"][:],
                    "bound": library["certificate"].attrs["stick"],
                    "depth": session["step/depth"][:], "commanded": session["step/force"][:],
                    "status": session["step/status"][:], "said": said}

    @staticmethod
    def press_again(case, out):
        """What is printed of the first site, pressed for another program."""
        with h5py.File(out / "curves.h5") as curves:
            vertex = str(curves["site/vertex"][0])
        done = subprocess.run([PALPATE, "export", "site", case, "--out", out, "--vertex", vertex],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def assert_scales(self, scale, modulus):
        body = self.run_on(scale, modulus)
        force = modulus * scale**2
        for name, factor, tolerance in (("displacement", scale, 1e-4), ("force", force, 1e-4), ("error", force, 0.02),
                                        ("depth", scale, 5e-3), ("commanded", force, 5e-3)):
            expected = factor * self.reference[name]
            with self.subTest(name):
                self.assertEqual(body[name].shape, expected.shape)
                np.testing.assert_allclose(body[name], expected, rtol=0, atol=tolerance * np.abs(expected).max())
        np.testing.assert_array_equal(body["knots"], self.reference["knots"])
        # Lengths, forces and energies are printed in a unit in which they are not rounded away.
        self.assertNotRegex(body["said"], r"\b0\.0+[0-9]?(e-\d+)? (mm|N|mN|mJ)\b")
        self.assertAlmostEqual(body["bound"] / (modulus * scale * self.reference["bound"]), 1, delta=0.01)

    def test_the_fit_follows_every_curve_and_the_session_stays_within_them(self):
        said = self.reference["said"]
        worst = float(re.search(r"normal .* median, ([\d.]+) % worst", said)[1])
        self.assertLess(worst, 5)
        self.assertNotIn("miss their curves", said)
        status = self.reference["status"]
        self.assertTrue(np.any(status & CONTACT))
        self.assertTrue(np.any(status & SLIDING))
        self.assertFalse(np.any(status & BEYOND_DEPTH))

    def test_four_tenths_of_a_millimetre_of_fat(self):
        self.assert_scales(1 / 128, 1 / 16)

    def test_six_metres_of_rubber(self):
        self.assert_scales(128, 512)


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
