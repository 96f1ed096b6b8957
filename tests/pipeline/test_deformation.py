#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""From a case with [deformation] to deformation.pdef, and its error at hold-out points.

Usage: test_deformation.py PALPATE.
"""
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import write_case  # noqa: E402

PALPATE = None


def palpate(*arguments):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)


class Deformation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.case = write_case(cls.root)
        cls.case.write_text(cls.case.read_text() + "\n[deformation]\ndepths = 3\n")
        cls.out = cls.root / "out"
        cls.built = palpate("build", cls.case, "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_1_the_build_writes_it_beside_the_library(self):
        self.assertEqual(self.built.returncode, 0, self.built.stderr)
        self.assertTrue((self.out / "deformation.pdef").is_file())
        self.assertIn("deformation.pdef", self.built.stdout + self.built.stderr)
        again = palpate("build", self.case, "--out", self.out)
        self.assertEqual((again.stdout + again.stderr).count("up to date"), 4)

    def test_2_its_error_at_hold_out_points_is_small(self):
        run = palpate("compare", "--fem", self.case, "--out", self.out, "--points", 3, "--nodes", 1)
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = json.loads((self.out / "fidelity.json").read_text())["libraries"][0]["skin"]
        kinds = ("press", "lateral within friction", "lateral beyond friction")
        parts = ("within 3 tool radii", "whole skin")
        self.assertEqual([row["what"] for row in rows], [f"{kind}, {part}" for kind in kinds for part in parts])
        for row in rows:
            self.assertGreater(row["states"], 3)
            # The elements are larger than the contact: the direct skin under the tool depends on where it lies
            # in the mesh by a tenth of the depth, which no blend of sites can know.
            self.assertLess(row["median"], 0.05, row)
            self.assertLess(row["p95"], 0.05 if "whole" in row["what"] else 0.2, row)

    def test_2b_the_skin_of_the_response_surface_is_smaller_and_played(self):
        run = palpate("export", "skin", self.case, "--out", self.out, "--modes", 8)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"8 modes that leave out \S+ [mun]+m")
        skin = self.out / "skin.pdef"
        self.assertLess(skin.stat().st_size, 0.5 * (self.out / "deformation.pdef").stat().st_size)
        alone = self.root / "alone"
        alone.mkdir()
        for part, name in (("runtime", "library.plib"), ("surface", "surface.off")):
            self.assertEqual(palpate("export", part, self.case, "--out", self.out).returncode, 0)
            shutil.copy(self.out / name, alone / f"block{Path(name).suffix}")
        shutil.copy(skin, alone / "block.pdef")
        page = alone / "page.html"
        run = palpate("play", alone / "block.plib", "--out", page, "--no-open")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn('"of_point"', page.read_text())
        (self.out / "deformation.pdef").rename(self.out / "kept.pdef")
        run = palpate("export", "skin", self.case, "--out", self.out)
        (self.out / "kept.pdef").rename(self.out / "deformation.pdef")
        self.assertEqual(run.returncode, 2)
        self.assertIn("set depths in [deformation]", run.stderr)

    def test_3_without_its_fields_it_is_refused_by_name(self):
        copy = self.root / "copy"
        shutil.copytree(self.out, copy)
        site = sorted((copy / "fields").iterdir())[0]
        site.unlink()
        run = palpate("fit", self.case, "--out", copy)
        self.assertEqual(run.returncode, 2)
        self.assertIn(site.name, run.stderr)

    def test_4_a_case_that_does_not_ask_for_it_has_none(self):
        plain = self.root / "plain.toml"
        plain.write_text(self.case.read_text().replace("depths = 3", "depths = 0"))
        run = palpate("fit", plain, "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertFalse((self.out / "deformation.pdef").exists())


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main()
