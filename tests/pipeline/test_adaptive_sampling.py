#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Sites chosen by need: fewer than there are, and what was not computed is as it would have been.

Usage: adaptive_sampling_test.py PALPATE. The judge is a quarter of all sites of the same body, of
which the adaptive campaign never sees more than its own.
"""
import json
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import CASE, write_case  # noqa: E402

PALPATE = None
DONE, CONFIGURATION, SOME_SITES_FAILED = 0, 2, 4
TOLERANCE = 0.04
DEPTH = 0.004  # m
SAMPLING = f"""
[sampling]
method = "adaptive"
initial_spacing = "16 mm"
tolerance = {TOLERANCE}
hold_out_points = 16
"""
FITTED, INTERPOLATED = 0, 1


# A tool and a depth whose contact spans several facets: where it does not, forces depend on where in
# a facet the tool is pressed, and no number of sites helps.
FINER = {
    'patch_spacing = "12.5 mm"': 'patch_spacing = "3.5 mm"',
    'element_size = "4.2 mm"': 'element_size = "3.5 mm"',
    'radius = "6 mm"': 'radius = "9 mm"',
    'depth = "1.2 mm"': 'depth = "4 mm"',
    'lateral_depths = ["0.6 mm"]': 'lateral_depths = ["2 mm"]',
    'lateral_travel = "0.6 mm"': 'lateral_travel = "1 mm"',
}


def finer(case):
    for before, after in FINER.items():
        assert before in case, before
        case = case.replace(before, after)
    return case


def palpate(*arguments):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)


def summary(file):
    return json.loads(palpate("inspect", file, "--json").stdout)


def facts(file):
    steps = summary(file)["provenance"]
    return next(step["facts"] for step in steps if step["stage"] == "precompute")


def force_at(knots, slopes, depth):
    """The stored response at a depth: the integral of its slope, which is straight between knots."""
    d = numpy.linspace(0, depth, 2001)
    return numpy.trapz(numpy.interp(d, knots, slopes), d)


def deepest_forces(library, depth):
    """By vertex, from the file itself."""
    with h5py.File(library) as file:
        status = file["/response/status"][:]
        offset = file["/response/normal_offset"][:]
        knots, slopes = file["/response/normal_knot"][:], file["/response/normal_slope"][:]
    forces = {}
    for v, of in enumerate(status):
        if of in (FITTED, INTERPOLATED):
            piece = slice(offset[v], offset[v + 1])
            forces[v] = force_at(knots[piece], slopes[piece], depth)
    return status, forces


class AdaptiveSampling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        fine = finer(CASE)
        cls.case = write_case(cls.root, fine + SAMPLING)
        cls.every = cls.root / "every.toml"
        cls.every.write_text(fine, encoding="utf-8")
        cls.out = cls.root / "adaptive"
        assert palpate("mesh", cls.case, "--out", cls.out).returncode == DONE
        start = time.monotonic()
        cls.run_log = palpate("precompute", cls.case, "--out", cls.out, "--json")
        cls.seconds = time.monotonic() - start
        assert cls.run_log.returncode == DONE, cls.run_log.stderr
        cls.events = [json.loads(line) for line in cls.run_log.stdout.splitlines()]
        cls.rounds = [event for event in cls.events if event["event"] == "round"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_meets_points_it_never_fitted_with_fewer_sites(self):
        last = self.rounds[-1]
        self.assertGreater(len(self.rounds), 1)
        self.assertGreater(self.rounds[0]["error_along_press"]["p95"], TOLERANCE)
        self.assertLessEqual(last["error_along_press"]["p95"], TOLERANCE)
        self.assertLess(last["sites"], last["of_sites"])
        self.assertEqual(summary(self.out / "curves.h5")["sites"], last["sites"])
        stated = facts(self.out / "curves.h5")
        self.assertEqual(stated["sites_computed"], f"{last['sites']} of {last['of_sites']}")
        self.assertIn(f"p95 {last['error_along_press']['p95']:.6g}", stated["hold_out_error_along_press"])
        self.assertFalse((self.out / "hold-out.journal").exists())

    def test_what_was_not_computed_is_as_it_would_have_been(self):
        self.assertEqual(palpate("fit", self.case, "--out", self.out).returncode, DONE)
        part = self.root / "part"
        part.mkdir()
        shutil.copy(self.out / "body.h5", part)
        self.assertIn(palpate("precompute", self.every, "--out", part, "--shard", "1/4").returncode,
                      (DONE, SOME_SITES_FAILED))
        (part / "curves.1-of-4.h5").rename(part / "curves.h5")
        self.assertEqual(palpate("fit", self.every, "--out", part).returncode, DONE)
        status, forces = deepest_forces(self.out / "library.h5", DEPTH)
        _, direct = deepest_forces(part / "library.h5", DEPTH)
        not_computed = [v for v in forces if status[v] == INTERPOLATED]
        self.assertEqual(len(not_computed), self.rounds[-1]["of_sites"] - self.rounds[-1]["sites"])
        misses = sorted(abs(forces[v] - direct[v]) / direct[v] for v in direct if status[v] == INTERPOLATED)
        self.assertGreater(len(misses), 15)
        self.assertLess(misses[int(0.9 * len(misses))], TOLERANCE)

    def test_killed_it_goes_on_to_the_same_bits(self):
        for attempt in range(6):
            out = self.root / f"killed-{attempt}"
            out.mkdir()
            shutil.copy(self.out / "body.h5", out)
            if self.kill_until_done(out, self.seconds / (3 + attempt)) > 0:
                expected = summary(self.out / "curves.h5")["content_sha256"]
                self.assertEqual(summary(out / "curves.h5")["content_sha256"], expected)
                return
        self.fail("no run was killed before it ended")

    def kill_until_done(self, out, patience):
        kills = 0
        while kills < 100:
            run = subprocess.Popen([PALPATE, "precompute", self.case, "--out", out], stdout=subprocess.DEVNULL)
            try:
                run.wait(timeout=patience)
            except subprocess.TimeoutExpired:
                run.send_signal(signal.SIGKILL)
            run.wait()
            if run.returncode != -signal.SIGKILL:
                self.assertEqual(run.returncode, DONE)
                return kills
            kills += 1
            patience *= 1.1  # a batch of sites may take longer than that
        return self.fail("no progress")

    def test_it_cannot_be_divided(self):
        result = palpate("precompute", self.case, "--out", self.out, "--shard", "1/2")
        self.assertEqual(result.returncode, CONFIGURATION)
        self.assertIn("adaptive", result.stderr)

    def test_every_surface_node_can_be_asked_for(self):
        case = self.root / "nodes.toml"
        case.write_text(CASE + '\n[sampling]\nmethod = "nodes"\n', encoding="utf-8")
        out = self.root / "nodes"
        self.assertEqual(palpate("mesh", case, "--out", out).returncode, DONE)
        with h5py.File(out / "body.h5") as file:
            self.assertEqual(set(file["/response/node"][:]), set(file["/boundary"][:].ravel()))
            self.assertEqual(len(file["/response/triangles"]), len(file["/boundary"]))


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main()
