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

    # Changed copies of the records.

    @staticmethod
    def write_changed(folder, change, sidecar=lambda text: text):
        lines = (SOURCE / "data/measured/liver-patch/probing.csv").read_text().splitlines()
        rows = [line.split(",") for line in lines[1:]]
        rows = change(rows) or rows
        (folder / "probing.csv").write_text("\n".join([lines[0], *(",".join(row) for row in rows)]) + "\n")
        text = (SOURCE / "data/measured/liver-patch/sidecar.toml").read_text()
        (folder / "sidecar.toml").write_text(sidecar(text))

    @staticmethod
    def forces_by_contact(out):
        """Samples of each site by its contact point, which names it whatever its vertex is."""
        with h5py.File(out / "body.h5", "r") as file:
            nodes = file["nodes"][()]
        found = {}
        with h5py.File(out / "curves.h5", "r") as file:
            for row, vertex in enumerate(file["site/vertex"][()]):
                path = file["site/first_path"][row]
                first, count = file["path/first_sample"][path], file["path/sample_count"][path]
                found[tuple(nodes[vertex])] = file["sample/force"][first:first + count]
        return found

    def test_a_site_that_cannot_be_used_does_not_take_the_others_with_it(self):
        def three_bad(rows):
            for row in rows:
                if row[0] == "31":  # a normal into the body
                    row[5:8] = [str(-float(value)) for value in row[5:8]]
                if row[0] == "40" and row[1] == "3":  # a tool that goes back, where every sample is kept
                    row[8:11] = next(r for r in rows if r[:2] == ["40", "1"])[8:11]
                if row[0] == "7":  # a force that pulls
                    row[11:14] = [str(-float(value)) for value in row[11:14]]

        with tempfile.TemporaryDirectory() as name:
            folder, out = Path(name), Path(name) / "out"
            self.write_changed(folder, three_bad)
            arguments = ["import", folder / "sidecar.toml", "--out", out]
            result = command.palpate(*arguments)
            self.assertEqual(result.returncode, 4, result.stdout + result.stderr)
            self.assertRegex(result.stdout, r"refused probing.csv, site 7: \S*probing.csv, site 7: the force points out")
            self.assertRegex(result.stdout, r"refused probing.csv, site 31: .* moves out of the body along its normal")
            self.assertRegex(result.stdout, r"refused probing.csv, site 40: .* depth does not increase")
            self.assertIn("import: 3 refused", result.stdout)
            account = json.loads((out / "import.json").read_text())
            self.assertEqual([r["site"] for r in account["refused"]], ["site 7", "site 31", "site 40"])
            self.assertEqual(len(account["records"]), 60)
            whole, rest = self.forces_by_contact(self.out), self.forces_by_contact(out)
            self.assertEqual(len(rest), 60)
            for contact, forces in rest.items():
                np.testing.assert_array_equal(forces, whole[contact])
            self.assertEqual(command.palpate(*arguments, "--allow-refused").returncode, 0)

            # The case is built of the others, and says so as long as nobody left the three out.
            case = self.case.read_text().replace("../measured/liver-patch/", "")
            (folder / "case.toml").write_text(case.replace("../devices", str(SOURCE / "data/devices")))
            for _ in range(2):  # also where everything is up to date
                built = command.palpate("build", folder / "case.toml", "--out", folder / "built")
                self.assertEqual(built.returncode, 4, built.stdout + built.stderr)
            text = (folder / "sidecar.toml").read_text()
            (folder / "sidecar.toml").write_text(text + 'leave_out = ["7", "31", "40"]\n')
            built = command.palpate("build", folder / "case.toml", "--out", folder / "built")
            self.assertEqual(built.returncode, 0, built.stdout + built.stderr)

    def test_what_is_wrong_with_the_whole_batch_writes_nothing(self):
        def unchanged(rows):
            return rows

        def inverted(rows):
            for row in rows:
                row[11:14] = [str(-float(value)) for value in row[11:14]]

        for change, sidecar, wanted in (
            (unchanged, lambda text: text.replace('fz = "fz"', 'fz = "fzz"'), "no column is named 'fzz'"),
            (unchanged, lambda text: text.replace('[columns]', '[columns]\nforce_unit = "kN"'), "kN"),
            (inverted, lambda text: text, "none of the 63 sites can be used, this is the first; check placement.force_is"),
        ):
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                self.write_changed(folder, change, sidecar)
                result = command.palpate("import", folder / "sidecar.toml", "--out", folder / "out")
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertIn(wanted, result.stderr)
                self.assertFalse((folder / "out").exists() and any((folder / "out").iterdir()))

    def refused(self, change, wanted):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.write_changed(folder, change)
            result = command.palpate("import", folder / "sidecar.toml", "--out", folder / "out")
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            self.assertRegex(result.stderr, wanted)

    def test_refusals(self):
        def one_row(rows):
            return [row for row in rows if int(row[0]) < 9]

        def same_place(rows):
            copy = [["63", *row[1:]] for row in rows if row[0] == "20"]
            return rows + copy

        def not_a_number(rows):
            rows[100][11] = "nan"

        def far(rows):
            for row in rows:
                if row[0] == "31":
                    row[2] = str(float(row[2]) + 500)
                    row[8] = str(float(row[8]) + 500)

        self.refused(one_row, r"9 sites lie on one line")
        self.refused(same_place, r"site 20 and site 63 are .* apart")
        self.refused(not_a_number, r"probing.csv:102.*nan|'nan'")
        self.refused(far, r"site 31")


if __name__ == "__main__":
    command.PALPATE, SOURCE = sys.argv[1], Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
