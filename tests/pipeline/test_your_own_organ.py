#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Every command of docs/your-own-organ.md, in its order, on real files of the names that the page uses.

Usage: test_your_own_organ.py PALPATE SOURCE_FOLDER. The organ is the liver of SOFA: as an STL file in millimetres,
moved so that its lowest point is at z = 0; as a segmentation, from the voxels inside that surface; and as a mesh, of
its tetrahedra.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
import vtk

PALPATE = None
SOURCES = None


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page, flags=re.MULTILINE | re.DOTALL)


def write_stl(path, obj):
    """The triangles of an OBJ file in decimetres."""
    points, faces = [], []
    for line in obj.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([100 * float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word) - 1 for word in words[1:4]])
    points = np.array(points)
    points[:, 2] -= points[:, 2].min()
    record = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("flags", "<u2")])
    record["corner"] = points[np.array(faces)]
    path.write_bytes(b"\0" * 80 + np.uint32(len(faces)).tobytes() + record.tobytes())


def write_segmentation(path, stl, voxel=4.0):
    """The voxels inside a surface, 1 there and 0 elsewhere."""
    reader = vtk.vtkSTLReader()
    reader.SetFileName(str(stl))
    reader.Update()
    box = reader.GetOutput().GetBounds()
    image = vtk.vtkImageData()
    image.SetSpacing(voxel, voxel, voxel)
    image.SetOrigin(*(box[2 * k] - 2 * voxel for k in range(3)))
    image.SetDimensions(*(int((box[2 * k + 1] - box[2 * k]) / voxel) + 5 for k in range(3)))
    image.AllocateScalars(vtk.VTK_SHORT, 1)
    image.GetPointData().GetScalars().Fill(1)
    inside = vtk.vtkPolyDataToImageStencil()
    inside.SetInputConnection(reader.GetOutputPort())
    inside.SetOutputOrigin(image.GetOrigin())
    inside.SetOutputSpacing(image.GetSpacing())
    inside.SetOutputWholeExtent(image.GetExtent())
    masked = vtk.vtkImageStencil()
    masked.SetInputData(image)
    masked.SetStencilConnection(inside.GetOutputPort())
    masked.SetBackgroundValue(0)
    writer = vtk.vtkNIFTIImageWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(masked.GetOutputPort())
    writer.Write()


class YourOwnOrgan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = (SOURCES / "docs/your-own-organ.md").read_text(encoding="utf-8")

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        (self.root / "bin").mkdir()
        (self.root / "bin" / "palpate").symlink_to(PALPATE)
        self.env = {**os.environ, "PATH": f"{self.root / 'bin'}:{os.environ['PATH']}"}
        write_stl(self.root / "organ.stl", SOURCES / "data/bodies/sofa/liver.obj")

    def write_other_kinds(self):
        write_segmentation(self.root / "segmentation.nii.gz", self.root / "organ.stl")
        for line in ("init organ.stl --sites 40 --minutes 0 -o solid.toml", "mesh solid.toml", "export mesh solid.toml"):
            self.run_line(f"palpate {line}")
        shutil.copy(self.root / "out/solid/body.msh", self.root / "mesh.msh")

    def tearDown(self):
        self.folder.cleanup()

    def run_line(self, line):
        # The campaigns of the page may take a quarter of an hour each; here they have half a minute.
        if "--minutes" not in line:
            line = line.replace("palpate init", "palpate init --minutes 0.4")
        done = subprocess.run(["sh", "-c", line], cwd=self.root, env=self.env, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}{done.stderr}")

    def test_commands(self):
        self.write_other_kinds()
        lines = [line for block in blocks(self.page, "sh") for line in block.splitlines()]
        self.assertGreater(len(lines), 6)
        for line in lines:
            self.run_line(line)
        for name in ("organ/library.h5", "organ/recording.h5", "organ/report.html", "segmentation/body.h5",
                     "mesh/body.h5"):
            self.assertTrue((self.root / "out" / name).is_file(), name)
        volumes = []
        for name in ("organ", "segmentation", "mesh"):
            with h5py.File(self.root / "out" / name / "body.h5") as body:
                corners = body["nodes"][:][body["tetrahedra"][:]]
            edges = corners[:, 1:] - corners[:, :1]
            volumes.append(abs(np.linalg.det(edges)).sum() / 6)
        for volume in volumes[1:]:
            self.assertLess(abs(volume / volumes[0] - 1), 0.1)

    def test_minimal_case_of_ten_lines(self):
        case = blocks(self.page, "toml")[0]
        self.assertEqual(len(case.splitlines()), 10)
        (self.root / "minimal.toml").write_text(case, encoding="utf-8")
        self.run_line("palpate mesh minimal.toml")


if __name__ == "__main__":
    SOURCES = Path(sys.argv.pop(2))
    PALPATE = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
