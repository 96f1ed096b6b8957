#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Artifacts as another program sees them: h5py against the schema pages and the known content.

usage: file_format_test.py <write_sample_artifacts> <folder of the schema pages>
"""
import functools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM, SCHEMA = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
# Sample files and the kind of artifact that each is.
FILES = {"body": "body", "sprung": "body", "curved": "body", "curves": "curves", "library": "library", "coupled": "library",
         "relaxing": "library", "leaning": "library", "soft": "library", "relaxing_curves": "curves", "recording": "recording"}


def table_rows(page, columns):
    """Rows of the tables of a page that have this many columns and begin with `code`."""
    for line in (SCHEMA / page).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("| `/") and len(cells) == columns:
            yield [cells[0].strip("`")] + cells[1:]


def first_schema(meaning):
    """The sample of a schema has all that the page knows up to that schema."""
    stated = re.match(r"schema (\d)", meaning)
    return int(stated[1]) if stated else 1


MAY_BE_ABSENT = {"/response/normal_mesh_error", "/response/lateral_mesh_error"}


def relaxes(file):
    """A library of schema 6 to 8 says it; curves have the group whatever their schema."""
    if file.attrs["artifact"] == "palpate.curves":
        return "relaxation" in file
    return file.attrs["schema"] == 5 or file.attrs.get("relaxes") == 1


def is_coupled(file):
    return file.attrs.get("coupled") == 1


def leans(file):
    return file.attrs.get("leans") == 1


def has_soft_axes(file):
    return file.attrs.get("soft_axes") == 1


def is_in(file, name, meaning):
    if name in MAY_BE_ABSENT:
        return name in file
    if meaning.startswith("where responses relax") or name.startswith("/relaxation"):
        return relaxes(file)
    if meaning.startswith("where responses are coupled"):
        return is_coupled(file)
    if meaning.startswith("where responses lean"):
        return leans(file)
    if meaning.startswith("where responses have soft axes"):
        return has_soft_axes(file)
    return file.attrs["schema"] >= first_schema(meaning)


def documented_datasets(kind, file):
    return {row[0]: row[1:4] for row in table_rows(f"{kind}.md", 5) if is_in(file, row[0], row[4])}


def documented_attributes(kind, file):
    pages = ("common.md", f"{kind}.md")
    return {row[0]: row[1] for page in pages for row in table_rows(page, 3) if is_in(file, row[0], row[2])}


def datasets_of(file):
    found = {}
    file.visititems(lambda name, item: found.update({"/" + name: item})
                    if isinstance(item, h5py.Dataset) else None)
    return found


def groups_of(file):
    found = {"/": file}
    file.visititems(lambda name, item: found.update({"/" + name: item})
                    if isinstance(item, h5py.Group) else None)
    return found


def type_name(dataset):
    return "text" if h5py.check_string_dtype(dataset.dtype) else dataset.dtype.name


def attribute_type(value):
    if isinstance(value, str):
        return "text"
    if isinstance(value, np.ndarray) and value.dtype == object:
        return "text list"
    return np.asarray(value).dtype.name


class Tokens:
    """The known content: every value on its own, as written by the C++ side without HDF5."""

    def __init__(self, path):
        self.lines = iter(path.read_text().split("\n"))

    def text(self):
        return next(self.lines)

    def numbers(self):
        return [parse(token) for token in self.text().split()]

    def number(self):
        (value,) = self.numbers()
        return value

    def table(self):
        count = int(self.text().rstrip(":"))
        return [self.numbers() for _ in range(count)]


def parse(token):
    return float.fromhex(token) if re.search(r"[xn]", token) else int(token)


def for_each_kind(test):
    """Runs test(self, kind, file) as a subtest for each kind of artifact."""
    @functools.wraps(test)
    def run(self):
        for name, kind in FILES.items():
            with self.subTest(name), h5py.File(self.folder / f"{name}.h5", "r") as file:
                test(self, kind, file)
    return run


class FileFormat(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        subprocess.run([PROGRAM, cls.folder], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @for_each_kind
    def test_every_dataset_has_units_and_description(self, _, file):
        for name, dataset in datasets_of(file).items():
            self.assertIsInstance(dataset.attrs["units"], str, name)
            self.assertGreater(len(dataset.attrs["description"]), 8, name)

    @for_each_kind
    def test_datasets_are_those_of_the_page(self, kind, file):
        self.assertEqual(set(datasets_of(file)), set(documented_datasets(kind, file)))

    @for_each_kind
    def test_types_shapes_and_units_are_those_of_the_page(self, kind, file):
        sizes = {}
        for name, (dtype, shape, units) in documented_datasets(kind, file).items():
            dataset = file[name]
            self.assertEqual(type_name(dataset), dtype, name)
            self.assertEqual(dataset.attrs["units"], units, name)
            letters = [size.strip() for size in shape.strip("()").split(",")]
            self.assertEqual(len(letters), dataset.ndim, name)
            for letter, size in zip(letters, dataset.shape):
                wanted = int(letter) if letter.isdigit() else sizes.setdefault(letter, size)
                self.assertEqual(size, wanted, f"{name}: {letter}")

    @for_each_kind
    def test_attributes_are_those_of_the_page(self, kind, file):
        documented = documented_attributes(kind, file)
        found = {}
        for group, item in groups_of(file).items():
            pattern = re.sub(r"^/provenance/\d\d_\w+$", "/provenance/*", group)
            for name, value in item.attrs.items():
                found[f"{pattern}@{name}"] = attribute_type(value)
        self.assertEqual(found, documented)

    @for_each_kind
    def test_root_says_what_the_file_is(self, kind, file):
        self.assertEqual(file.attrs["artifact"], f"palpate.{kind}")
        page = (SCHEMA / f"{kind}.md").read_text()
        self.assertIn(f"`palpate.{kind}`", page)
        heading = next(line for line in page.splitlines() if line.startswith("# "))
        self.assertRegex(heading, rf"schema .*\b{file.attrs['schema']}\b")
        self.assertRegex(file.attrs["creator"], r"^palpate \d+\.\d+\.\d+ \(.+\)$")

    def test_provenance_is_in_order_and_readable(self):
        with h5py.File(self.folder / "library.h5", "r") as file:
            steps = list(file["provenance"])
            self.assertEqual(steps, ["00_mesh", "01_precompute", "02_fit", "03_certify"])
            step = file["provenance/00_mesh"].attrs
            self.assertIn('name = "Blöckchen"', step["resolved_case"])
            self.assertEqual(list(step["input_name"]), ["skin.off", "skin.off"])
            self.assertEqual(list(step["input_sha256"]), ["a" * 64, "7" * 64])
            self.assertEqual(dict(zip(step["fact_name"], step["fact_value"])),
                             {"CGAL": "5.5", "BLAS kernel": "Haswell", "empty": ""})

    def test_body_values(self):
        for name, schema in (("body", 1), ("sprung", 2), ("curved", 3)):
            with self.subTest(name):
                self.check_body_values(name, schema)

    def check_body_values(self, name, schema):
        known = Tokens(self.folder / f"{name}.txt")
        with h5py.File(self.folder / f"{name}.h5", "r") as file:
            self.assertEqual(file.attrs["schema"], schema)
            self.assertEqual(file.attrs["name"], known.text())
            for name in ("nodes", "tetrahedra"):
                np.testing.assert_array_equal(file[name][()], known.table())
            np.testing.assert_array_equal(file["tetrahedron_region"][()],
                                          np.ravel(known.table()))
            regions = [known.text() for _ in range(int(known.text().rstrip(":")))]
            self.assertEqual(list(file["region_names"].asstr()[()]), regions)
            np.testing.assert_array_equal(file["boundary"][()], known.table())
            for name in ("fixed_nodes", "response/node"):
                np.testing.assert_array_equal(file[name][()], np.ravel(known.table()))
            for name in ("response/inward", "response/triangles"):
                np.testing.assert_array_equal(file[name][()], known.table())
            np.testing.assert_array_equal(file["response/is_site"][()], np.ravel(known.table()))
            springs = known.table()
            self.assertEqual("foundation" in file, len(springs) > 0)
            columns = zip(*springs) if springs else ()
            for name, column in zip(("facet", "normal_stiffness", "tangential_stiffness"), columns):
                np.testing.assert_array_equal(file["foundation"][name][()], column)
            curved = np.array(known.table())
            self.assertEqual("curved_edges" in file, len(curved) > 0)
            if len(curved):
                np.testing.assert_array_equal(file["curved_edges/ends"][()], curved[0::2, :2])
                np.testing.assert_array_equal(file["curved_edges/middle"][()], curved[1::2])

    def test_curves_values(self):
        known = Tokens(self.folder / "curves.txt")
        with h5py.File(self.folder / "curves.h5", "r") as file:
            self.assertEqual(file.attrs["tool_shape"], known.text())
            self.assertEqual(file.attrs["tool_radius"], known.number())
            self.assertEqual(file.attrs["tool_friction"], known.text())
            self.assertEqual(file.attrs["tool_edge_radius"], known.number())
            self.assertEqual(file.attrs["tool_length"], known.number())
            self.assertEqual(file.attrs["depth"], known.number())
            self.assertEqual(file.attrs["lateral_travel"], known.number())
            self.assertEqual(file.attrs["body_sha256"], known.text())
            site, path, sample = ({name: data[()] for name, data in file[group].items()}
                                  for group in ("site", "path", "sample"))
            for i in range(len(site["vertex"])):
                self.assertEqual(site["vertex"][i], known.number())
                self.assertEqual(site["status"][i], known.number())
                self.assertEqual(site["reason"][i].decode(), known.text())
                self.assertEqual(site["cpu_seconds"][i], known.number())
                self.assertEqual(site["path_count"][i], known.number())
                first = site["first_path"][i]
                for j in range(first, first + site["path_count"][i]):
                    self.check_path(known, path, sample, j)

    def check_path(self, known, path, sample, j):
        self.assertEqual(path["kind"][j], known.number())
        self.assertEqual(path["lateral_depth"][j], known.number())
        self.assertEqual(list(path["direction"][j]), known.numbers())
        self.assertEqual(path["sample_count"][j], known.number())
        self.assertEqual(path["repeats"][j], known.number())
        np.testing.assert_equal(path["contact_uncertainty"][j], known.number())
        first = path["first_sample"][j]
        for k in range(first, first + path["sample_count"][j]):
            for name in ("displacement", "force", "strain_energy", "tool_work", "min_jacobian",
                         "penetration", "contact_area", "iterations", "force_scatter",
                         "force_uncertainty", "contact_energy", "tension", "facets_in_contact",
                         "mesh_difference", "mesh_error", "volume_change"):
                np.testing.assert_equal(np.ravel(sample[name][k]), known.numbers(), name)

    def test_library_values(self):
        for name in ("library", "coupled", "relaxing", "leaning", "soft"):
            with self.subTest(name):
                self.check_library_values(name)

    def check_library_values(self, name):
        known = Tokens(self.folder / f"{name}.txt")
        with h5py.File(self.folder / f"{name}.h5", "r") as file:
            coupled = known.number() == 1
            has_lean, has_memory, is_soft = name in ("leaning", "soft"), "relaxation" in file, name == "soft"
            expected = 8 if is_soft else 7 if has_lean and coupled else 6 if has_lean or coupled else 5 if has_memory else 3
            self.assertEqual(file.attrs["schema"], expected)
            self.assertEqual((relaxes(file), is_coupled(file), leans(file), has_soft_axes(file)),
                             (has_memory, coupled, has_lean, is_soft))
            self.assertEqual(file.attrs["name"], known.text())
            self.assertEqual(file.attrs["tool_shape"], known.text())
            self.assertEqual(file.attrs["tool_radius"], known.number())
            for name in ("position", "inward", "triangles"):
                np.testing.assert_array_equal(file["surface"][name][()], known.table())
            response = {name: data[()] for name, data in file["response"].items()}

            def check_curve(which, i, stored):
                rows = slice(*response[f"{which}_offset"][i:i + 2]) if stored else None
                for what in ("knot", "slope"):
                    values = [value for (value,) in known.table()]
                    self.assertEqual(response[f"{which}_{what}"][rows].tolist() if stored else [], values)

            in_order = {vector: iter(response.get(vector, ())) for vector in ("lean", "soft_axis")}
            for i in range(len(response["status"])):
                self.assertEqual(response["status"][i], known.number())
                check_curve("normal", i, True)
                check_curve("lateral", i, True)
                self.assertEqual(response["normal_error"][i], known.number())
                self.assertEqual(response["lateral_error"][i], known.number())
                base = known.number()
                if coupled:
                    self.assertEqual(response["coupling_base"][i], base)
                check_curve("coupling", i, coupled)
                if has_memory:
                    times = len(file["relaxation/time"])
                    row = slice(i * times, (i + 1) * times)
                    stored = response["status"][i] != 2
                    self.assertEqual(response["relaxation_fraction"][row].tolist(),
                                     [known.number() for _ in range(times)] if stored else [0] * times)
                for vector, stored in (("lean", has_lean), ("soft_axis", is_soft)):
                    values = [known.number() for _ in range(3)]
                    if stored:
                        row = next(in_order[vector]).tolist() if response["status"][i] != 2 else [0, 0, 0]
                        self.assertEqual(row, values)
            if has_memory:
                self.assertEqual(file["relaxation/time"][()].tolist(), [known.number() for _ in range(2)])
            certificate = file["certificate"]
            for name in ("friction", "depth", "stick", "slip", "min_lipschitz_bound", "lipschitz_bound", "worst_triangle"):
                self.assertEqual(certificate.attrs[name], known.number())
            self.assertEqual(certificate.attrs["limited_by"], known.text())
            self.assertEqual(certificate.attrs["basis"], known.text())
            for name in ("holes", "interpolated"):
                self.assertEqual(certificate.attrs[name], known.number())
            self.assertEqual(certificate.attrs.get("relaxation_rate", 0), known.number())
            triangle = {name: data[()] for name, data in certificate["triangle"].items()}
            for i in range(len(triangle["stick"])):
                for name in ("stick", "slip", "kappa", "cos_theta", "sliding_passive"):
                    self.assertEqual(triangle[name][i], known.number())

    def test_recording_values(self):
        known = Tokens(self.folder / "recording.txt")
        with h5py.File(self.folder / "recording.h5", "r") as file:
            self.assertEqual(file.attrs["device"], known.text())
            self.assertEqual(file.attrs["library_sha256"], known.text())
            self.assertEqual(file.attrs["rate"], known.number())
            self.assertEqual(file.attrs["friction"], known.number())
            settings = file["settings"].attrs
            for name in ("tank_cap", "lipschitz_bound", "search_rate"):
                self.assertEqual(settings[name], known.number())
            self.assertEqual([settings[f"body_{axis}"] for axis in "xyz"], known.numbers())
            for name in ("guarded", "ramp", "watchdog", "max_force", "max_speed"):
                self.assertEqual(settings[name], known.number())
            names = ("time", "position", "velocity", "force", "contact_point", "depth", "lateral",
                     "offset", "energy", "tank", "absorbed", "element", "status", "latency")
            columns = [file["step"][name][()] for name in names]
            for i in range(len(columns[0])):
                for name, column in zip(names, columns):
                    np.testing.assert_array_equal(np.ravel(column[i]), known.numbers(), name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
