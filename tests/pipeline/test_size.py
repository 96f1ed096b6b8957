#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The same block of 0.4 mm, of 5 cm and of 6.4 m, from its surface to the certificate.

Usage: test_size.py PALPATE. A hyperelastic solid has no length of its own: where every length of the case is
s times as long, every force is s^2 times and every stiffness s times as large. Powers of two scale without
rounding, so that the meshes are the same, too.
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


def resized(case, scale):
    """The case with every length `scale` times as long, and its forces to match."""
    def longer(match):
        number, unit = float(match[1]), match[2]
        return f'{number * (scale**2 if unit == "mN" else scale):.17g} {unit}"'
    return re.sub(r"(-?[\d.]+) (mm|mN)\"", longer, case)


class Size(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.reference = cls.build(1)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def build(cls, scale):
        """Forces and displacements of every sample, SI, and the certified bound, N/m."""
        root = Path(cls.folder.name) / f"{scale:g}"
        root.mkdir()
        vertices, triangles = block(SIZE, 5)
        surface = [tuple(scale * x for x in vertex) for vertex in vertices], triangles
        case = write_case(root, resized(CASE, scale), surface)
        done = subprocess.run([PALPATE, "build", case, "--out", root / "out", "--threads", "2"],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        with h5py.File(root / "out" / "curves.h5") as curves, h5py.File(root / "out" / "library.h5") as library:
            return {"force": curves["sample/force"][:], "displacement": curves["sample/displacement"][:],
                    "bound": library["certificate"].attrs["slip"]}

    def assert_scales(self, scale):
        body = self.build(scale)
        for name, power in (("displacement", 1), ("force", 2)):
            expected = scale**power * self.reference[name]
            self.assertEqual(body[name].shape, expected.shape)
            np.testing.assert_allclose(body[name], expected, rtol=0, atol=1e-4 * np.abs(expected).max())
        self.assertAlmostEqual(body["bound"] / (scale * self.reference["bound"]), 1, delta=0.01)

    def test_four_tenths_of_a_millimetre(self):
        self.assert_scales(1 / 128)

    def test_six_metres(self):
        self.assert_scales(128)


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
