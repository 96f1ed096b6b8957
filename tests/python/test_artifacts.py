#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""palpate.read_body, read_curves, read_recording and read_session against h5py.

Usage: test_artifacts.py WRITE_SAMPLE_ARTIFACTS
"""
import gc
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import palpate

WRITE_SAMPLES = None
# Attribute -> dataset.
BODY = {"nodes": "nodes", "tetrahedra": "tetrahedra", "tetrahedron_region": "tetrahedron_region",
        "boundary": "boundary", "fixed_nodes": "fixed_nodes", "response_nodes": "response/node",
        "response_normals": "response/inward", "response_triangles": "response/triangles",
        "is_site": "response/is_site"}
SPRUNG = {"foundation": "foundation/facet", "foundation_normal_stiffness": "foundation/normal_stiffness",
          "foundation_tangential_stiffness": "foundation/tangential_stiffness"}
CURVED = {"curved_edges": "curved_edges/ends", "curved_edge_middles": "curved_edges/middle"}
SAMPLES = ("displacement", "force", "strain_energy", "tool_work", "contact_energy", "min_jacobian", "penetration",
           "contact_area", "tension", "iterations", "force_scatter", "force_uncertainty",
           "facets_in_contact", "mesh_difference", "mesh_error", "volume_change")
STEP = {"time_ns": "time", "latency_ns": "latency",
        **{name: name for name in ("position", "velocity", "force", "contact_point", "depth", "lateral", "offset",
                                   "energy", "tank", "absorbed", "element", "status")}}


def text_of(value):
    return value.decode() if isinstance(value, bytes) else value


class Artifacts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        subprocess.run([WRITE_SAMPLES, cls.root], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def assert_same(self, actual, dataset, what):
        expected = dataset[()]
        self.assertEqual(actual.dtype, expected.dtype, what)
        self.assertEqual(actual.shape, expected.shape, what)
        self.assertEqual(np.ascontiguousarray(actual).tobytes(), expected.tobytes(), what)  # also NaN
        self.assertFalse(actual.flags.writeable, what)

    def assert_all_same(self, owner, file, names):
        for name, dataset in names.items():
            self.assert_same(getattr(owner, name), file[dataset], name)

    def test_bodies(self):
        for name in ("body", "sprung", "curved"):
            body = palpate.read_body(self.root / f"{name}.h5")
            with h5py.File(self.root / f"{name}.h5") as file:
                self.assert_all_same(body, file, BODY)
                self.assertEqual(body.region_names, [text_of(x) for x in file["region_names"][()]])
                self.assertEqual(body.name, text_of(file.attrs["name"]))
                self.assertEqual(len(body.foundation) > 0, name != "body")
                self.assertEqual(len(body.curved_edges) > 0, name == "curved")
                if name == "curved":
                    self.assert_all_same(body, file, CURVED)
                if name != "body":
                    self.assert_all_same(body, file, SPRUNG)
            x = body.nodes[body.tetrahedra]
            volumes = np.einsum("ij,ij->i", np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), x[:, 3] - x[:, 0]) / 6
            self.assertTrue(np.all(volumes > 0))
            # The facets of the boundary enclose as much as the tetrahedra fill.
            a, b, c = (body.nodes[body.boundary[:, k]] for k in range(3))
            self.assertAlmostEqual(np.einsum("ij,ij->", np.cross(a, b), c) / 6 / volumes.sum(), 1, places=12)
            self.assertEqual(body.provenance[0].stage, "mesh")

    def test_curves(self):
        for name in ("curves", "relaxing_curves"):
            curves = palpate.read_curves(self.root / f"{name}.h5")
            with h5py.File(self.root / f"{name}.h5") as file:
                paths = [path for site in curves.sites for path in site.paths]
                for key in SAMPLES:
                    together, expected = np.concatenate([getattr(p, key) for p in paths]), file[f"sample/{key}"][()]
                    self.assertEqual(together.dtype, expected.dtype)
                    self.assertEqual(together.tobytes(), expected.tobytes(), key)
                np.testing.assert_array_equal([path.direction for path in paths], file["path/direction"])
                self.assertEqual([path.repeats for path in paths], file["path/repeats"][()].tolist())
                for key in ("depth", "lateral_travel"):
                    self.assertEqual(getattr(curves, key), file.attrs[key])
                self.assertEqual((curves.tool.shape, curves.tool.radius),
                                 (text_of(file.attrs["tool_shape"]), file.attrs["tool_radius"]))
                if name == "relaxing_curves":
                    energies = np.concatenate([path.isochoric_energy.ravel() for path in paths])
                    np.testing.assert_array_equal(energies, file["relaxation/isochoric_energy"])
                    np.testing.assert_array_equal(curves.relaxation_fractions.ravel(), file["relaxation/fraction"])
                    np.testing.assert_array_equal(curves.relaxation_times, file["relaxation/time"])
                self.assertEqual([site.vertex for site in curves.sites], file["site/vertex"][()].tolist())
            self.assertEqual({site.status for site in curves.sites}, {"complete", "partial", "failed"})
            for site in curves.sites:
                self.assertEqual(site.reason == "", site.status == "complete")
                self.assertIs(curves.site(site.vertex).vertex, site.vertex)
                for path in site.paths:
                    np.testing.assert_allclose(path.force_along, path.force @ path.direction, rtol=1e-12, atol=1e-14)
                    self.assertEqual(path.kind == "normal", path.lateral_depth == 0)
                    self.assertEqual(len(path), len(path.displacement))
                    regions = 2 if "relaxing" in name and len(path) > 0 else 0
                    self.assertEqual(path.isochoric_energy.shape, (len(path), regions))
                if site.paths:
                    self.assertEqual(site.normal.kind, "normal")
                    self.assertEqual(len(site.lateral), len(site.paths) - 1)
                else:
                    self.assertIsNone(site.normal)
            self.assertEqual(len(curves.relaxation_times) > 0, name == "relaxing_curves")
            self.assertEqual(curves.relaxation_fractions.shape[-1], len(curves.relaxation_times))
        with self.assertRaisesRegex(palpate.ArgumentError, "is no site"):
            curves.site(-1)

    def test_a_recording(self):
        recording = palpate.read_recording(self.root / "recording.h5")
        self.assertEqual(len(recording), 5000)
        with h5py.File(self.root / "recording.h5") as file:
            self.assert_all_same(recording, file, {name: f"step/{key}" for name, key in STEP.items()})
            np.testing.assert_array_equal(recording.time, file["step/time"][()] * 1e-9)
            self.assertEqual((recording.device, recording.rate, recording.friction),
                             (text_of(file.attrs["device"]), file.attrs["rate"], file.attrs["friction"]))
        self.assertTrue(np.isnan(recording.position).any())
        self.assertEqual(recording.gaps, [])
        session = palpate.read_session(self.root / "recording.h5")
        self.assertEqual(session.force.tobytes(), recording.force.tobytes())

    def test_views_keep_what_they_show(self):
        nodes = palpate.read_body(self.root / "body.h5").nodes
        path = palpate.read_curves(self.root / "curves.h5").sites[0].paths[0]
        force = path.force
        before = nodes.sum(), force.sum()
        del path
        gc.collect()
        palpate.read_curves(self.root / "curves.h5")
        self.assertEqual((nodes.sum(), force.sum()), before)

    def test_the_wrong_file_is_refused_by_name(self):
        readers = {"body": palpate.read_body, "curves": palpate.read_curves, "recording": palpate.read_recording}
        for wanted, read in readers.items():
            for given in ("body", "curves", "recording", "library"):
                if given == wanted:
                    continue
                with self.assertRaises(palpate.FormatError) as caught:
                    read(self.root / f"{given}.h5")
                self.assertIn(f"{given}.h5", caught.exception.where)
                self.assertTrue(caught.exception.remedy)
            with self.assertRaises(palpate.FileError):
                read(self.root / "none.h5")
            with self.assertRaises(TypeError):
                read(7)
            with self.assertRaises(palpate.FormatError):
                read(self.root / "body.txt")
        with self.assertRaises(palpate.FormatError):
            palpate.read_session(self.root / "body.txt")


if __name__ == "__main__":
    WRITE_SAMPLES = sys.argv.pop(1)
    unittest.main()
