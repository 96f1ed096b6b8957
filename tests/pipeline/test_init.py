#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""`palpate init` on real surfaces, volume meshes and segmentations: the case that it writes is meshed. And
`palpate check` and `palpate doctor`.

Usage: test_init.py PALPATE SOURCE_FOLDER
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
SOURCES = None
UNITS = {"mm": 1e-3, "cm": 1e-2, "dm": 1e-1, "in": 0.0254, "m": 1.0}


def metres(quantity):
    number, unit = quantity.split()
    return float(number) * UNITS[unit]


def palpate(*arguments):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)


class Init(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def init(self, file, *options, name="case"):
        """The case of a surface, without trial sites unless `options` give the minutes."""
        case = self.root / f"{name}.toml"
        minutes = () if "--minutes" in options else ("--minutes", 0)
        done = palpate("init", file, "-o", case, *minutes, *options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return case, tomllib.loads(case.read_text(encoding="utf-8")), done.stdout

    def mesh(self, case):
        """Nodes, m, and number of sites of the body."""
        done = palpate("mesh", case, "--out", self.root / "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with h5py.File(self.root / "out" / "body.h5") as body:
            return body["nodes"][:], int(body["response/is_site"][:].sum()), len(body["fixed_nodes"])

    def assert_serves(self, file, sites=80):
        """Init and mesh: sizes fit the body, some nodes are fixed, and about so many sites are left."""
        case, keys, said = self.init(file, "--sites", sites)
        nodes, made, fixed = self.mesh(case)
        self.assertEqual(int(re.search(r"sites: (\d+)", said).group(1)), made)
        self.assertRegex(case.read_text(encoding="utf-8"), rf"patch_spacing = .*\b{made} sites on ")
        if "instead of" not in said:
            self.assertLess(abs(made - sites), 0.3 * sites)
        extent = np.ptp(nodes, axis=0).max()
        self.assertLess(metres(keys["mesh"]["patch_spacing"]), extent / 5)
        self.assertGreater(metres(keys["mesh"]["patch_spacing"]), extent / 100)
        self.assertLess(metres(keys["indentation"]["depth"]), metres(keys["tool"]["radius"]))
        self.assertGreater(made, sites / 3)
        self.assertGreater(fixed, 3)
        self.assertLess(fixed, len(nodes) / 2)

    def test_liver(self):
        self.assert_serves(SOURCES / "data/bodies/sofa/liver.obj")

    def test_tongue(self):
        self.assert_serves(SOURCES / "tests/data/surfaces/sofa/tongue.obj")

    def test_head_with_holes(self):
        self.assert_serves(SOURCES / "tests/data/surfaces/sofa/head.obj")

    def test_pelvis_of_genus_one(self):
        self.assert_serves(SOURCES / "tests/data/surfaces/sofa/pelvis_f.obj")

    def test_shipped_organ(self):
        self.assert_serves(SOURCES / "data/bodies/organ.off")

    def test_volume_mesh(self):
        self.assert_serves(SOURCES / "tests/data/meshes/gmsh/body_41.msh")

    def test_segmentation(self):
        self.assert_serves(SOURCES / "tests/data/meshes/images/ball_sform.nii.gz")

    def test_a_campaign_that_is_asked_to_be_short_is(self):
        """The estimate of `build` agrees with what the case says, within the noise of a busy machine."""
        case, keys, said = self.init(SOURCES / "tests/data/surfaces/sofa/salad_bowl.obj", "--minutes", "0.001")
        free, free_keys, _ = self.init(SOURCES / "tests/data/surfaces/sofa/salad_bowl.obj", name="free")
        self.assertIn("# Its campaign takes about ", case.read_text(encoding="utf-8"))
        self.assertNotIn("# Its campaign takes about ", free.read_text(encoding="utf-8"))
        self.assertIn("more than the 0.001 min wanted", said)
        cost = [metres(k["mesh"]["patch_spacing"]) for k in (keys, free_keys)]
        depth = [metres(k["indentation"]["depth"]) for k in (keys, free_keys)]
        # The shape of a thin bowl leaves neither larger patches nor a smaller depth, which the remark admits.
        self.assertGreaterEqual(cost[0], cost[1], said)
        self.assertLessEqual(depth[0], depth[1], said)

    def test_unit_of_the_liver_is_guessed_and_called_a_guess(self):
        source = (SOURCES / "data/bodies/sofa/liver.obj").read_text(encoding="utf-8")
        for unit in ("m", "cm", "mm", "in"):
            factor = UNITS["dm"] / UNITS[unit]
            scaled = re.sub(r"^v (\S+) (\S+) (\S+)",
                            lambda v: "v " + " ".join(repr(float(v[k]) * factor) for k in (1, 2, 3)),
                            source, flags=re.MULTILINE)
            file = self.root / f"liver_{unit}.obj"
            file.write_text(scaled, encoding="utf-8")
            case, keys, said = self.init(file, name=f"liver_{unit}")
            self.assertEqual(keys["surface"]["unit"], unit)
            self.assertIn("GUESS", said)
            self.assertRegex(case.read_text(encoding="utf-8"), r'unit = .*# a GUESS from the size: .*215 mm')

    def test_given_unit_is_taken(self):
        _, keys, said = self.init(SOURCES / "data/bodies/sofa/liver.obj", "--unit", "cm")
        self.assertEqual(keys["surface"]["unit"], "cm")
        self.assertNotIn("GUESS", said)

    def test_a_file_is_not_overwritten(self):
        case = self.root / "case.toml"
        case.write_text("mine", encoding="utf-8")
        done = palpate("init", SOURCES / "data/bodies/pad.off", "-o", case)
        self.assertEqual(done.returncode, 2)
        self.assertIn("the file exists", done.stderr)
        self.assertEqual(case.read_text(encoding="utf-8"), "mine")

    def test_what_is_no_body_is_refused_and_nothing_is_written(self):
        empty = SOURCES / "tests/data/surfaces/trimesh/empty.stl"
        for code, arguments in ((3, (empty,)), (2, (self.root / "none.stl",)), (3, (SOURCES / "README.md",)),
                                (2, (SOURCES / "data/bodies/pad.off", "--unit", "feet"))):
            done = palpate("init", *arguments, "-o", self.root / "case.toml")
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertFalse((self.root / "case.toml").exists())


class Check(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_sound_repairable_and_refused(self):
        surfaces = SOURCES / "tests/data/surfaces"
        for code, file, words in (
                (0, SOURCES / "data/bodies/organ.off", "check: sound"),
                (0, surfaces / "sofa/head.obj", "fault: 40 border edges"),
                (3, surfaces / "surfice/cortex_5124.obj", "2 separate parts"),
                (3, surfaces / "trimesh/empty.stl", "")):
            done = palpate("check", file)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            self.assertIn(words, done.stdout)
            self.assertEqual(len(done.stderr.splitlines()), 0 if code == 0 else 1)

    def test_files_are_written_on_request_and_are_what_check_says(self):
        head = SOURCES / "tests/data/surfaces/sofa/head.obj"
        done = palpate("check", head, "--out", self.root / "mended.ply", "--faults", self.root / "faults.vtp")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("fault", (self.root / "faults.vtp").read_text(encoding="utf-8"))
        again = palpate("check", self.root / "mended.ply", "--unit", "cm")
        self.assertIn("check: sound", again.stdout)
        self.assertEqual(palpate("check", head, "--out", self.root / "mended.stl").returncode, 2)


class Doctor(unittest.TestCase):
    def test_a_line_for_each_subject(self):
        done = palpate("doctor")
        self.assertEqual(done.returncode, 0, done.stderr)
        for subject in ("processors", "memory", "BLAS kernel", "real-time rights", "loop of 1 kHz", "ParaView",
                        "disk"):
            self.assertRegex(done.stdout, rf"(?m)^(ok|missing) .*{subject}")


if __name__ == "__main__":
    SOURCES = Path(sys.argv.pop(2))
    PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
