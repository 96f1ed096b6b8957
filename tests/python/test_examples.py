#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The examples in Python run, and print what the closed forms of the plate say.

Usage: test_examples.py WRITE_BODIES WRITE_SAMPLE_ARTIFACTS EXAMPLES
"""
import importlib.util
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

WRITE_BODIES = None
WRITE_SAMPLES = None
EXAMPLES = None
HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        subprocess.run([WRITE_BODIES, cls.root], check=True)
        cls.plate = cls.root / "plate.h5"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_example(self, name, *arguments):
        return subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True,
                              check=False, cwd=self.root)

    def said(self, name, *arguments):
        done = self.run_example(name, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def assert_plot(self, name, *arguments):
        if HAS_MATPLOTLIB:
            self.run_example(name, *arguments, "--plot", "plot.png")  # may warn of the folder of its cache
            self.assertTrue((self.root / "plot.png").read_bytes().startswith(b"\x89PNG"))
            (self.root / "plot.png").unlink()
        else:
            self.assertIn("matplotlib", self.run_example(name, *arguments, "--plot", "plot.png").stderr)

    def test_every_example_is_run_here(self):
        tested = set(re.findall(r'"(\w+\.py)"', Path(__file__).read_text(encoding="utf-8")))
        self.assertEqual({path.name for path in EXAMPLES.glob("*.py")}, tested)

    def test_a_press(self):
        said = self.said("press.py", self.plate, 40)
        self.assertIn("vertex 40 at [40. 40.  0.] mm", said)
        rows = [list(map(float, line.split())) for line in said.splitlines()[2:]]
        self.assertEqual(len(rows), 11)
        for depth, force, _ in rows:  # 170 N/m: f = 100 k d^2 up to 5 mm, then k (d - 2.5 mm)
            d = 1e-3 * depth
            self.assertAlmostEqual(force, 100 * 170 * d * d if depth < 5 else 170 * (d - 2.5e-3), delta=1e-4)
        self.assertIn("vertex", self.said("press.py", self.plate))
        self.assert_plot("press.py", self.plate, 40)

    def test_a_stroke(self):
        said = self.said("trajectory.py", self.plate, 40, "--depth-mm", 2, "--length-mm", 20)
        numbers = [float(x) for x in re.findall(r"-?\d+\.\d+", said)]
        largest, deepest, work, stored = numbers
        # 68 mN at 2 mm, and friction of 0.3 of that across: 20 mN over the 40 mm of the strokes.
        self.assertAlmostEqual(largest, 0.068 * 1.09**0.5, delta=0.004)
        self.assertAlmostEqual(deepest, 2, delta=0.03)
        self.assertAlmostEqual(work, 0.3 * 68e-3 * 40, delta=0.1)
        self.assertLess(stored, work)
        self.assertIn("SLIDING", said)
        self.assert_plot("trajectory.py", self.plate, 40)

    def test_a_session(self):
        subprocess.run([WRITE_SAMPLES, self.root / "samples"], check=True)
        said = self.said("session.py", self.root / "samples/recording.h5")  # random, with a reading that is NaN
        self.assertIn("5000 steps", said)
        self.assertRegex(said, r"CONTACT: \d+ steps")
        self.assert_plot("session.py", self.root / "samples/recording.h5")

    def test_a_comparison(self):
        self.assertIn("worst 0.00 %", self.said("compare.py", self.plate, self.plate))
        stiffer = self.said("compare.py", self.plate, self.root / "stiffer.h5")
        for percent in re.findall(r"(\d+\.\d+) %", stiffer)[:1]:
            self.assertAlmostEqual(float(percent), 10, delta=0.05)

    def test_a_wrong_file_is_named(self):
        done = self.run_example("press.py", self.root / "none.h5")
        self.assertIn("palpate.FileError: ", done.stderr)
        self.assertIn("none.h5: cannot be opened; check path and permissions", done.stderr)


if __name__ == "__main__":
    WRITE_BODIES, WRITE_SAMPLES, EXAMPLES = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    del sys.argv[1:4]
    unittest.main()
