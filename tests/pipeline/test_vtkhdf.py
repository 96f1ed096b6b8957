#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""VTKHDF files, read by VTK, against the artifacts they were made from, read by h5py.

usage: vtkhdf_test.py <write_sample_grids>
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_TETRA, VTK_TRIANGLE
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOHDF import vtkHDFReader

PROGRAM = pathlib.Path(sys.argv[1])
DEPTH = 0.003


class VtkHdf(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.output = subprocess.run([PROGRAM, cls.folder], check=True, text=True,
                                    stdout=subprocess.PIPE).stdout

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def grid(self, name):
        reader = vtkHDFReader()
        path = str(self.folder / f"{name}.vtkhdf")
        self.assertTrue(reader.CanReadFile(path), path)
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
        self.assertGreater(grid.GetNumberOfCells(), 0)
        return grid

    def arrays(self, data):
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
                for i in range(data.GetNumberOfArrays())}

    def assert_points(self, grid, positions):
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), positions)

    def assert_cells(self, grid, cell_type, corners):
        self.assertEqual(grid.GetNumberOfCells(), len(corners))
        for i, wanted in enumerate(corners):
            self.assertEqual(grid.GetCellType(i), cell_type)
            ids = grid.GetCell(i).GetPointIds()
            self.assertEqual([ids.GetId(k) for k in range(ids.GetNumberOfIds())], list(wanted))

    def test_body(self):
        grid = self.grid("body")
        with h5py.File(self.folder / "body.h5", "r") as body:
            self.assert_points(grid, body["nodes"][()])
            self.assert_cells(grid, VTK_TETRA, body["tetrahedra"][()])
            count = len(body["nodes"])
            node, is_site = body["response/node"][()], body["response/is_site"][()]
            points, cells = self.arrays(grid.GetPointData()), self.arrays(grid.GetCellData())
            self.assertEqual(set(points), {"fixed", "response", "site", "inward"})
            self.assertEqual(set(cells), {"region"})
            np.testing.assert_array_equal(np.flatnonzero(points["fixed"]), body["fixed_nodes"])
            np.testing.assert_array_equal(np.flatnonzero(points["response"]), np.sort(node))
            np.testing.assert_array_equal(points["site"][node], is_site)
            np.testing.assert_array_equal(points["inward"][node], body["response/inward"])
            others = np.setdiff1d(np.arange(count), node)
            self.assertEqual(np.abs(points["inward"][others]).sum(), 0)
            np.testing.assert_array_equal(cells["region"], body["tetrahedron_region"])

    def test_vtk_finds_the_volumes(self):
        """VTK computes positive volumes: orientation and order of the corners are right."""
        sizes = vtkCellSizeFilter()
        sizes.SetInputData(self.grid("body"))
        sizes.Update()
        found = self.arrays(sizes.GetOutput().GetCellData())["Volume"]
        with h5py.File(self.folder / "body.h5", "r") as body:
            corners = body["nodes"][()][body["tetrahedra"][()]]
        edges = corners[:, 1:] - corners[:, :1]
        np.testing.assert_allclose(found, np.linalg.det(edges) / 6, rtol=1e-12)
        self.assertGreater(found.min(), 0)

    def test_deformed_state(self):
        grid = self.grid("deformed")
        X = vtk_to_numpy(grid.GetPoints().GetData())
        points, cells = self.arrays(grid.GetPointData()), self.arrays(grid.GetCellData())
        wanted = np.column_stack([0.5 * X[:, 2], -0.25 * X[:, 0], 2 * X[:, 1]])
        np.testing.assert_array_equal(points["displacement"], wanted)
        row = np.arange(grid.GetNumberOfCells())
        np.testing.assert_array_equal(cells["strain_energy_density"], 0.5 * row)
        np.testing.assert_array_equal(cells["pressure"], -3.0 * row)
        np.testing.assert_array_equal(cells["smooth_pressure"], -2.0 * row)
        self.assertIn("region", cells)

    def test_library(self):
        grid = self.grid("library")
        points, cells = self.arrays(grid.GetPointData()), self.arrays(grid.GetCellData())
        with h5py.File(self.folder / "library.h5", "r") as library:
            self.assert_points(grid, library["surface/position"][()])
            self.assert_cells(grid, VTK_TRIANGLE, library["surface/triangles"][()])
            np.testing.assert_array_equal(points["inward"], library["surface/inward"])
            for name in ("status", "normal_error", "lateral_error"):
                np.testing.assert_array_equal(points[name], library["response"][name])
            for name in ("stick", "slip", "kappa", "cos_theta", "sliding_passive"):
                np.testing.assert_array_equal(cells[name], library["certificate/triangle"][name])
            for which in ("normal", "lateral"):
                force, slope = self.responses(library["response"], which)
                np.testing.assert_allclose(points[f"{which}_stiffness"], slope, rtol=1e-12)
                np.testing.assert_allclose(points[f"{which}_force"], force, rtol=1e-12)
        self.assertEqual(np.isnan(points["normal_force"]).sum(), 1)

    def responses(self, response, which):
        """Force and slope at DEPTH from the definition: the slope is linear between knots."""
        offset, status = response[f"{which}_offset"][()], response["status"][()]
        force, slope = [], []
        for i, (first, last) in enumerate(zip(offset[:-1], offset[1:])):
            if status[i] == 2:
                force.append(np.nan)
                slope.append(np.nan)
                continue
            knot = response[f"{which}_knot"][first:last].astype(float)
            s = response[f"{which}_slope"][first:last].astype(float)
            end = DEPTH if which == "normal" else min(DEPTH, knot[-1])
            corners = np.append(knot[knot < end], end)
            slope.append(np.interp(end, knot, s))
            force.append(np.trapz(np.interp(corners, knot, s), corners))
        return np.array(force), np.array(slope)

    def test_library_before_certification(self):
        self.assertEqual(self.arrays(self.grid("uncertified").GetCellData()), {})

    def test_mixed_cells(self):
        grid = self.grid("mixed")
        with h5py.File(self.folder / "body.h5", "r") as body:
            tetrahedra, triangles = len(body["tetrahedra"]), body["boundary"][()]
        types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
        self.assertEqual(types, [VTK_TETRA] * tetrahedra + [VTK_TRIANGLE] * len(triangles))
        ids = grid.GetCell(tetrahedra + 4).GetPointIds()
        self.assertEqual([ids.GetId(k) for k in range(3)], triangles[4].tolist())

    def test_provenance_travels_along(self):
        with h5py.File(self.folder / "library.vtkhdf", "r") as file:
            self.assertEqual(len(file["provenance"]), 4)
            self.assertEqual(file["VTKHDF/PointData/normal_force"].attrs["units"], "N")

    def test_broken_grids_are_refused(self):
        self.assertEqual(self.output.count("refused: "), 8, self.output)
        self.assertFalse((self.folder / "refused.vtkhdf").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
