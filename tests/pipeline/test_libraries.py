#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_libraries.py PALPATE LIBPALPATE SOURCE: the ready-made libraries are those of their cases, and what they feel like
is what mechanics says of such bodies."""
import ctypes
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

PALPATE, RUNTIME, SOURCE = sys.argv[1], ctypes.CDLL(sys.argv[2]), pathlib.Path(sys.argv[3])
LIBRARIES, CASES = SOURCE / "data" / "libraries", SOURCE / "data" / "cases"
Vector = ctypes.c_double * 3


class Body:
    """A library with one tool on it."""

    def __init__(self, file):
        self.library, self.state = ctypes.c_void_p(), ctypes.c_void_p()
        assert RUNTIME.palpate_library_load(str(file).encode(), ctypes.byref(self.library)) == 0, file
        assert RUNTIME.palpate_state_create(self.library, None, ctypes.byref(self.state)) == 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        RUNTIME.palpate_state_destroy(self.state)
        RUNTIME.palpate_library_destroy(self.library)

    def forces(self, positions, dt):
        """N, of the body on the tool after each step."""
        RUNTIME.palpate_state_reset(self.state)
        out, force, still = [], Vector(), Vector(0, 0, 0)
        for position in positions:
            RUNTIME.palpate_step(self.state, Vector(*position), still, ctypes.c_double(dt), force)
            out.append(tuple(force))
        return out


def press(x, y, depth, steps=400):
    """A straight press on top of the pad, whose skin is at z = 20 mm, from just above; metres."""
    return [(x, y, 0.02 + 1e-5 - i * (depth + 1e-5) / steps) for i in range(steps + 1)]


def slide(x, y, depth, travel, steps=200):
    return press(x, y, depth) + [(x + travel * i / steps, y, 0.02 - depth) for i in range(1, steps + 1)]


def read_off(file):
    """Vertices in metres, and triangles."""
    lines = [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]
    vertices = int(lines[1][0])
    return [tuple(map(float, line)) for line in lines[2:2 + vertices]], [tuple(map(int, line[1:])) for line in lines[2 + vertices:]]


class Libraries(unittest.TestCase):
    def test_each_has_a_case_and_a_licence_and_all_are_small(self):
        files = sorted(LIBRARIES.glob("*.plib"))
        self.assertEqual([f.stem for f in files], ["gel", "liver", "tissue"])
        self.assertLess(sum(f.stat().st_size for f in LIBRARIES.iterdir()), 1_000_000)  # with surfaces and skins
        readme = (LIBRARIES / "README.md").read_text()
        for file in files:
            self.assertIn(f"`{file.name}` |", readme)
            shown = subprocess.run([PALPATE, "inspect", file], capture_output=True, text=True, check=False)
            self.assertEqual(shown.returncode, 0, shown.stderr)
            made_of = (CASES / f"{file.stem}.toml").read_text()
            self.assertIn(f'name = "{file.stem}"', made_of)

    def test_each_has_the_surface_of_its_case(self):
        for file in LIBRARIES.glob("*.plib"):
            with tempfile.TemporaryDirectory() as folder:
                for words in (["mesh"], ["export", "surface"]):
                    subprocess.run([PALPATE, *words, CASES / f"{file.stem}.toml", "--out", folder], check=True, capture_output=True)
                made, shipped = (read_off(f) for f in (pathlib.Path(folder) / "surface.off", file.with_suffix(".off")))
            self.assertEqual((len(made[0]), made[1]), (len(shipped[0]), shipped[1]), file.name)
            self.assertLess(max(math.dist(a, b) for a, b in zip(made[0], shipped[0])), 1e-8, file.name)  # written to 1 nm

    def test_the_skin_of_the_liver_is_that_of_its_library(self):
        skin, library = (json.loads(subprocess.run([PALPATE, "inspect", LIBRARIES / f"liver.{kind}", "--json"], check=True,
                                                   capture_output=True).stdout) for kind in ("pdef", "plib"))
        self.assertEqual(skin["artifact"], "palpate.deformation")
        self.assertEqual(skin["tool_radius"], library["tool_radius"])
        self.assertEqual(skin["vertices_of_the_library"], library["vertices"])
        vertices, triangles, _ = map(int, (LIBRARIES / "liver.off").read_text().split()[1:4])
        self.assertEqual((skin["skin_vertices"], skin["skin_triangles"]), (vertices, triangles))

    def test_gel_is_what_its_case_gives(self):
        with tempfile.TemporaryDirectory() as folder:
            for words in (["build"], ["export", "runtime"]):
                subprocess.run([PALPATE, *words, CASES / "gel.toml", "--out", folder], check=True, capture_output=True)
            with Body(LIBRARIES / "gel.plib") as shipped, Body(pathlib.Path(folder) / "library.plib") as made:
                for x, y in ((0.025, 0.025), (0.02, 0.031), (0.037, 0.022), (0.028, 0.012)):
                    path = slide(x, y, 0.003, 0.004)
                    before, now = shipped.forces(path, 1e-3), made.forces(path, 1e-3)
                    largest = max(map(math.hypot, *zip(*before)))
                    self.assertGreater(largest, 0.1)
                    self.assertLess(max(map(math.dist, before, now)), 0.01 * largest)

    def test_gel_is_as_stiff_as_a_layer_under_a_sphere(self):
        """Hertz for a thin contact, with the first terms for a layer on a rigid base [Dimitriadis et al. 2002, bonded]."""
        young, poisson, radius, depth, thickness = 10e3, 0.45, 5e-3, 1.5e-3, 0.02
        hertz = 4 / 3 * young / (1 - poisson**2) * math.sqrt(radius) * depth**1.5
        chi = math.sqrt(radius * depth) / thickness
        alpha = -(1.2876 - 1.4678 * poisson + 1.3442 * poisson**2) / (1 - poisson)
        layer = hertz * (1 - 2 * alpha / math.pi * chi + (2 * alpha / math.pi * chi)**2)
        with Body(LIBRARIES / "gel.plib") as gel:
            force = gel.forces(press(0.025, 0.025, depth), 1e-3)[-1]
        self.assertLess(abs(force[0]) + abs(force[1]), 0.05 * force[2])
        self.assertAlmostEqual(force[2] / layer, 1, delta=0.15)  # a pad of 50 mm, not a layer without end

    def test_tissue_is_as_stiff_as_gel_at_once_and_gives_way_when_it_is_held(self):
        with Body(LIBRARIES / "gel.plib") as gel, Body(LIBRARIES / "tissue.plib") as tissue:
            path = press(0.025, 0.025, 0.003)
            elastic = gel.forces(path, 1e-9)[-1][2]
            at_once = tissue.forces(path, 1e-9)[-1][2]
            held = tissue.forces(path + [path[-1]] * 12000, 1e-3)[-1][2]  # 12 s: eight of the longest times
        self.assertAlmostEqual(at_once / elastic, 1, delta=0.01)
        # A quarter of the shear stress is left; pressure does not relax, and bears some.
        self.assertGreater(held / elastic, 0.25)
        self.assertLess(held / elastic, 0.40)

    def test_a_drag_of_tissue_that_is_held_gives_way_as_a_press_does(self):
        with Body(LIBRARIES / "gel.plib") as gel, Body(LIBRARIES / "tissue.plib") as tissue:
            path = slide(0.025, 0.025, 0.003, 3e-4)  # within friction
            elastic = gel.forces(path, 1e-9)[-1][0]
            at_once = tissue.forces(path, 1e-9)[-1][0]
            held = tissue.forces(path + [path[-1]] * 12000, 1e-3)[-1][0]
        self.assertGreater(abs(elastic), 0.01)
        self.assertAlmostEqual(at_once / elastic, 1, delta=0.01)
        self.assertGreater(held / elastic, 0.25)
        self.assertLess(held / elastic, 0.40)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
