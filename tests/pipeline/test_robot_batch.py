#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""From a robot's log to a felt organ, by the real command: the surface from contact points and normals, the library of
measurements alone with its certificate, a session, sites left out, and what is refused. The records are those of
data/measured/liver-patch, whose true force is known. Usage: test_robot_batch.py PALPATE SOURCE_DIR
"""
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import command

SOURCE = None


def records_script():
    sys.path.insert(0, str(SOURCE / "scripts"))
    import make_liver_patch_records

    return make_liver_patch_records


class RobotBatch(unittest.TestCase):
    @staticmethod
    def ok(*arguments):
        return command.output_of(*arguments, may_warn=True)

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name) / "organ"
        cls.case = SOURCE / "data/cases/liver-patch.toml"
        cls.truth = records_script()
        cls.ok("build", cls.case, "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_the_records_are_those_of_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            self.truth.main(Path(folder))
            made = (Path(folder) / "probing.csv").read_bytes()
        self.assertEqual(made, (SOURCE / "data/measured/liver-patch/probing.csv").read_bytes())

    def test_the_surface_is_that_of_the_contact_points(self):
        with h5py.File(self.out / "body.h5", "r") as file:
            self.assertEqual(file.attrs["schema"], 4)
            points, inward = file["nodes"][()], file["response/inward"][()]
            triangles = file["response/triangles"][()]
            self.assertEqual(file["tetrahedra"].shape[0], 0)
        sites = self.truth.sites()
        true = np.array([self.truth.robot(self.truth.surface(u, v)) for u, v in sites]) + (20, -40, -140)
        self.assertLess(np.abs(points * 1e3 - true).max(), 2e-3)
        normals = np.array([self.truth.robot(self.truth.normal(u, v)) for u, v in sites])
        self.assertGreater(np.sum(-inward * normals, axis=1).min(), math.cos(math.radians(5 * self.truth.TILT)))
        # A disc of 63 sites: V - E + M = 1.
        edges = {tuple(sorted((t[i], t[(i + 1) % 3]))) for t in triangles for i in range(3)}
        self.assertEqual(len(points) - len(edges) + len(triangles), 1)

    def test_the_library_has_the_true_forces(self):
        """At every site and sample within what its uncertainty allows, beside the scatter of a press."""
        with h5py.File(self.out / "curves.h5", "r") as file:
            worst = 0
            for row, (u, v) in enumerate(self.truth.sites()):
                path = file["site/first_path"][row]
                first, count = file["path/first_sample"][path], file["path/sample_count"][path]
                depth = file["sample/displacement"][first:first + count] * 1e3
                force = np.linalg.norm(file["sample/force"][first:first + count], axis=1)
                doubt = file["sample/force_uncertainty"][first:first + count]
                true = np.array([self.truth.force(u, v, d) for d in depth])
                allowed = np.hypot(doubt, self.truth.SCATTER * true) + 1e-9
                worst = max(worst, (np.abs(force - true) / allowed).max())
            self.assertLess(worst, 4.5)
        summary = json.loads(self.ok("inspect", self.out / "library.h5", "--json"))
        self.assertEqual(summary["responses_fitted"], 63)
        self.assertEqual(summary["certificate"]["basis"], "measured")
        self.assertEqual([s["stage"] for s in summary["provenance"]],
                         ["mesh", "import", "precompute", "fit", "certify"])

    def test_the_certificate_holds(self):
        """A search for steeper forces finds none, and a closed path of a hand does not gain energy."""
        self.ok("certify", self.case, "--out", self.out, "--challenge", "40")
        self.ok("simulate", self.case, "--out", self.out)
        with h5py.File(self.out / "recording.h5", "r") as file:
            absorbed = file["step/absorbed"][()]
            force = np.linalg.norm(file["step/force"][()], axis=1)
        self.assertGreater(force.max(), 0.05)
        self.assertGreaterEqual(absorbed.min(), -1e-9)

    def test_sites_left_out_are_predicted_no_better_than_presses_repeat(self):
        text = self.ok("compare", "--leave-out", self.case, "--out", self.out)
        result = json.loads((self.out / "leave-out.json").read_text())
        self.assertIn(f"{result['predicted_sites']} of 63 sites predicted", text)
        self.assertGreaterEqual(result["predicted_sites"], 35)
        # The scatter of a press alone gives this median, 2/3 of a standard deviation; the field adds to it.
        least = 0.6745 * self.truth.SCATTER
        self.assertGreater(result["deepest"]["median"], least)
        self.assertLess(result["deepest"]["median"], 0.5 * result["neighbours_deepest"]["median"])
        self.assertLess(result["deepest"]["p95"], 0.15)
        # The predictions against the truth, which is smooth.
        sites = self.truth.sites()
        errors = []
        for press in result["presses"]:
            if press["predicted_N"]:
                true = self.truth.force(*sites[press["vertex"]], press["depth_m"][-1] * 1e3)
                errors.append(abs(press["predicted_N"][-1] / true - 1))
        self.assertLess(np.median(errors), 0.05)
        comparison = json.loads((self.out / "comparison.json").read_text())
        self.assertEqual(len(comparison["curves"]), result["predicted_sites"])
        self.assertEqual(comparison["jnd_floor_N"], 5e-3)  # docs/measured.md

    def test_a_slab_explains_the_presses(self):
        """The moduli of the sites follow the true forces, and finite elements are compared with the measurement."""
        out = self.out / "slab"
        text = self.ok("calibrate", "slab", self.out / "curves.h5", "--points", "2", "3", "--depths", "3", "--out", out)
        self.assertRegex(text, r"63 sites as one slab of demiray-fung")
        found = json.loads((out / "calibration.json").read_text())
        for what in ("thickness_m", "stiffening"):
            self.assertIn(found["slab"][what]["identified"], ("interval", "lower bound", "upper bound", "not identified"))
        moduli = [c["value"] for c in found["constants"] if c["name"].startswith("shear modulus")]
        true = [self.truth.force(u, v, 3.0) for u, v in self.truth.sites()]
        self.assertGreater(np.corrcoef(moduli, true)[0, 1], 0.95)
        self.ok("compare", self.out / "curves.h5", out / "curves.h5", "--out", out)
        comparison = json.loads((out / "comparison.json").read_text())
        self.assertEqual(len(comparison["curves"]), 63)

    def test_the_report_opens_with_the_map_of_the_errors(self):
        self.ok("compare", "--leave-out", self.case, "--out", self.out)
        self.ok("report", self.case, "--out", self.out)
        page = (self.out / "report.html").read_text()
        self.assertIn("from those around it", page)

    def test_import_makes_the_surface_as_well(self):
        out = Path(self.folder.name) / "imported"
        text = self.ok("import", SOURCE / "data/measured/liver-patch/sidecar.toml", "--out", out)
        self.assertRegex(text, r"surface of 63 sites, 5\.\d+ mm apart")
        account = json.loads((out / "import.json").read_text())
        lateral = [record["lateral_fraction"] for record in account["records"]]
        self.assertAlmostEqual(np.median(lateral), self.truth.STUCK, delta=0.02)

    def test_finite_elements_refuse_it(self):
        for arguments in (["precompute", self.case, "--convergence", "3"], ["compare", "--fem", self.case],
                          ["precompute", self.case, "--estimate"]):
            result = command.palpate(*arguments, "--out", self.out)
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            self.assertIn("inside", result.stderr)

    # What is refused: changed copies of the records.

    def refused(self, change, wanted):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            lines = (SOURCE / "data/measured/liver-patch/probing.csv").read_text().splitlines()
            rows = [line.split(",") for line in lines[1:]]
            rows = change(rows) or rows
            (folder / "probing.csv").write_text("\n".join([lines[0], *(",".join(row) for row in rows)]) + "\n")
            sidecar = (SOURCE / "data/measured/liver-patch/sidecar.toml").read_text()
            (folder / "sidecar.toml").write_text(sidecar)
            result = command.palpate("import", folder / "sidecar.toml", "--out", folder / "out")
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            self.assertRegex(result.stderr, wanted)

    def test_refusals(self):
        def one_row(rows):
            return [row for row in rows if int(row[0]) < 9]

        def same_place(rows):
            copy = [["63", *row[1:]] for row in rows if row[0] == "20"]
            return rows + copy

        def opposed(rows):
            for row in rows:
                if row[0] == "31":
                    row[5:8] = [str(-float(value)) for value in row[5:8]]

        def not_a_number(rows):
            rows[100][11] = "nan"

        def sideways(rows):
            for row in rows:
                if row[0] == "31":
                    row[5:8] = ["0", "1", "0"]

        self.refused(one_row, r"9 sites lie on one line")
        self.refused(same_place, r"site 20 and site 63 are .* apart")
        self.refused(opposed, r"site 31.*out of the body along its normal")
        self.refused(not_a_number, r"probing.csv:102.*nan|'nan'")
        self.refused(sideways, r"site 31")


if __name__ == "__main__":
    command.PALPATE, SOURCE = sys.argv[1], Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
