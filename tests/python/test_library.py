#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""palpate.Library against h5py and the closed form of its responses.

Usage: test_library.py WRITE_BODIES WRITE_SAMPLE_ARTIFACTS
"""
import gc
import importlib.metadata
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import palpate

WRITE_BODIES = None
WRITE_SAMPLES = None
STIFFNESS = 170  # N/m, of the plate: f = 100 k d^2 up to 5 mm, then k (d - 2.5 mm)


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        subprocess.run([WRITE_BODIES, cls.root], check=True)
        subprocess.run([WRITE_SAMPLES, cls.root / "samples"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.plate = palpate.Library(self.root / "plate.h5")

    def test_the_surface_is_that_of_the_plate(self):
        vertices, triangles = self.plate.vertices, self.plate.triangles
        self.assertEqual((vertices.shape, vertices.dtype), ((81, 3), np.float64))
        self.assertEqual((triangles.shape, triangles.dtype), ((128, 3), np.int32))
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        self.assertTrue(np.all(normals[:, 2] > 0))  # counter-clockwise from outside
        self.assertAlmostEqual(normals[:, 2].sum() / 2, 0.08**2, places=15)
        self.assertTrue(np.array_equal(self.plate.normals, np.tile([0, 0, -1.0], (81, 1))))
        self.assertTrue(np.array_equal(self.plate.vertex_status, np.zeros(81)))
        self.assertTrue(np.array_equal(self.plate.low, [0, 0, 0]))
        self.assertTrue(np.array_equal(self.plate.high, [0.08, 0.08, 0]))

    def test_its_responses_are_the_closed_form(self):
        response = self.plate.response(40)
        depths = np.linspace(0, 8e-3, 33)
        expected = np.where(depths < 5e-3, 100 * STIFFNESS * depths**2, STIFFNESS * (depths - 2.5e-3))
        np.testing.assert_allclose(response.normal(depths), expected, rtol=1e-6, atol=1e-9)
        self.assertEqual(response.normal(-1e-3), 0)
        # A piecewise linear slope: the force is its integral, by hand.
        knots, slopes = (np.asarray(x, dtype=np.float64) for x in (response.normal.knots, response.normal.slopes))
        at_knots = np.concatenate([[0], np.cumsum(np.diff(knots) * (slopes[1:] + slopes[:-1]) / 2)])
        np.testing.assert_allclose(response.normal(knots), at_knots, rtol=1e-12)
        self.assertEqual((response.status, len(response.coupling)), (0, 0))
        self.assertEqual(response.normal(np.zeros((2, 3))).shape, (2, 3))
        with self.assertRaisesRegex(TypeError, "deflections.*complex128"):
            response.normal(1j)

    def test_its_certificate(self):
        self.assertTrue(self.plate.certified)
        self.assertEqual((self.plate.friction, self.plate.certificate.friction), (0.3, 0.3))
        self.assertGreaterEqual(self.plate.stick, STIFFNESS * (1 - 1e-6))  # the steepest slope of the normal response
        self.assertEqual(self.plate.stick, self.plate.certificate.stick)
        self.assertEqual(self.plate.lipschitz_bound, self.plate.certificate.lipschitz_bound)
        self.assertLessEqual(self.plate.min_lipschitz_bound, self.plate.lipschitz_bound)
        self.assertIn("N/m", self.plate.certificate.guarantee)
        self.assertIn(f"{self.plate.certificate.guarantee.split(' N/m')[0].split()[-1]} N/m", repr(self.plate))
        bare = palpate.Library(self.root / "uncertified.h5")
        self.assertFalse(bare.certified)
        self.assertEqual(bare.lipschitz_bound, np.inf)
        self.assertIn("no certificate", repr(bare))

    def test_an_hdf5_library_is_what_h5py_reads(self):
        for name in ("ball", "coupled", "relaxing", "leaning", "soft"):
            library = palpate.Library(self.root / f"{name}.h5")
            with h5py.File(self.root / f"{name}.h5") as file:
                self.assertTrue(np.array_equal(library.vertices, file["/surface/position"]))
                self.assertTrue(np.array_equal(library.normals, file["surface/inward"]))
                self.assertTrue(np.array_equal(library.triangles, file["surface/triangles"]))
                certificate = file["certificate"].attrs
                for key in ("stick", "slip", "friction", "min_lipschitz_bound"):
                    self.assertEqual(getattr(library.certificate, key), certificate[key], key)
                for vector, stored in (("lean", name in ("leaning", "soft")), ("soft_axis", name == "soft")):
                    row = file[f"response/{vector}"][5] if stored else np.zeros(3)
                    self.assertEqual(getattr(library.response(5), vector).tolist(), row.tolist())
            self.assertEqual(library.coupled, name in ("coupled", "leaning", "soft"))
            self.assertEqual(len(library.response(5).coupling) > 0, library.coupled)
            relaxing = name == "relaxing"
            self.assertEqual(list(library.relaxation_times), [0.02, 0.5] if relaxing else [])
            self.assertEqual(library.response(5).relaxation.shape, (2 if relaxing else 0,))

    def test_devices_of_the_certificate(self):
        bench, unknown = self.plate.certificate.devices
        self.assertEqual((bench.device, bench.damping, bench.coulomb_friction, bench.delay), ("bench", 2, 0.1, 0))
        # Without delay the damping suffices where L 3/2 T <= b.
        self.assertAlmostEqual(bench.lowest_rate, 1.5 * self.plate.lipschitz_bound / 2, places=9)
        self.assertTrue(self.plate.certificate.certifies(bench))
        self.assertFalse(self.plate.certificate.certifies(unknown))
        self.assertTrue(np.isnan(unknown.damping))
        self.assertIn("certified passive from", self.plate.certificate.verdict(bench))
        self.assertIn("unknown", self.plate.certificate.verdict(unknown))

    def test_a_surface_that_cannot_be_touched_is_refused(self):
        with self.assertRaisesRegex(palpate.FormatError, "refine the response surface"):
            palpate.Library(self.root / "samples/library.h5")

    def test_a_hole(self):
        hole = palpate.Library(self.root / "hole.h5")
        self.assertEqual((hole.vertex_status[0], hole.certificate.holes), (2, 1))
        self.assertEqual(len(hole.response(0).normal), 0)
        self.assertEqual(hole.response(0).normal(1e-3), 0)

    def test_every_kind_of_file_gives_the_same(self):
        flat = palpate.Library(self.root / "plate.plib")
        memory = palpate.Library.from_bytes((self.root / "plate.h5").read_bytes())
        text = palpate.Library(str(self.root / "plate.h5"))
        for other in (flat, memory, text):
            self.assertEqual(other.vertices.tobytes(), self.plate.vertices.tobytes())
            self.assertEqual(other.response(3).normal.slopes.tobytes(), self.plate.response(3).normal.slopes.tobytes())

    def test_arrays_are_views_that_keep_the_library(self):
        vertices = self.plate.vertices
        self.assertIs(vertices.base, self.plate)
        with self.assertRaisesRegex(ValueError, "read-only"):
            vertices[0] = 1
        knots = self.plate.response(7).normal.knots
        before = vertices.sum(), knots.sum()
        self.plate = None
        gc.collect()
        self.assertEqual((vertices.sum(), knots.sum()), before)

    def test_errors_name_the_file_and_the_remedy(self):
        with self.assertRaises(palpate.FileError) as caught:
            palpate.Library(self.root / "none.h5")
        self.assertIsInstance(caught.exception, OSError)
        self.assertEqual(caught.exception.where, str(self.root / "none.h5"))
        self.assertTrue(caught.exception.problem and caught.exception.remedy)
        self.assertEqual(str(caught.exception),
                         f"{caught.exception.where}: {caught.exception.problem}; {caught.exception.remedy}")
        with self.assertRaisesRegex(palpate.FileError, "a folder"):
            palpate.Library(self.root)
        os.mkfifo(self.root / "fifo")
        with self.assertRaisesRegex(palpate.FileError, "a FIFO"):
            palpate.Library(self.root / "fifo")
        with self.assertRaisesRegex(palpate.FormatError, "is not an HDF5 file.*palpate fit"):
            palpate.Library(__file__)
        whole = (self.root / "plate.plib").read_bytes()
        for damaged in (b"", whole[:-8], whole[:100] + b"x" + whole[101:]):
            with self.assertRaises(palpate.FormatError):
                palpate.Library.from_bytes(damaged)
        for vertex in (-1, 81):
            with self.assertRaisesRegex(palpate.ArgumentError, "0 to 80"):
                self.plate.response(vertex)
        for wrong in (3, None, object()):
            with self.assertRaises(TypeError):
                palpate.Library(wrong)
        for error in (palpate.FileError, palpate.FormatError, palpate.ArgumentError):
            self.assertTrue(issubclass(error, palpate.Error))

    def test_the_version_is_that_of_the_files(self):
        self.assertRegex(palpate.__version__, r"^\d+\.\d+\.\d+$")
        self.assertEqual(importlib.metadata.version("palpate"), palpate.__version__)
        with h5py.File(self.root / "plate.h5") as file:
            creator = file.attrs["creator"]
        creator = creator.decode() if isinstance(creator, bytes) else creator
        self.assertEqual(re.match(r"palpate (\S+)", creator).group(1), palpate.__version__)


if __name__ == "__main__":
    WRITE_SAMPLES = sys.argv.pop(2)
    WRITE_BODIES = sys.argv.pop(1)
    unittest.main()
