#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_unity.py SOURCE LIBPALPATE WRITE_BODIES CC MCS MONO: examples/unity, compiled by Mono, has the forces of the C interface
bit for bit; its MonoBehaviour presses a plate and shows the skin, on stand-ins for the types of Unity."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE, LIBRARY, WRITE_BODIES, CC, MCS, MONO = sys.argv[1:7]
EXAMPLES = pathlib.Path(SOURCE, "examples")
HERE = pathlib.Path(SOURCE, "tests/engines/unity")
GEL = pathlib.Path(SOURCE, "data/libraries/gel.plib")
ENVIRONMENT = {**os.environ, "LD_LIBRARY_PATH": str(pathlib.Path(LIBRARY).parent), "LC_ALL": "C.UTF-8"}


def run(*words):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=100, env=ENVIRONMENT)


class Unity(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.work = pathlib.Path(cls.folder.name)

    def compiled(self, name, *sources):
        program = self.work / f"{name}.exe"
        said = run(MCS, "-unsafe", "-warnaserror", "-langversion:7", f"-out:{program}", *sources, EXAMPLES / "unity/Palpate.cs")
        self.assertEqual(said.returncode, 0, said.stderr + said.stdout)
        return program

    def compiled_c(self, name, source):
        program = self.work / name
        said = run(CC, "-std=c11", "-D_POSIX_C_SOURCE=200809L", f"-I{SOURCE}/runtime", source, "-o", program, LIBRARY)
        self.assertEqual(said.returncode, 0, said.stderr)
        return program

    def test_each_step_has_the_bits_of_the_c_interface(self):
        c = run(self.compiled_c("steps", pathlib.Path(SOURCE, "tests/windows/steps.c")), GEL)
        sharp = run(MONO, self.compiled("Steps", HERE / "Steps.cs"), GEL)
        self.assertEqual(sharp.returncode, 0, sharp.stderr)
        self.assertGreater(len(c.stdout.splitlines()), 500)
        self.assertEqual(sharp.stdout, c.stdout)

    def test_the_example_feels_what_the_example_in_c_feels(self):
        c = self.compiled_c("feel", EXAMPLES / "feel.c")
        sharp = self.compiled("Feel", EXAMPLES / "unity/Feel.cs")
        for side in ((0, 0, 1), (0, 0.1, 1), (0.3, 0.2, 1)):
            said, felt = run(MONO, sharp, GEL, *side), run(c, GEL, *side)  # Mono prints no sign before zero
            self.assertEqual((said.returncode, said.stdout), (0, felt.stdout.replace("-0.0000", "0.0000")), said.stderr)
        said = run(MONO, sharp, SOURCE + "/README.md", 1, 0, 0)
        self.assertEqual(said.returncode, 1)
        self.assertIn("feel: ", said.stderr)

    def test_a_body_in_a_scene_is_pressed_and_dents(self):
        run(WRITE_BODIES, self.work)
        scene = self.compiled("Scene", HERE / "Scene.cs", HERE / "UnityEngine.cs", EXAMPLES / "unity/PalpateBody.cs")
        said = run(MONO, scene, self.work)
        self.assertEqual(said.returncode, 0, said.stderr + said.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
