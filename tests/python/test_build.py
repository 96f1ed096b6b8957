#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""A case built from Python, and what is made of it: presses against the curves, a session run again, the skin.

Usage: test_build.py PALPATE PIPELINE_FOLDER PAGE
"""
import contextlib
import inspect
import io
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import palpate

PALPATE = None
PAGE = None


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.case = write_case(cls.root)
        cls.case.write_text(cls.case.read_text() + "\n[deformation]\ndepths = 3\n")
        os.environ["PATH"] = f"{Path(PALPATE).parent}{os.pathsep}{os.environ['PATH']}"
        cls.events = []
        cls.built = palpate.build(cls.case, cls.root / "out", progress=cls.events.append)
        cls.library = palpate.Library(cls.built.library)
        cls.curves = palpate.read_curves(cls.built.curves)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_stage_is_reported(self):
        self.assertEqual([e["stage"] for e in self.events if e["event"] == "stage"],
                         ["mesh", "precompute", "fit", "certify"])
        progress = [e for e in self.events if e["event"] == "progress"]
        self.assertEqual(progress[-1]["done"], progress[-1]["total"])
        self.assertEqual(len(self.curves.sites), progress[-1]["total"])
        self.assertEqual(self.built.folder, self.root / "out")
        self.assertEqual(self.built.warnings, ())

    def test_a_second_build_has_nothing_to_do(self):
        events = []
        again = palpate.build(str(self.case), str(self.root / "out"), progress=events.append)
        self.assertEqual([e["event"] for e in events], ["up_to_date"] * 4)
        self.assertEqual(again, self.built)

    def test_artifacts_fit_together(self):
        body = palpate.read_body(self.built.body)
        nodes = body.nodes[body.response_nodes]  # of which a library has 24 bits
        self.assertLess(np.abs(self.library.vertices - nodes).max(), np.ptp(nodes, axis=0).max() / 2**24)
        self.assertEqual({site.vertex for site in self.curves.sites}, set(np.flatnonzero(body.is_site)))
        self.assertEqual({site.vertex for site in self.curves.sites}, set(np.flatnonzero(self.library.vertex_status == 0)))
        stages = [step.stage for step in self.library.provenance]
        self.assertEqual(stages, ["mesh", "precompute", "fit", "certify"])
        self.assertIn("block.off", self.library.provenance[0].inputs)
        self.assertIn('name = "block"', self.library.provenance[0].resolved_case)

    def test_a_press_is_the_curve_of_the_solver(self):
        touched = 0
        for site in self.curves.sites:
            path = site.normal
            self.assertTrue(np.all(np.diff(path.force_along) > 0))
            try:
                curve = palpate.press(self.library, site.vertex, path.displacement, friction=0)
            except palpate.ArgumentError as error:  # all its triangles are at holes
                self.assertIn("cannot be touched", str(error))
                continue
            touched += 1
            response = self.library.response(site.vertex)
            # Without friction the tool slides a little where the response leans.
            slides = 0.002 * np.linalg.norm(response.lean) / 0.1 * path.force_along[-1]
            self.assertLess(np.abs(curve.force - path.force_along).max(), response.normal_error + slides + 1e-6)
            # The work of the press: less than 1 % beside the energy of the solver, plus what the fit leaves.
            self.assertLess(abs(curve.energy[-1] - path.tool_work[-1]),
                            0.03 * path.tool_work[-1] + response.normal_error * path.displacement[-1])
        self.assertGreater(touched, 8)

    def test_a_simulated_session_runs_again_to_the_bit(self):
        said = palpate.run_command("simulate", self.case, "--out", self.root / "out")
        self.assertIn("simulate:", said)
        recording = palpate.read_session(self.root / "out/recording.h5")
        self.assertFalse(recording.guarded)
        state = self.library.state(friction=recording.friction, tank_cap=recording.tank_cap,
                                   lipschitz_bound=recording.lipschitz_bound)
        run = state.run(recording.position, recording.velocity, 1 / recording.rate)
        for name in ("force", "contact_point", "depth", "lateral", "offset", "energy", "tank", "absorbed", "element",
                     "status"):
            self.assertEqual(np.ascontiguousarray(getattr(run, name)).tobytes(),
                             np.ascontiguousarray(getattr(recording, name)).tobytes(), name)
        self.assertGreater(np.abs(run.force).max(), 0.01)
        self.assertTrue(np.any(run.status & palpate.Status.SLIDING))

    def test_the_example_repeats_the_session(self):
        palpate.run_command("simulate", self.case, "--out", self.root / "out")
        example = PAGE.parent.parent / "examples/python/session.py"

        def said(library):
            return subprocess.run([sys.executable, example, self.root / "out/recording.h5", "--library", library],
                                  capture_output=True, text=True, check=True).stdout

        with_its_own = said(self.built.library)
        self.assertIn("the same forces come again, to the bit", with_its_own)
        recording = palpate.read_recording(self.root / "out/recording.h5")
        self.assertIn(f"{len(recording)} steps on simulated", with_its_own)
        self.assertIn(f"absorbed {1e3 * recording.absorbed[-1]:.4f} mJ", with_its_own)
        softer = self.root / "softer.toml"
        softer.write_text(self.case.read_text().replace('young = "10 kPa"', 'young = "9 kPa"'))
        other = palpate.build(softer, self.root / "softer").library
        self.assertIn("other forces come", said(other))

    def test_the_programs_of_the_page_run(self):
        text = PAGE.read_text(encoding="utf-8")
        programs = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(programs), 5)
        palpate.run_command("simulate", self.case, "--out", self.root / "out")
        site = next(s.vertex for s in self.curves.sites if s.vertex in self.library.triangles)
        names, said = {"draw": lambda x, triangles: None}, io.StringIO()
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.root)
        with contextlib.redirect_stdout(said):
            for program in programs:
                for shown, used in (("data/cases/liver.toml", self.case), ("out/liver", self.root / "out"), ("444", site),
                                    ("my.toml", self.case)):
                    program = program.replace(shown, str(used))
                exec(compile(program, PAGE.name, "exec"), names)  # noqa: S102: our own page
        self.assertIn("\nTrue\n", said.getvalue())
        self.assertIn("16 of 16", said.getvalue())
        # A table names every exception.
        for name in palpate.__all__:
            if inspect.isclass(getattr(palpate, name)) and issubclass(getattr(palpate, name), palpate.Error):
                self.assertIn(f"`{'palpate.' * (name == 'Error')}{name}`", text)

    def test_the_skin_goes_where_the_tip_is(self):
        skin = self.library.deformation(self.built.deformation)
        state = self.library.state()
        at_rest = state.deform(skin)
        self.assertEqual(at_rest.tobytes(), skin.vertices.tobytes())
        site = max(self.curves.sites, key=lambda s: self.library.vertices[s.vertex, 2] - np.hypot(
            *(self.library.vertices[s.vertex, :2] - 0.025)))  # in the middle of the top
        top, inward = self.library.vertices[site.vertex], self.library.normals[site.vertex]
        depth = 1e-3
        state.run(top + np.linspace(-1e-4, depth, 200)[:, None] * inward)
        pressed = np.empty_like(at_rest)
        self.assertIs(state.deform(skin, pressed), pressed)
        moved = (pressed - at_rest) @ inward
        under = np.argmin(np.linalg.norm(at_rest - top, axis=1))
        self.assertAlmostEqual(moved[under], depth, delta=1e-5)
        self.assertEqual(np.argmax(moved), under)
        self.assertLess(np.abs(pressed - at_rest)[at_rest[:, 2] < 1e-6].max(), 1e-4)  # the base is fixed
        for wrong in (np.empty((3, 3)), np.empty_like(at_rest, dtype=np.float32), at_rest.T, [1]):
            with self.assertRaisesRegex(palpate.ArgumentError, "out"):
                state.deform(skin, wrong)
        other = palpate.Library(self.built.library)
        with self.assertRaisesRegex(palpate.MismatchError, "different libraries"):
            other.state().deform(skin)
        with self.assertRaisesRegex(palpate.FileError, "deformation"):
            self.library.deformation(self.root / "none.pdef")
        with self.assertRaises(palpate.FormatError):
            self.library.deformation(self.built.library)

    def test_failures_have_the_message_of_the_command(self):
        with self.assertRaisesRegex(palpate.CommandError, "none.toml: cannot read the case file; check its path") as caught:
            palpate.build(self.root / "none.toml")
        self.assertEqual((caught.exception.exit_code, caught.exception.build), (2, None))
        wrong = self.root / "wrong.toml"
        wrong.write_text(self.case.read_text().replace('young = "10 kPa"', 'yuong = "10 kPa"'))
        with self.assertRaisesRegex(palpate.CommandError, "yuong"):
            palpate.build(wrong, self.root / "wrong")
        with self.assertRaisesRegex(palpate.CommandError, "biuld") as caught:
            palpate.run_command("biuld")
        self.assertEqual(caught.exception.exit_code, 2)
        with self.assertRaisesRegex(palpate.ArgumentError, "until"):
            palpate.build(self.case, until="done")
        open_body = self.root / "open.off"
        open_body.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        wrong.write_text(self.case.read_text().replace("block.off", "open.off"))
        with self.assertRaises(palpate.CommandError) as caught:
            palpate.build(wrong, self.root / "open")
        self.assertEqual(caught.exception.exit_code, 3)

    def test_an_exception_of_the_callback_ends_the_command_and_keeps_its_sites(self):
        class Enough(Exception):
            pass

        def stop(event):
            if event["event"] == "site":
                raise Enough

        out = self.root / "stopped"
        with self.assertRaises(Enough):
            palpate.build(self.case, out, progress=stop, threads=1)
        events = []
        palpate.build(self.case, out, progress=events.append)
        started = [e for e in events if e["event"] == "start"]
        self.assertTrue(not started or started[0]["known_sites"] > 0)
        self.assertEqual((out / "library.h5").is_file(), True)

    def test_until_a_stage(self):
        built = palpate.build(self.case, self.root / "mesh", until="mesh")
        self.assertTrue(built.body.is_file())
        self.assertEqual((built.curves, built.library, built.deformation), (None, None, None))


class Command(unittest.TestCase):
    def put_beside(self, script):
        """A command in the prefix of the package."""
        beside = Path(palpate.__file__).resolve().parents[4] / "bin" / "palpate"
        beside.parent.mkdir()
        self.addCleanup(lambda: (beside.unlink(), beside.parent.rmdir()))
        beside.write_text(f"#!/bin/sh\n{script}\n")
        beside.chmod(0o755)

    def test_the_command_of_the_prefix_comes_first_and_must_be_of_the_version(self):
        self.put_beside("echo palpate 99.0.0")
        with self.assertRaisesRegex(palpate.MismatchError, "bin/palpate: is not of version"):
            palpate.run_command("--version")

    def test_a_command_that_dies_or_babbles(self):
        self.put_beside(f"""case $1$3 in
            --version*) echo palpate {palpate.__version__} ;;
            build*) printf '{{"event":"log","text":"one"}}\\n{{"event":"lo'; . "$2" ;;
            *) echo "$@" ;;
        esac""")
        self.assertEqual(palpate.run_command("certify", Path("a"), "--rate", 1000, 0.5), "certify a --rate 1000 0.5\n")
        with tempfile.TemporaryDirectory() as folder:
            how = Path(folder) / "how"
            for script, text, code in (("kill -9 $$", "ended with code -9", -9), ("exit 1", "ended with code 1", 1),
                                       ("true", "no event", 1)):
                how.write_text(script)
                events = []
                with self.assertRaisesRegex(palpate.CommandError, text) as caught:
                    palpate.build(how, progress=events.append)
                self.assertEqual(caught.exception.exit_code, code)
                self.assertEqual(events, [{"event": "log", "text": "one"}])

    def test_without_a_command_it_says_so(self):
        before = os.environ["PATH"]
        self.addCleanup(lambda: os.environ.update(PATH=before))
        os.environ["PATH"] = "/nowhere"
        with self.assertRaisesRegex(palpate.FileError, "neither .*bin/palpate nor in PATH"):
            palpate.build("block.toml")


if __name__ == "__main__":
    PALPATE, pipeline, PAGE = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    del sys.argv[1:4]
    sys.path.insert(0, pipeline)
    from bodies import write_case
    unittest.main()
