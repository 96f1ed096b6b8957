#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Makes docs/VERIFICATION.md from the rows that the tests of the label `verification` write.

usage: verification_table.py [--check] FOLDER    (FOLDER: build/release/verification)

--check compares with the committed page instead. Problems, quantities, references, kinds, sources
and bounds must be equal. Computed values may differ by a twentieth of their bound, because a solver
that stops at a tolerance depends on processor and compiler to that extent."""
import json
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "docs" / "VERIFICATION.md"
DRIFT = 0.05  # of the bound
ROUNDING = 6e-6  # of six printed digits
HEAD = """# Verification

`scripts/verification_table.py build/release/verification` makes this page from the rows that
`ctest --preset release -L verification` writes.
The last of these tests, `verification_page`, compares the page with the rows.
A test fails when an error exceeds its bound.

The column *compared with* says what the reference is:

| compared with | meaning | independent of the solver |
|---|---|---|
| closed form | a formula of the theory, evaluated in the test | yes |
| theory | a rate or an identity that the theory demands | yes |
| published value | a number printed in a public source | yes |
| recalled value | a number or trend recalled from the literature, not checked against it | yes, if recalled correctly |
| other solver | a program that shares no code with the solver | yes |
| same solver | the same program on another mesh, element or setting | no: it shows consistency |
| calibration | a value that a constant of the solver was chosen to meet | no: it detects changes |
"""


def read_rows(folder):
    """Rows by (problem, quantity)."""
    rows = {}
    for file in sorted(folder.glob("*.jsonl")):
        for line in file.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            key = (row["problem"], row["quantity"])
            if key in rows:
                sys.exit(f"{file}: a second row {key}; remove {folder} and run the tests again")
            rows[key] = row
    if not rows:
        sys.exit(f"{folder}: no rows; run `ctest --preset release -L verification` first")
    return rows


def with_unit(row, value):
    """An error or a bound, with its unit."""
    if row["relative"]:
        return f"{100 * value:.2g} %"
    return f"{value:.2g}" + ("" if row["unit"] == "1" else " " + row["unit"])


def cells_of(row):
    unit = "" if row["unit"] == "1" else " " + row["unit"]
    return (row["quantity"], f"{row['computed']:.6g}{unit}", f"{row['reference']:.6g}{unit}",
            row["kind"], row["source"], with_unit(row, row["error"]), with_unit(row, row["bound"]))


def page_of(rows):
    text = HEAD
    problem = None
    for key in sorted(rows):
        if key[0] != problem:
            problem = key[0]
            text += (f"\n## {problem}\n\n| quantity | computed | reference | compared with | source | error | bound |\n"
                     "|---|---|---|---|---|---|---|\n")
        text += "| " + " | ".join(cells_of(rows[key])) + " |\n"
    return text


def committed_cells():
    cells, problem = {}, None
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            problem = line[3:]
        if problem and line.startswith("| ") and not line.startswith("| quantity"):
            row = line[2:-2].split(" | ")
            cells[(problem, row[0])] = row
    return cells


def differences(rows, committed):
    """One line for each difference between the committed page and the rows."""
    for key in sorted(set(committed) - set(rows)):
        yield f"{key[0]}: {key[1]}: on the page, but no test wrote it"
    for key in sorted(rows):
        row, now = rows[key], cells_of(rows[key])
        where = f"{key[0]}: {key[1]}"
        if key not in committed:
            yield f"{where}: not on the page"
            continue
        page = committed[key]
        for name, column in (("kind", 3), ("source", 4), ("bound", 6)):
            if now[column] != page[column]:
                yield f"{where}: {name} {now[column]}, on the page {page[column]}"
        printed = float(page[1].split()[0])
        allowed = DRIFT * row["bound"] * (abs(row["reference"]) if row["relative"] else 1)
        if abs(printed - row["computed"]) > allowed + ROUNDING * abs(printed):
            yield f"{where}: computed {now[1]}, on the page {page[1]}"
        # A reference may be computed, too.
        printed = float(page[2].split()[0])
        if abs(printed - row["reference"]) > allowed + ROUNDING * abs(printed):
            yield f"{where}: reference {now[2]}, on the page {page[2]}"


def main(arguments):
    check = "--check" in arguments
    folders = [argument for argument in arguments if argument != "--check"]
    if len(folders) != 1:
        sys.exit(__doc__)
    rows = read_rows(Path(folders[0]))
    if not check:
        PAGE.write_text(page_of(rows), encoding="utf-8")
        return 0
    if not PAGE.exists():
        sys.exit(f"{PAGE} is missing; make it: scripts/verification_table.py {folders[0]}")
    found = list(differences(rows, committed_cells()))
    for line in found:
        print(line)
    if found:
        print(f"docs/VERIFICATION.md differs from the rows; make it again: "
              f"scripts/verification_table.py {folders[0]}\n"
              f"(rows of a test that has another name now: remove its file from {folders[0]} first)")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
