#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""From a test bench to a rendered body, by the real command, with the records of the pad in data/measured:
import, a library of measurements alone, comparison, calibration by the finite element model, and a
library with simulated shape and measured scale. Usage: measured_test.py PALPATE SOURCE_DIR
"""
import csv
import json
import math
import random
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import command

SOURCE = None
REPEATED = (0.020, 0.020, 0.020)

# As in scripts/make_pad_records.py, in SI.
RADIUS, MODULUS = 0.006, 16.7e3


def law(depth):
    return 4 / 3 * MODULUS * np.sqrt(RADIUS) * depth**1.5 * (1 + 0.1 * depth / RADIUS)


class Measured(unittest.TestCase):
    ok = staticmethod(command.output_of)

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name) / "pad"
        cls.measured = Path(cls.folder.name) / "measured"
        cls.case = SOURCE / "data/cases/pad.toml"
        cls.presses = SOURCE / "data/measured/pad/presses.toml"
        cls.ok("mesh", cls.case, "--out", cls.out)
        cls.ok("import", cls.presses, "--body", cls.out / "body.h5", "--out", cls.measured)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def repeated_vertex(self):
        with h5py.File(self.out / "body.h5", "r") as file:
            points = file["nodes"][()][file["response/node"][()]]
        return int(np.argmin(np.linalg.norm(points - REPEATED, axis=1)))

    def test_the_curves_are_those_of_the_pad(self):
        with h5py.File(self.measured / "curves.h5", "r") as file:
            self.assertEqual(len(file["site/vertex"]), 16)
            site = list(file["site/vertex"][()]).index(self.repeated_vertex())
            path = file["site/first_path"][site]
            self.assertEqual(file["path/repeats"][path], 3)
            first, count = file["path/first_sample"][path], file["path/sample_count"][path]
            rows = slice(first, first + count)
            depth, force = file["sample/displacement"][rows], -file["sample/force"][rows][:, 2]
            uncertainty = file["sample/force_uncertainty"][rows]
            self.assertTrue(np.all(np.isnan(file["sample/strain_energy"][rows])))
            # The stiffness of the pad varies over its top: 4 % times the sine of the number of the site.
            truth = law(depth) * (1 + 0.04 * math.sin(5))
            self.assertTrue(np.all(np.abs(force - truth) <= 3.5 * uncertainty + 1e-9), (force - truth, uncertainty))
            self.assertLess(uncertainty[-1], 0.06 * force[-1])

    def test_the_account_says_what_was_found(self):
        account = json.loads((self.measured / "import.json").read_text())
        self.assertEqual(len(account["records"]), 18)
        for record in account["records"]:
            self.assertAlmostEqual(record["force_offset_N"], 0.05, delta=2e-4)
            self.assertAlmostEqual(record["rate_m_per_s"], 0.5e-3, delta=2e-5)
            # 1 - 0.5 (1 - int d^2.5/int d^1.5) for a force as d^1.5
            self.assertAlmostEqual(record["returned_fraction"], 1 - 0.5 * (1 - 2.5 / 3.5), delta=0.02)
            self.assertTrue(0.8e-3 - 3e-4 < record["contact_m"] < 0.85e-3 + 3e-4)
            self.assertLess(abs(record["drift_N_per_s"] - 2e-4), 6 * record["drift_uncertainty_N_per_s"] + 2e-5)

    def test_a_library_from_measurements_alone(self):
        out = Path(self.folder.name) / "alone"
        out.mkdir()
        for name, source in (("body.h5", self.out), ("curves.h5", self.measured)):
            (out / name).write_bytes((source / name).read_bytes())
        self.ok("fit", self.case, "--out", out)
        self.ok("certify", self.case, "--out", out)
        summary = json.loads(self.ok("inspect", out / "library.h5", "--json"))
        self.assertEqual(summary["responses_fitted"], 16)
        self.assertEqual(summary["certificate"]["basis"], "measured")
        self.assertEqual([s["stage"] for s in summary["provenance"]], ["mesh", "import", "fit", "certify"])
        self.assertEqual(summary["provenance"][1]["facts"]["licence"], "CC0-1.0")
        # The library against the measurement.
        text = self.ok("compare", self.measured / "curves.h5", out / "library.h5", "--out", out / "compared")
        self.assertIn("within the uncertainty", text)
        compared = json.loads((out / "compared/comparison.json").read_text())
        normal = compared["summaries"][0]
        self.assertEqual(normal["curves"], 16)
        self.assertLess(normal["normalised_rmse"], 0.03)
        with open(out / "compared/comparison.csv", encoding="ascii", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(compared["curves"]))
        self.assertAlmostEqual(float(rows[0]["rmse_N"]), compared["curves"][0]["rmse_N"])

    def test_robot_logs_find_the_same_site(self):
        out = Path(self.folder.name) / "robot"
        self.ok("import", SOURCE / "data/measured/pad/robot.toml", "--body", self.out / "body.h5", "--out", out)
        record = json.loads((out / "import.json").read_text())["records"][0]
        self.assertEqual(record["vertex"], self.repeated_vertex())
        self.assertAlmostEqual(record["drag"]["lateral_depth_m"], 1.4e-3, delta=5e-5)
        with h5py.File(out / "curves.h5", "r") as file:
            self.assertEqual(list(file["path/kind"][()]), [0, 1])
            rows = slice(file["path/first_sample"][1], None)
            along = file["sample/force"][rows] @ file["path/direction"][1]
            travel = file["sample/displacement"][rows]
            slope = np.polyfit(travel, along, 1)[0]
        depth = 1.4e-3
        stiffness = (law(depth + 1e-6) - law(depth - 1e-6)) / 2e-6
        self.assertAlmostEqual(slope, 2 / 3 * stiffness, delta=0.03 * stiffness)

    def test_calibration_and_rescaling_agree(self):
        """Neo-Hookean forces are proportional to the modulus: the calibrated Young's modulus over the
        one of the case is the factor between measured and simulated curves."""
        self.ok("precompute", self.case, "--out", self.out, "--threads", 2)
        scaled = Path(self.folder.name) / "scaled"
        text = self.ok("rescale", self.out / "curves.h5", self.measured / "curves.h5", "--out", scaled)
        factor = float(text.split("measured = ")[1].split()[0])
        robot = Path(self.folder.name) / "robot-calibrate"
        self.ok("import", SOURCE / "data/measured/pad/robot.toml", "--body", self.out / "body.h5", "--out", robot)
        self.ok("calibrate", "body", self.case, "--measured", robot / "curves.h5", "--young", "gel",
                "--depths", 3, "--out", self.out, "--threads", 2)
        found = json.loads((self.out / "calibration.json").read_text())
        young = found["constants"][0]
        self.assertEqual(young["name"], "young of gel")
        self.assertAlmostEqual(young["value"] / 10e3, factor, delta=0.1 * factor)
        self.assertLess(young["low"], young["value"])
        self.assertEqual([p["kind"] for p in found["paths"]], ["normal"])
        # The drag is that of a half-space with a round contact, which this mesh does not resolve: the fit reports it.
        text = self.ok("calibrate", "body", self.case, "--measured", robot / "curves.h5", "--young", "gel", "--drags",
                       "--depths", 2, "--out", self.out, "--threads", 2)
        self.assertIn("1 site, 1 drag,", text)
        self.assertIn("intervals are widened", text)
        found = json.loads((self.out / "calibration.json").read_text())
        self.assertEqual([p["kind"] for p in found["paths"]], ["normal", "lateral"])
        self.assertAlmostEqual(found["paths"][1]["lateral_depth_m"], 1.4e-3, delta=5e-5)
        (scaled / "body.h5").write_bytes((self.out / "body.h5").read_bytes())
        self.ok("fit", self.case, "--out", scaled)
        self.ok("certify", self.case, "--out", scaled)
        summary = json.loads(self.ok("inspect", scaled / "library.h5", "--json"))
        self.assertEqual(summary["certificate"]["basis"], "simulated shape, measured scale")
        with h5py.File(scaled / "curves.h5", "r") as a, h5py.File(self.out / "curves.h5", "r") as b:
            ratio = np.abs(a["sample/force"][()]).sum() / np.abs(b["sample/force"][()]).sum()
            self.assertAlmostEqual(ratio, factor, delta=1e-3)

    def test_a_fit_that_is_none_is_an_error_and_not_written(self):
        """Tension with its sign turned: no law of positive modulus fits it better than no stress does."""
        folder = Path(self.folder.name)
        (folder / "turned.csv").write_text("stretch (1),stress (kPa)\n1.1,-1\n1.2,-2\n1.3,-3\n1.4,-4\n1.5,-5\n")
        fit = folder / "turned.toml"
        fit.write_text('name = "a"\nsource = "b"\nlicence = "c"\n[fit]\nlaw = "gent"\n[[test]]\nfile = "turned.csv"\n'
                       'mode = "uniaxial"\ndeformation = "stretch"\nstress = "stress"\n')
        result = command.palpate("calibrate", "tests", fit, "--out", folder / "turned")
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("fit of gent", result.stderr)
        self.assertIn("; check signs", result.stderr)
        self.assertFalse((folder / "turned").exists())
        fit.write_text(fit.read_text() + 'stress_sign = "reversed"\n')
        self.ok("calibrate", "tests", fit, "--out", folder / "turned")
        self.assertTrue((folder / "turned/calibration.html").exists())

    def test_a_hard_fit_prints_warnings_of_its_own_alone(self):
        """Three terms of Ogden's law where two would do: their solver meets states without a stress on its way."""
        folder = Path(self.folder.name)
        terms = ((0.41e6, 1.3), (3e3, 5), (-1e4, -2))
        rows, noise = [], random.Random(3)
        for i in range(40):
            s = 1.2 + (17 - 1.2) * i / 39
            stress = sum(mu * (s ** (a - 1) - s ** (-a / 2 - 1)) for mu, a in terms) * (1 + 0.01 * noise.gauss(0, 1))
            rows.append(f"{100 * (s - 1):.3f},{1e-6 * stress:.6f}")
        (folder / "far.csv").write_text("Strain (%),Stress (MPa)\n" + "\n".join(rows) + "\n")
        fit = folder / "far.toml"
        fit.write_text('name = "a"\nsource = "b"\nlicence = "c"\n[fit]\nlaw = "ogden-3"\n[[test]]\nfile = "far.csv"\n'
                       'mode = "uniaxial"\ndeformation = "Strain"\ndeformation_is = "strain"\nstress = "Stress"\n')
        result = command.palpate("calibrate", "tests", fit)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("R2 0.999", result.stdout)
        for line in result.stderr.splitlines():
            self.assertTrue(line.startswith("warning: "), line)

    def refuse(self, words, text, name="bad.toml", body=True):
        sidecar = Path(self.folder.name) / name
        sidecar.write_text(text.replace('file = "', f'file = "{self.presses.parent}/'), encoding="utf-8")
        out = Path(self.folder.name) / "none"
        arguments = ["import", sidecar, "--out", out] + (["--body", self.out / "body.h5"] if body else [])
        result = command.palpate(*arguments)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("; ", result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(out.exists())

    def test_bad_sidecars_are_refused(self):
        text = self.presses.read_text(encoding="utf-8")
        self.refuse(["'licence' is missing"], text.replace('licence = "CC0-1.0"\n', ""))
        self.refuse(["no column is named 'Load'", "'Compressive load'"], text.replace('"Compressive load"', '"Load"'))
        self.refuse(["neither vertex nor site"], text.replace('site = ["20 mm", "20 mm", "20 mm"]\n', ""))
        self.refuse(["mm away"], text.replace('"20 mm"]', '"40 mm"]'))
        self.refuse(["the file says 'N', the sidecar says 'kN'"],
                    text.replace("[path]", 'force_unit = "kN"\n\n[path]'))
        self.refuse(["needs a body"], text, body=False)
        self.refuse(["unknown key 'complience'"], text.replace("compliance =", "complience ="))
        (Path(self.folder.name) / "other.toml").write_text(text, encoding="utf-8")
        self.refuse(["several sidecars lie beside it", "bad.toml"], "Time,Load\n0,0\n", name="press.csv")
        (Path(self.folder.name) / "without-sidecar").mkdir()
        self.refuse(["this is a record", "TOML"], "Time,Load\n0,0\n", name="without-sidecar/press.csv")

    def test_a_record_that_is_missing_does_not_take_the_others_with_it(self):
        text = self.presses.read_text(encoding="utf-8").replace("press-20-20-1.csv", "press-none.csv")
        sidecar = Path(self.folder.name) / "side" / "missing.toml"
        sidecar.parent.mkdir(exist_ok=True)
        sidecar.write_text(text.replace('file = "', f'file = "{self.presses.parent}/'), encoding="utf-8")
        arguments = ["import", sidecar, "--body", self.out / "body.h5", "--out", Path(self.folder.name) / "others"]
        result = command.palpate(*arguments)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertRegex(result.stdout, r"refused \S*press-none.csv: .*cannot be read")
        with h5py.File(Path(self.folder.name) / "others/curves.h5", "r") as file:
            site = list(file["site/vertex"][()]).index(self.repeated_vertex())
            self.assertEqual(len(file["site/vertex"]), 16)
            self.assertEqual(file["path/repeats"][file["site/first_path"][site]], 2)  # of three
        self.ok(*arguments, "--allow-refused")

    def test_the_choice_of_a_cycle_is_printed(self):
        """Three presses in one record, each deeper than the one before: the first, unless another is chosen."""
        folder = Path(self.folder.name) / "cycles"
        folder.mkdir()
        rows, t = [], 0.0
        for x in [i / 100 for i in range(100)] + [1 + d for c in (1, 1.5, 2)
                                                  for d in [i * c / 100 for i in [*range(101), *range(100, -1, -1)]]]:
            depth = max(x - 1, 0) * 1e-3
            rows.append(f"{t:.2f},{x:.4f},{16 / 9 * 5e3 * 0.002 * depth ** 1.5 + 1e-6 * ((7 * len(rows)) % 5 - 2):.9f}")
            t += 0.05
        (folder / "a.csv").write_text("t (s),x (mm),f (N)\n" + "\n".join(rows) + "\n")
        sidecar = folder / "side.toml"
        text = ('name = "c"\nspecimen = "gel"\nsource = "synthetic"\nlicence = "CC0-1.0"\n'
                '[tool]\nradius = "4 mm"\nfriction = "frictionless"\n'
                '[columns]\ntime = "t"\ndisplacement = "x"\nforce = "f"\n[[press]]\nfile = "a.csv"\nvertex = 0\n')
        for cycle, words in (("", "a.csv: cycle 1 of 3, 1.00 mm deep"), ("cycle = -1\n", "a.csv: cycle 3 of 3, 2.0")):
            sidecar.write_text(text + cycle)
            self.assertIn(words, self.ok("import", sidecar, "--out", folder / "out"))

    def test_a_tool_larger_than_the_body_is_doubted(self):
        sidecar = Path(self.folder.name) / "doubted.toml"
        text = self.presses.read_text(encoding="utf-8").replace('file = "', f'file = "{self.presses.parent}/')
        for radius, doubted in (("6 mm", False), ("6 m", True)):
            sidecar.write_text(text.replace('radius = "6 mm"', f'radius = "{radius}"'), encoding="utf-8")
            out = self.ok("import", sidecar, "--out", Path(self.folder.name) / "doubted", "--body", self.out / "body.h5")
            self.assertEqual("the radius of the tool, 6000 mm, is larger than the body" in out, doubted, out)

    def test_a_slice_under_a_sphere_of_25_um(self):
        """Micrometres and micronewtons: the modulus of the record, which Hertz made, is in its interval."""
        out, records = Path(self.folder.name) / "slice", Path(self.folder.name) / "slice-measured"
        case = SOURCE / "data/cases/slice.toml"
        self.ok("mesh", case, "--out", out)
        text = self.ok("import", SOURCE / "data/measured/slice/press.toml", "--body", out / "body.h5", "--out", records)
        self.assertRegex(text, r"to 12\.\d um, 0\.4\d+ uN")
        self.ok("calibrate", "body", case, "--measured", records / "curves.h5", "--young", "brain", "--out", out)
        young = json.loads((out / "calibration.json").read_text())["constants"][0]
        self.assertEqual(young["unit"], "Pa")
        self.assertLess(young["low"], 1200)
        self.assertGreater(young["high"], 1200)
        self.assertLess(young["high"] - young["low"], 0.3 * 1200)

    def test_bad_records_are_refused(self):
        """Common mistakes in records: each is an error of one line that names the file and the remedy."""
        record = (self.presses.parent / "press-20-20-1.csv").read_bytes().decode()
        units = '"(s)","(mm)","(N)"'
        self.assertIn(units, record)
        bad = Path(self.folder.name) / "record.csv"
        text = self.presses.read_text(encoding="utf-8")
        text = text[:text.index("[[press]]")] + '[[press]]\nfile = "../record.csv"\nsite = ["20 mm", "20 mm", "20 mm"]\n'
        for words, content in (
                (["its unit is not given"], record.replace(units + "\r\n", "")),
                (["mm deep into a body of", "check the unit"], record.replace(units, '"(s)","(m)","(N)"')),
                (["would yield", "check the units"], record.replace(units, '"(s)","(mm)","(kN)"')),
                (["'mm' is not a unit of force"], record.replace(units, '"(s)","(mm)","(mm)"')),
                (["is not a number"], record.replace('"0.100"', '"NaN"', 1)),
                (["ends within quotes", "cut off"], record[:4000]),
                (["never rises"], record[:record.rindex("\n", 0, 2500)])):
            bad.write_bytes(content.encode())
            with self.subTest(words):
                sidecar = Path(self.folder.name) / "side" / "bad.toml"
                sidecar.parent.mkdir(exist_ok=True)
                sidecar.write_text(text, encoding="utf-8")
                out = Path(self.folder.name) / "none"
                result = command.palpate("import", sidecar, "--out", out, "--body", self.out / "body.h5")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                for word in words:
                    self.assertIn(word, result.stderr)
                self.assertFalse(out.exists())

    def test_fit_files_of_the_shipped_tables(self):
        for fit in sorted((SOURCE / "data/measured").glob("*/*.toml")):
            if fit.parent.name in ("pad", "liver-patch", "pig-liver", "slice", "meat"):  # records of bodies
                continue
            with self.subTest(fit):
                out = Path(self.folder.name) / "fits" / fit.parent.name / fit.stem
                self.ok("calibrate", "tests", fit, "--out", out)
                found = json.loads((out / "calibration.json").read_text())
                for test in found["tests"]:
                    self.assertGreater(test["r2"], 0.9)
                rows = (out / "correlations.csv").read_text().splitlines()
                self.assertEqual(len(rows), 1 + len(found["constants"]))
                if fit.parent.name == "clot-2021" and fit.stem == "ogden":
                    self.assertAlmostEqual(found["constants"][0]["value"], 2378.17, delta=0.05)
                    self.assertAlmostEqual(found["constants"][1]["value"], 4.28007, delta=5e-5)
                if fit.stem == "clamped":  # the authors' own fit with finite elements, by FEBio
                    self.assertAlmostEqual(found["constants"][0]["value"], 2248.8, delta=10)
                    self.assertAlmostEqual(found["constants"][1]["value"], 4.17545, delta=0.01)

    def test_records_of_two_tools_are_apart_and_calibrated_together(self):
        folder = Path(self.folder.name) / "two-tools"
        folder.mkdir()
        # Hertz on the half-space: forces of spheres of 4 mm and 6 mm at one site.
        for tool, radius in (("small", 4), ("large", 6)):
            rows = []
            for i in range(-20, 151):
                x = 0.01 * i  # mm
                force = 16 / 9 * 3e-3 * radius ** 0.5 * max(x, 0) ** 1.5  # N at 3 kPa
                rows.append(f"{0.05 * (i + 20):.2f},{x:.2f},{force + 1e-6 * ((7 * i) % 5 - 2):.9f}")
            (folder / f"{tool}.csv").write_text("t (s),x (mm),f (N)\n" + "\n".join(rows) + "\n")
        (folder / "both.toml").write_text(
            'name = "both"\nspecimen = "gel"\nsource = "synthetic"\nlicence = "CC0-1.0"\n'
            '[[tool]]\nname = "small"\nradius = "4 mm"\nfriction = "frictionless"\n'
            '[[tool]]\nname = "large"\nradius = "6 mm"\nfriction = "frictionless"\n'
            '[columns]\ntime = "t"\ndisplacement = "x"\nforce = "f"\n'
            '[[press]]\nfiles = "{tool}.csv"\ntool_from = "{tool}"\nsite = ["20 mm", "20 mm", "20 mm"]\n')
        out = folder / "out"
        printed = self.ok("import", folder / "both.toml", "--out", out, "--body", self.out / "body.h5")
        self.assertIn("tool 'small'", printed)
        curves = [out / "small/curves.h5", out / "large/curves.h5"]
        self.assertFalse((out / "curves.h5").exists())
        alike = command.palpate("compare", *curves, "--out", folder)
        self.assertEqual(alike.returncode, 2, alike.stdout)
        self.assertIn("radius", alike.stderr)
        printed = self.ok("calibrate", "body", self.case, "--measured", *curves, "--young", "gel", "--out", self.out)
        self.assertIn("curves 2: 1 site under a sphere of 6.00 mm radius", printed)
        found = json.loads((self.out / "calibration.json").read_text())
        self.assertEqual([path["curves"] for path in found["paths"]], [1, 2])


if __name__ == "__main__":
    SOURCE = Path(sys.argv.pop(2))
    command.PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
