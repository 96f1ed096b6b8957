#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Mistakes of users, by the real command: the right exit code and exactly one line that says
what, where and what to do, and nothing left behind. Usage: bad_input_test.py PALPATE
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import CASE, SIZE, block, write_case  # noqa: E402

PALPATE = None
USAGE, GEOMETRY = 2, 3

# A support below the body.
NO_FIXED_NODES = CASE[: CASE.index("[[support]]")] + """[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "-5 mm"]
normal = [0, 0, -1]

""" + CASE[CASE.index("[[material]]") :]

UNREPAIRED = CASE.replace('unit = "mm"', 'unit = "mm"\nrepair = "none"', 1)


def open_block():
    vertices, triangles = block(SIZE, 5)
    return vertices, triangles[:-1]


def crossing_block():
    """A surface of two intersecting boxes."""
    vertices, triangles = block(SIZE, 5)
    moved = [(x + 10, y + 10, z + 10) for x, y, z in vertices]
    shifted = [tuple(i + len(vertices) for i in triangle) for triangle in triangles]
    return vertices + moved, triangles + shifted


def dented_block():
    """A surface that intersects itself: a top vertex is moved through the base."""
    vertices, triangles = block(SIZE, 5)
    top = vertices.index((20.0, 20.0, 20.0))
    vertices[top] = (20.0, 20.0, -15.0)
    return vertices, triangles


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.out = self.root / "out"

    def tearDown(self):
        self.folder.cleanup()

    def refuse(self, code, words, *arguments, left=()):
        """Expects the exit code, the words in the message, and nothing in the folder but the files `left`."""
        result = subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)
        *warnings, message = result.stderr.splitlines()
        self.assertEqual(result.returncode, code, message)
        self.assertTrue(message.startswith("error: "), message)
        self.assertTrue(all(line.startswith("warning: ") for line in warnings), warnings)
        self.assertIn("; ", message)  # the remedy comes after it
        for word in words:
            self.assertIn(word, message)
        found = [p.name for p in self.out.rglob("*")] if self.out.is_dir() else []
        self.assertEqual(found, list(left))

    def refuse_case(self, code, words, case=CASE, surface=None, left=()):
        path = write_case(self.root, case, surface)
        self.refuse(code, words, "build", path, "--out", self.out, left=left)

    def test_case_file_is_missing(self):
        self.refuse(USAGE, ["none.toml", "cannot read"], "build", self.root / "none.toml", "--out", self.out)

    def test_case_file_is_empty(self):
        self.refuse_case(USAGE, ["block.toml:1", "'support' is missing"], case="")

    def test_case_has_no_body(self):
        without = CASE[:CASE.index("[surface]")] + CASE[CASE.index("[mesh]"):]
        self.refuse_case(USAGE, ["block.toml", "none of [surface], [volume_mesh], [image] and [measured]", "add [surface]"], without)

    def test_patches_as_large_as_the_body(self):
        case = CASE.replace('patch_spacing = "12.5 mm"', 'patch_spacing = "40 mm"')
        self.refuse_case(USAGE, ["50 mm", "patches of 40 mm", "check the unit"], case)

    def test_surface_is_missing(self):
        path = write_case(self.root)
        (self.root / "block.off").unlink()
        self.refuse(USAGE, ["block.off", "no such file"], "build", path, "--out", self.out)

    def test_a_device_profile_that_is_missing_ends_nothing_but_the_command(self):
        """It is needed by the last stage alone, after the campaign."""
        case = CASE.replace("device.toml", "none.toml")
        self.refuse_case(USAGE, ["none.toml", "cannot read the device profile"], case)
        self.refuse(USAGE, ["none.toml"], "build", self.root / "block.toml", "--out", self.out, "--estimate")

    def test_memory_without_a_unit(self):
        path = write_case(self.root)
        for size in ("8", "8XB", "much"):
            self.refuse(USAGE, ["--memory", f"'{size}'", "8GB"], "build", path, "--out", self.out, "--memory", size)

    def test_sites_without_convergence(self):
        self.refuse(USAGE, ["--sites", "--convergence"], "precompute", write_case(self.root), "--out", self.out, "--sites", 3)

    def test_a_word_that_is_like_no_key_is_answered_with_the_keys(self):
        self.refuse_case(USAGE, ["'colour'", "known are", "moduli"], CASE.replace("young =", 'colour = "red"\nyoung ='))

    def refuse_faces(self, words, surface, case=CASE):
        """The refusal names a file with the faulty faces."""
        self.refuse_case(GEOMETRY, [*words, "faulty-faces.vtp"], case, surface, left=["faulty-faces.vtp"])

    def test_surface_is_not_watertight(self):
        self.refuse_faces(["block.off", "not watertight"], open_block(), UNREPAIRED)

    def test_surface_is_in_parts(self):
        self.refuse_faces(["block.off", "2 separate parts", "mm^3"], crossing_block())

    def test_surface_intersects_itself(self):
        self.refuse_faces(["block.off", "self-intersects", "pairs of triangles"], dented_block(), UNREPAIRED)

    def test_surface_has_a_wrong_unit(self):
        self.refuse_case(USAGE, ["block.off", "0.05 mm", "check the unit"], CASE.replace('unit = "mm"', 'unit = "um"'))
        self.refuse_case(GEOMETRY, ["block.off", "outside", "likely"], CASE.replace('unit = "mm"', 'unit = "m"'))

    def test_unit_is_of_another_kind(self):
        self.refuse_case(USAGE, ["block.toml:9", "patch_spacing", "10 kPa", "mm"],
                         CASE.replace('"12.5 mm"', '"10 kPa"'))

    def test_unit_is_missing(self):
        self.refuse_case(USAGE, ["material[0].young", "found 10", '"10 kPa"'], CASE.replace('"10 kPa"', "10"))

    def test_key_is_unknown(self):
        self.refuse_case(USAGE, ["'yuong'", "'young'"], CASE.replace("young =", "yuong ="))

    def test_constant_is_nan(self):
        self.refuse_case(USAGE, ["material[0].poisson", "nan", "0.5"],
                         CASE.replace("poisson = 0.45", "poisson = nan"))

    def test_constant_is_negative(self):
        self.refuse_case(USAGE, ["material[0].young", "-10 kPa"], CASE.replace('"10 kPa"', '"-10 kPa"'))

    def test_depth_exceeds_the_body(self):
        self.refuse_case(GEOMETRY, ["depth", "25 mm"], CASE.replace('depth = "1.2 mm"', 'depth = "25 mm"'))

    def test_lateral_travel_is_longer_than_the_body(self):
        self.refuse_case(GEOMETRY, ["lateral travel", "60 mm", "50 mm"],
                         CASE.replace('lateral_travel = "0.6 mm"', 'lateral_travel = "60 mm"'))

    def test_tool_is_larger_than_the_body(self):
        self.refuse_case(GEOMETRY, ["tool radius", "80 mm"], CASE.replace('radius = "6 mm"', 'radius = "80 mm"'))

    def test_supports_fix_no_node(self):
        self.refuse_case(GEOMETRY, ["support"], NO_FIXED_NODES)

    def test_output_folder_cannot_be_made(self):
        path = write_case(self.root)
        (self.root / "file").write_text("in the way", encoding="ascii")
        self.refuse(USAGE, [str(self.root / "file")], "build", path, "--out", self.root / "file" / "out")

    def test_artifact_of_the_stage_before_is_missing(self):
        path = write_case(self.root)
        self.refuse(USAGE, ["body.h5", "palpate mesh"], "precompute", path, "--out", self.out)
        self.refuse(USAGE, ["library.h5", "palpate"], "simulate", path, "--out", self.out)

    def test_file_is_not_an_artifact(self):
        text = self.root / "text.h5"
        text.write_text("not HDF5", encoding="ascii")
        self.refuse(USAGE, ["text.h5"], "inspect", text)
        path = write_case(self.root)
        self.refuse(USAGE, ["text.h5"], "simulate", path, "--out", self.out, "--library", text)

    def test_command_line_is_wrong(self):
        self.refuse(USAGE, ["'bulid'", "'build'"], "bulid")
        self.refuse(USAGE, ["CASE"], "build")
        path = write_case(self.root)
        self.refuse(USAGE, ["--thread"], "build", path, "--thread", "many")
        self.refuse(USAGE, ["none.journal", "correct the path"], "recover", self.root / "none.journal")

    def test_device_profile_is_wrong(self):
        path = write_case(self.root)
        (self.root / "device.toml").write_text('name = "x"\ndamping = 1\nsource = "y"\n', encoding="ascii")
        out = self.root / "elsewhere"
        result = subprocess.run([PALPATE, "certify", path, "--out", out], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, USAGE)
        self.assertEqual(result.stderr.count("\n"), 1)


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
