#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""palpate.State and palpate.press against the C interface of libpalpate.so and closed forms.

Usage: test_state.py WRITE_BODIES LIBPALPATE PALPATE_H
"""
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import palpate

sys.path.insert(0, str(Path(__file__).resolve().parent))
import c_interface  # noqa: E402

WRITE_BODIES = None
LIBPALPATE = None
HEADER = None
STIFFNESS = 170  # N/m, of the plate: f = 100 k d^2 up to 5 mm
REST = (0.0, 0.0, 0.0)


def rounds(center, radius, depth, steps, turns=3):
    """A tip that comes to a ball, goes round on it, up and down, and leaves it by the way it came."""
    s = np.linspace(0, 1, steps)
    latitude, longitude = 0.4 * np.sin(5 * np.pi * s), 2 * np.pi * turns * s
    out = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], 1)
    height = 2e-3 - (2e-3 + depth) * np.sin(np.pi * s) ** 2 * (0.8 + 0.2 * np.cos(40 * s))
    return center + (radius + height)[:, None] * out


class Bodies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        subprocess.run([WRITE_BODIES, cls.root], check=True)
        cls.plate = palpate.Library(cls.root / "plate.h5")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def library(self, name):
        return palpate.Library(self.root / f"{name}.h5")


class Forces(Bodies):
    def assert_same_bits(self, run, columns):
        for name, expected in columns.items():
            actual = np.ascontiguousarray(getattr(run, name))
            self.assertEqual(actual.dtype, expected.dtype, name)
            self.assertEqual(actual.tobytes(), expected.tobytes(), name)

    def test_a_run_is_to_the_bit_what_the_c_interface_gives(self):
        positions = rounds(np.zeros(3), 0.03, 2e-3, 4000)
        velocities = np.gradient(positions, 1e-3, axis=0)
        times = np.tile([1e-3, 5e-4], 2000)
        for name in ("ball", "coupled", "leaning", "soft", "relaxing"):
            for friction in (-1.0, 0.1):
                expected = c_interface.trajectory(LIBPALPATE, self.root / f"{name}.h5", positions, velocities, times,
                                                  friction)
                state = self.library(name).state(friction=None if friction < 0 else friction)
                run = state.run(positions, velocities, times)
                self.assert_same_bits(run, expected)
                for bit in (palpate.Status.SLIDING, palpate.Status.ACTIVATED, palpate.Status.RELEASED):
                    self.assertTrue(np.any(run.status & bit), bit)
        self.assertTrue(np.any(run.dissipated > 0))

    def test_steps_are_to_the_bit_the_run(self):
        positions = rounds(np.zeros(3), 0.03, 2e-3, 1500)
        state, other = self.library("ball").state(), self.library("ball").state()
        run = state.run(positions, dt=5e-4)
        self.assertEqual(len(run), 1500)
        for i, position in enumerate(positions):
            force, status = other.step(position, REST, 5e-4)
            self.assertEqual(force.tobytes(), run.force[i].tobytes())
            self.assertEqual(status, run.status[i])
        seen = other.observe()
        self.assertEqual(seen.absorbed, run.absorbed[-1])
        self.assertEqual(seen.force_on_body.tobytes(), (-run.force[-1]).tobytes())

    def test_inputs_of_any_real_type_and_layout(self):
        positions = np.zeros((3, 3))
        positions[:, :2], positions[:, 2] = 0.03125, [0.5, -0.001953125, -0.00390625]  # exact in single precision
        expected = self.plate.state().run(positions).force
        for given in (positions.tolist(), positions.astype(np.float32), np.asfortranarray(positions),
                      np.repeat(positions, 2, axis=0)[::2]):
            self.assertEqual(self.plate.state().run(given).force.tobytes(), expected.tobytes())
        force, status = self.plate.state().step([0, 0, 1], (0, 0, 0), 1)
        self.assertEqual((force.tolist(), status), ([0, 0, 0], palpate.Status(0)))

    def test_what_the_body_absorbs_is_the_work_of_the_tool(self):
        def run_and_error(name, steps):
            positions = rounds(np.zeros(3), 0.03, 2e-3, steps)
            run = self.library(name).state().run(positions, dt=4 / steps)
            mean = -(run.force[1:] + run.force[:-1]) / 2
            work = np.cumsum(np.sum(mean * np.diff(positions, axis=0), axis=1))
            self.assertGreaterEqual(work.min(), -1e-7)
            return run, np.abs(work - run.absorbed[1:]).max()

        for name in ("ball", "coupled", "relaxing"):
            coarse, fine = run_and_error(name, 40_000), run_and_error(name, 160_000)
            run, error = fine
            self.assertGreater(run.absorbed[-1], 0)  # the path is closed: friction and relaxation have it
            self.assertLess(run.energy[-1], 1e-6 * run.absorbed[-1])  # what tissue that relaxes still remembers
            # Forces after a slip miss half of what is stored before it: an error of first order in the step.
            self.assertLess(error, 0.03 * run.absorbed[-1], name)
            self.assertLess(error, 0.3 * coarse[1], name)

    def test_a_pose_turns_forces(self):
        turn = np.array([[0, -1.0, 0], [1, 0, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
        shift = np.array([0.3, -0.2, 0.1])
        positions = rounds(np.zeros(3), 0.03, 2e-3, 800)
        library = self.library("ball")
        at_rest, posed = library.state(), library.state()
        posed.set_pose(shift, turn)
        expected = at_rest.run(positions)
        run = posed.run(positions @ turn.T + shift)
        # A contact may begin in another of two neighbouring triangles, where the tip is on their edge.
        np.testing.assert_allclose(run.force, expected.force @ turn.T, atol=1e-9)
        touching = run.status & palpate.Status.CONTACT != 0
        np.testing.assert_allclose(run.contact_point[touching],
                                   (expected.contact_point @ turn.T + shift)[touching], atol=1e-9)
        posed.set_pose((0, 0, 0))
        self.assertEqual(posed.run(positions).force.shape, (800, 3))

    def test_reset_begins_anew(self):
        positions = rounds(np.zeros(3), 0.03, 2e-3, 800)
        state = self.library("relaxing").state()
        first = state.run(positions)
        state.reset()
        self.assertEqual(state.observe().absorbed, 0)
        self.assertEqual(state.run(positions).force.tobytes(), first.force.tobytes())

    def test_a_state_keeps_its_library(self):
        state = palpate.Library(self.root / "plate.h5").state(friction=0.2)
        self.assertEqual((state.friction, state.library.friction), (0.2, 0.3))
        self.assertEqual(state.lipschitz_bound, state.library.lipschitz_bound)
        self.assertEqual(len(state.library.vertices), 81)

    def test_status_bits_are_those_of_the_header(self):
        text = Path(HEADER).read_text(encoding="utf-8")
        bits = {name: 1 << int(bit) for name, bit in re.findall(r"PALPATE_(\w+) = 1u << (\d+)", text)}
        self.assertGreater(len(bits), 20)
        self.assertEqual({bit.name: bit.value for bit in palpate.Status}, bits)

    def test_numbers_that_are_none_are_named_as_given(self):
        """A negative or infinite constant is no constant of a device; nan stands for one that is not known."""
        state = self.plate.state()
        for name in ("damping", "coulomb_friction", "delay", "position_resolution", "force_resolution"):
            for value, text in ((-5, "-5"), (-1e-3, "-0.001"), (math.inf, "inf")):
                with self.assertRaisesRegex(palpate.ArgumentError, rf"{name} is {text}.*at least 0, or nan"):
                    state.certified(1000, **{name: value})
            self.assertIn("unknown", state.certified(1000, **{name: math.nan})[1])
        with self.assertRaisesRegex(palpate.ArgumentError, "rate is nan Hz"):
            state.certified(math.nan, damping=1)
        with self.assertRaisesRegex(palpate.ArgumentError, "dt is nan s"):
            state.step([0, 0, 0], [0, 0, 0], math.nan)
        with self.assertRaisesRegex(palpate.ArgumentError, "friction is nan"):
            self.plate.state(friction=math.nan)

    def test_certified_at_a_rate(self):
        bench = self.plate.certificate.devices[0]
        device = {name: getattr(bench, name) for name in
                  ("damping", "coulomb_friction", "delay", "position_resolution", "force_resolution")}
        state = self.plate.state()
        self.assertEqual(state.certified(1.01 * bench.lowest_rate, **device), (True, ""))
        slow = state.certified(0.99 * bench.lowest_rate, **device)
        self.assertFalse(slow[0])
        self.assertTrue(slow[1])
        self.assertRegex(state.certified(1000)[1], "damping.*unknown|unknown.*damping|damping")
        with self.assertRaisesRegex(palpate.ArgumentError, "rate"):
            state.certified(0)


class Presses(Bodies):
    def test_the_plate_is_its_closed_form(self):
        depths = np.linspace(0, 5e-3, 26)
        curve = palpate.press(self.plate, 40, depths)
        np.testing.assert_allclose(curve.force, 100 * STIFFNESS * depths**2, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(curve.energy, 100 * STIFFNESS * depths**3 / 3, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(curve.vector, curve.force[:, None] * [0, 0, 1], atol=1e-9)
        self.assertFalse(np.any(curve.status & palpate.Status.BEYOND_DEPTH))
        self.assertTrue(np.all(palpate.press(self.plate, 40, [0.03]).status & palpate.Status.BEYOND_DEPTH))

    def test_every_vertex_of_an_uneven_ball_gives_the_samples_of_its_library(self):
        for name in ("ball", "coupled"):
            library = self.library(name)
            depths = np.linspace(0, library.depth, 12)
            for vertex in range(0, len(library.vertices), 7):
                curve = palpate.press(library, vertex, depths)
                self.assertTrue(np.all(np.diff(curve.force) > 0))
                knots, slopes = (np.asarray(x, np.float64) for x in (library.response(vertex).normal.knots,
                                                                     library.response(vertex).normal.slopes))
                at_knots = np.concatenate([[0], np.cumsum(np.diff(knots) * (slopes[1:] + slopes[:-1]) / 2)])
                pressed = palpate.press(library, vertex, knots).force
                np.testing.assert_allclose(pressed, at_knots, rtol=1e-6, atol=1e-9)

    def test_tissue_that_relaxes_is_stiffer_when_pressed_fast(self):
        library = self.library("relaxing")
        slow, middle, fast = (palpate.press(library, 5, [1e-3, 2e-3], speed=speed) for speed in (1e-5, 1e-2, 10))
        self.assertTrue(np.all(slow.force < middle.force) and np.all(middle.force < fast.force))
        instantaneous = library.response(5).normal([1e-3, 2e-3])
        np.testing.assert_allclose(fast.force, instantaneous, rtol=0.02)
        remains = 1 - library.response(5).relaxation.sum()
        np.testing.assert_allclose(slow.force, remains * instantaneous, rtol=0.02)

    def test_what_cannot_be_pressed_is_refused(self):
        with self.assertRaisesRegex(palpate.ArgumentError, "vertex 0 has no response"):
            palpate.press(self.library("hole"), 0, [1e-3])
        for depths in ([], [[1e-3]], [2e-3, 1e-3], [-1e-3], [np.nan], 1e-3):
            with self.assertRaisesRegex(palpate.ArgumentError, "depths"):
                palpate.press(self.plate, 40, depths)
        with self.assertRaisesRegex(TypeError, "depths"):
            palpate.press(self.plate, 40, ["deep"])
        for wrong in ({"speed": 0}, {"rate": np.inf}):
            with self.assertRaisesRegex(palpate.ArgumentError, next(iter(wrong))):
                palpate.press(self.plate, 40, [1e-3], **wrong)
        with self.assertRaisesRegex(palpate.ArgumentError, "no certificate.*friction"):
            palpate.press(self.library("uncertified"), 40, [1e-3])
        self.assertGreater(palpate.press(self.library("uncertified"), 40, [1e-3], friction=0.3).force[0], 0)


class WrongInput(Bodies):
    def test_it_raises_and_the_state_is_as_it_was(self):
        state, twin = self.plate.state(), self.plate.state()
        inside = [[0.04, 0.04, 1e-3], [0.04, 0.04, -1e-3], [0.04, 0.04, -2e-3]]
        state.run(inside), twin.run(inside)
        good, nan = (0.04, 0.04, -2e-3), (0.04, np.nan, 0)
        for kind, text, call in (
                (palpate.ArgumentError, "shape \\(2,\\)", lambda: state.step(good[:2], REST, 1e-3)),
                (palpate.ArgumentError, "shape \\(1, 3\\)", lambda: state.step([good], REST, 1e-3)),
                (palpate.ArgumentError, "velocity.*shape", lambda: state.step(good, 0, 1e-3)),
                (palpate.ArgumentError, "position.*not finite", lambda: state.step(nan, REST, 1e-3)),
                (palpate.ArgumentError, "velocity.*not finite", lambda: state.step(good, nan, 1e-3)),
                (palpate.ArgumentError, "dt is 0 s", lambda: state.step(good, REST, 0)),
                (palpate.ArgumentError, "dt is -0.00100 s", lambda: state.step(good, REST, -1e-3)),
                (TypeError, "complex128", lambda: state.step(np.array(good) + 1j, REST, 1e-3)),
                (TypeError, "bool", lambda: state.step([True] * 3, REST, 1e-3)),
                (TypeError, "position", lambda: state.step("here", REST, 1e-3)),
                (TypeError, "position", lambda: state.step(None, REST, 1e-3)),
                (TypeError, "dt", lambda: state.step(good, REST, "soon")),
                (palpate.ArgumentError, "\\(N, 3\\)", lambda: state.run(good)),
                (palpate.ArgumentError, "\\(N, 3\\)", lambda: state.run(np.zeros((3, 4)))),
                (palpate.ArgumentError, "positions\\[1\\].*not finite", lambda: state.run([good, nan])),
                (palpate.ArgumentError, "velocities.*\\(2, 3\\)", lambda: state.run([good, good], [REST])),
                (palpate.ArgumentError, "dt\\[1\\]", lambda: state.run([good, good], dt=[1e-3, 0])),
                (palpate.ArgumentError, "dt.*\\(2,\\)", lambda: state.run([good, good], dt=[1e-3])),
                (palpate.ArgumentError, "orthonormal", lambda: state.set_pose(REST, 2 * np.eye(3))),
                (palpate.ArgumentError, "\\(3, 3\\)", lambda: state.set_pose(REST, np.eye(2))),
                (palpate.ArgumentError, "not finite", lambda: state.set_pose(nan)),
        ):
            with self.subTest(text), self.assertRaisesRegex(kind, text):
                call()
            self.assertEqual(state.observe().energy, twin.observe().energy)
        self.assertEqual(state.step(good, REST, 1e-3)[0].tobytes(), twin.step(good, REST, 1e-3)[0].tobytes())

    def test_without_strict_it_is_what_a_force_loop_does(self):
        positions = np.array([[0.04, 0.04, 1e-3], [0.04, 0.04, -1e-3], [np.nan] * 3, [0.04, 0.04, -1e-3],
                              [0.04, 0.04, 1e-3], [0.04, 0.04, -1e-3], [0.04, 0.04, -2e-3]])
        velocities, times = np.zeros_like(positions), np.full(7, 1e-3)
        expected = c_interface.trajectory(LIBPALPATE, self.root / "plate.h5", positions, velocities, times)
        run = self.plate.state().run(positions, velocities, times, strict=False)
        self.assertEqual(np.ascontiguousarray(run.force).tobytes(), expected["force"].tobytes())
        self.assertEqual(run.status.tolist(), expected["status"].tolist())
        self.assertTrue(palpate.Status(run.status[2]) & palpate.Status.BAD_INPUT)
        self.assertEqual(run.force[2:5].any(), False)
        self.assertGreater(run.force[6, 2], 0)
        force, status = self.plate.state().step([np.nan] * 3, REST, 1e-3, strict=False)
        self.assertTrue(status & palpate.Status.BAD_INPUT)
        self.assertFalse(force.any())

    def test_settings_out_of_range(self):
        for wrong in ({"friction": -0.1}, {"friction": np.nan}, {"tank_cap": -1}, {"lipschitz_bound": 1e-3},
                      {"search_rate": 1e9}):
            with self.assertRaisesRegex(palpate.ArgumentError, next(iter(wrong))):
                self.plate.state(**wrong)
        with self.assertRaisesRegex(palpate.ArgumentError, "no certificate"):
            self.library("uncertified").state()
        with self.assertRaises(TypeError):
            self.plate.state(friktion=0.3)


class Threads(Bodies):
    def test_a_run_lets_other_threads_work_but_not_on_its_state(self):
        state, other = self.plate.state(), self.plate.state()
        positions = np.tile([0.04, 0.04, -1e-3], (600_000, 1))
        thread = threading.Thread(target=state.run, args=(positions,))
        thread.start()
        refused, done = 0, 0
        while thread.is_alive():
            try:
                state.step((0.04, 0.04, 0.5), REST, 1e-3)
            except palpate.BusyError:
                refused += 1
            other.step((0.04, 0.04, -1e-3), REST, 1e-3)
            done += 1
        thread.join()
        self.assertGreater(refused, 0)
        self.assertGreaterEqual(done, refused)
        self.assertFalse(np.any(state.step((0.04, 0.04, 1e-3), REST, 1e-3)[0]))

    def test_control_c_ends_a_run_between_steps(self):
        state = self.plate.state()
        positions = np.tile([0.04, 0.04, -1e-3], (1_000_000, 1))
        timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            state.run(positions)
            timer.join()  # should a machine be that fast
        state.step((0.04, 0.04, 1e-3), REST, 1e-3)
        self.assertTrue(state.step((0.04, 0.04, -1e-3), REST, 1e-3)[1] & palpate.Status.CONTACT)


if __name__ == "__main__":
    WRITE_BODIES, LIBPALPATE, HEADER = sys.argv[1:4]
    del sys.argv[1:4]
    unittest.main()
