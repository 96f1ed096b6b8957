#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Records over time, from the file to the series and back, by the real command, with the synthetic records of
tests/data/relaxation: import, calibration, a library with the series that was found, and its comparison with the
records over time.
Usage: test_measured_relaxation.py PALPATE SOURCE_DIR
"""
import csv
import json
import math
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import command

SOURCE = None
SERIES = ((0.3, 0.25), (0.2, 4.0))  # as in make_records.py
SIDECAR = """name = "relaxing pad"
specimen = "synthetic"
source = "this test"
licence = "CC0-1.0"
[tool]
radius = "6 mm"
friction = "frictionless"
[columns]
time = "time"
displacement = "travel"
force = "force"
"""


class MeasuredRelaxation(unittest.TestCase):
    ok = staticmethod(command.output_of)

    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.holder.name)
        cls.out = cls.folder / "pad"
        cls.case = SOURCE / "data/cases/pad.toml"
        cls.ok("mesh", cls.case, "--out", cls.out)
        cls.sidecar = SOURCE / "tests/data/relaxation/records.toml"
        cls.histories = cls.folder / "imported/histories.json"
        cls.said = cls.ok("import", cls.sidecar, "--body", cls.out / "body.h5", "--out", cls.histories.parent)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    def test_records_are_kept_whole_with_their_phases(self):
        held, cycles = json.loads(self.histories.read_text())["records"]
        self.assertEqual([p["kind"] for p in held["phases"]], ["approach", "ramp", "hold"])
        self.assertAlmostEqual(held["phases"][2]["from_s"], 2.4, delta=0.05)
        self.assertEqual(sum(p["kind"] == "release" for p in cycles["phases"]), 4)
        self.assertEqual(len(held["time_s"]), 1621)
        self.assertAlmostEqual(held["contact_m"], 4e-3, delta=5e-5)
        self.assertIn("the travel is held", self.said)
        self.assertFalse((self.histories.parent / "curves.h5").exists())

    def test_the_series_is_found_and_printed_for_a_case(self):
        out = self.folder / "series"
        text = self.ok("calibrate", "relaxation", self.histories, "--out", out)
        found = json.loads((out / "calibration.json").read_text())
        self.assertEqual(len(found["relaxation"]), 2, text)
        for term, (fraction, time) in zip(found["relaxation"], SERIES):
            self.assertAlmostEqual(term["fraction"], fraction, delta=0.03)
            self.assertAlmostEqual(term["time_s"] / time, 1, delta=0.15)
        self.assertIn("relaxation = [{ fraction = ", text)
        self.assertIn("say nothing of shorter and longer times", text)
        page = (out / "calibration.html").read_text(encoding="utf-8")
        self.assertIn("relaxation_function", page)
        # The sidecar itself will do.
        self.assertEqual(self.ok("calibrate", "relaxation", self.sidecar, "--no-profiles").splitlines()[0],
                         text.splitlines()[0])

    def library(self, case, name, curves):
        out = self.folder / name
        out.mkdir(exist_ok=True)
        (out / "body.h5").write_bytes((self.folder / "simulated/body.h5").read_bytes())
        if curves != out / "curves.h5":
            (out / "curves.h5").write_bytes(curves.read_bytes())
        self.ok("fit", case, "--out", out)
        self.ok("certify", case, "--out", out)
        return out / "library.h5"

    def presses_at_once(self, calibration, body):
        """The measured presses with the series that the calibration printed: curves that relax."""
        key = re.search(r"relaxation = .*", calibration).group(0)
        copy = self.folder / "pad-records"
        shutil.copytree(SOURCE / "data/measured/pad", copy)
        sidecar = copy / "presses.toml"
        text = sidecar.read_text(encoding="ascii")
        self.assertIn("[path]\n", text)
        sidecar.write_text(text.replace("[path]\n", f"[path]\n{key}\n"), encoding="ascii")
        self.ok("import", sidecar, "--body", body, "--out", self.folder / "at-once-curves")
        return self.folder / "at-once-curves/curves.h5"

    def test_the_library_with_the_series_follows_the_records(self):
        """Simulated shape with the series that was found, scale of the records over time; measured presses alone with
        that series; against the measured presses as they are, which do not relax."""
        text = self.ok("calibrate", "relaxation", self.histories, "--no-profiles")
        case, presses, simulated = SOURCE / "data/cases/relaxing-pad.toml", self.folder / "presses", self.folder / "simulated"
        for key in re.findall(r"(?:relaxation|moduli) = .*", text):
            self.assertIn(key.strip() + "\n", case.read_text(encoding="ascii"))
        self.ok("mesh", case, "--out", simulated)
        body, records = simulated / "body.h5", self.folder / "records/histories.json"
        self.ok("import", SOURCE / "data/measured/pad/presses.toml", "--body", body, "--out", presses)
        self.ok("import", self.sidecar, "--body", body, "--out", records.parent)
        self.ok("precompute", case, "--out", simulated)
        self.ok("rescale", simulated / "curves.h5", records, "--out", self.folder / "scaled")
        libraries = {"relaxing": self.library(case, "scaled", self.folder / "scaled/curves.h5"),
                     "measured": self.library(case, "at-once", self.presses_at_once(text, body)),
                     "elastic": self.library(case, "alone", presses / "curves.h5")}
        compared = {}
        for name, library in libraries.items():
            out = self.folder / f"over-time-{name}"
            said = self.ok("compare", records, library, "--out", out)
            self.assertIn("of the force is left", said)
            compared[name] = json.loads((out / "over-time.json").read_text())["records"]
            with open(out / "over-time.csv", encoding="ascii", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(len(rows), sum(len(r["time_s"]) for r in compared[name]))
            self.assertIn("over_time", (out / "over-time.html").read_text(encoding="utf-8"))
        for relaxing, measured, elastic in zip(*(compared[name] for name in ("relaxing", "measured", "elastic"))):
            self.assertLess(relaxing["normalised_rmse"], 0.05)
            self.assertLess(measured["normalised_rmse"], 0.5 * elastic["normalised_rmse"])
        one = json.loads(records.read_text())
        one["records"] = one["records"][:1]
        (self.folder / "held").mkdir()
        (self.folder / "held/histories.json").write_text(json.dumps(one), encoding="ascii")
        hold = compared["relaxing"][0]["holds"][0]
        self.assertAlmostEqual(hold["model_left"], hold["measured_left"], delta=0.04)
        self.assertAlmostEqual(compared["elastic"][0]["holds"][0]["model_left"], 1, delta=1e-3)
        # The same case by the finite element model, with the modulus of its file: what is left is a ratio.
        self.ok("compare", "--fem", case, "--histories", self.folder / "held/histories.json", "--out", simulated)
        direct = json.loads((simulated / "over-time.json").read_text())["records"]
        self.assertEqual([r["model"] for r in direct], ["direct"])
        self.assertAlmostEqual(direct[0]["holds"][0]["model_left"], hold["measured_left"], delta=0.03)
        cycles = compared["relaxing"][1]
        self.assertAlmostEqual(cycles["model_loss_J"] / cycles["measured_loss_J"], 1, delta=0.2)

    def test_a_site_for_febio_is_pressed_in_the_time_given_and_held(self):
        case, out = SOURCE / "data/cases/relaxing-pad.toml", self.folder / "deck"
        self.ok("mesh", case, "--out", out)
        said = self.ok("export", "site", case, "--out", out, "--vertex", 12, "--febio", "--press-seconds", 0.2,
                       "--hold-seconds", 2)
        self.assertIn("pressed in 0.2 s and held for 2 s", said)
        rows = list(csv.DictReader((out / "site-12-tool.csv").open()))
        force = {float(row["time_s"]): abs(float(row["force_z_N"])) for row in rows}
        # The same press of quasi-linear tissue, whose force grows like that of Hertz.
        terms = [(float(f), float(t)) for f, t in re.findall(r'fraction = ([\d.]+), time = "([\d.]+) s"', case.read_text())]

        def relaxed(time, parts=1000):
            g = [1 - sum(f * (1 - math.exp(-(time - 0.2 * (i + 0.5) / parts) / t)) for f, t in terms)
                 for i in range(parts)]
            return sum(g[i] * (((i + 1) / parts) ** 1.5 - (i / parts) ** 1.5) for i in range(parts))
        self.assertAlmostEqual(max(force), 2.2)
        self.assertAlmostEqual(force[max(force)] / max(force.values()), relaxed(2.2) / relaxed(0.2), delta=0.02)
        self.assertIn("<t2>3.965</t2>", (out / "site-12.feb").read_text())
        for times in (["nan", "1"], ["1", "nan"], ["inf", "1"], ["0", "1"], ["1", "-1"]):
            refused = command.palpate("export", "site", case, "--out", out, "--vertex", 12, "--febio",
                                      "--press-seconds", times[0], "--hold-seconds", times[1])
            self.assertEqual(refused.returncode, 2, times)
            self.assertRegex(refused.stderr, "-seconds: .* is out of range; give ")

    def test_meat_from_the_record_to_a_library_that_relaxes_as_another_site_does(self):
        """A public data set: the series of three sites predicts the force of a fourth over time, with one factor."""
        meat, case = SOURCE / "data/measured/meat", SOURCE / "data/cases/meat.toml"
        series = self.folder / "meat-series"
        text = self.ok("calibrate", "relaxation", meat / "records.toml", "--out", series)
        self.assertIn(re.search(r"relaxation = .*", text).group(0) + "\n", case.read_text(encoding="ascii"))
        found = json.loads((series / "calibration.json").read_text())
        exponent = next(c for c in found["constants"] if c["name"] == "exponent")
        # A ball on a thin layer: 1.5 on a half-space, more where the contact is as wide as the layer is thick.
        self.assertGreater(exponent["value"], 1.5)
        self.assertLess(exponent["value"], 2)
        out, other = self.folder / "meat", self.folder / "meat-other"
        self.ok("mesh", case, "--out", out)
        self.ok("import", meat / "held-out.toml", "--body", out / "body.h5", "--out", other)
        self.ok("precompute", case, "--out", out)
        scaled = self.folder / "meat-scaled"
        self.ok("rescale", out / "curves.h5", other / "histories.json", "--out", scaled)
        (scaled / "body.h5").write_bytes((out / "body.h5").read_bytes())
        self.ok("fit", case, "--out", scaled)
        self.ok("certify", case, "--out", scaled)
        self.ok("compare", other / "histories.json", scaled / "library.h5", "--out", scaled)
        record = json.loads((scaled / "over-time.json").read_text())["records"][0]
        self.assertLess(record["normalised_rmse"], 0.06)
        # From five seconds into the hold on, where less than half of the force is left.
        late = [i for i, t in enumerate(record["time_s"]) if t > 9]
        for i in late:
            self.assertAlmostEqual(record["model_N"][i] / record["measured_N"][i], 1, delta=0.1)
        self.assertLess(max(record["measured_N"][i] for i in late), 0.5 * max(record["measured_N"]))
        self.assertIn("absorbed", self.ok("simulate", case, "--out", scaled))

    def test_bad_records_are_refused_in_one_line(self):
        for name, change, words in (
                ("still", lambda rows: rows[:40] + [rows[39]] + rows[40:], "does not increase"),
                ("short", lambda rows: rows[:125], "fewer than two cycles"),
                ("nan", lambda rows: rows[:50] + ["0.98,nan,0"] + rows[51:], "nan.csv:51: "),
                ("late", lambda rows: rows[:1] + rows[120:], "")):
            with self.subTest(name):
                rows = (SOURCE / "tests/data/relaxation/held.csv").read_text(encoding="ascii").splitlines()
                (self.folder / f"{name}.csv").write_text("\n".join(change(rows)) + "\n", encoding="ascii")
                sidecar = self.folder / f"{name}.toml"
                sidecar.write_text(SIDECAR + f'[[history]]\nfile = "{name}.csv"\n', encoding="ascii")
                result = command.palpate("calibrate", "relaxation", sidecar)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertIn(words, result.stderr)


if __name__ == "__main__":
    SOURCE = Path(sys.argv.pop(2))
    command.PALPATE = sys.argv.pop(1)
    unittest.main(verbosity=2)
