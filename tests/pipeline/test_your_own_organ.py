#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Every command of docs/your-own-organ.md, in its order, on real files of the names that the page uses.

Usage: test_your_own_organ.py PALPATE SOURCE_FOLDER. The organ is the liver of SOFA as an STL file in
millimetres, moved so that its lowest point is at z = 0.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

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
        meshes = SOURCES / "tests/data/meshes"
        shutil.copy(meshes / "images/ball_sform.nii.gz", self.root / "segmentation.nii.gz")
        shutil.copy(meshes / "gmsh/body_41.msh", self.root / "mesh.msh")

    def tearDown(self):
        self.folder.cleanup()

    def run_line(self, line):
        done = subprocess.run(["sh", "-c", line], cwd=self.root, env=self.env, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}{done.stderr}")

    def test_commands(self):
        lines = [line for block in blocks(self.page, "sh") for line in block.splitlines()]
        self.assertGreater(len(lines), 6)
        for line in lines:
            self.run_line(line)
        for name in ("organ/library.h5", "organ/recording.h5", "organ/report.html", "segmentation/body.h5",
                     "mesh/body.h5"):
            self.assertTrue((self.root / "out" / name).is_file(), name)

    def test_minimal_case_of_ten_lines(self):
        (case,) = blocks(self.page, "toml")
        self.assertEqual(len(case.splitlines()), 10)
        (self.root / "minimal.toml").write_text(case, encoding="utf-8")
        self.run_line("palpate mesh minimal.toml")


if __name__ == "__main__":
    SOURCES = Path(sys.argv.pop(2))
    PALPATE = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
