#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Makes docs/VERIFICATION.md from the rows that the tests of the label `verification` leave.

usage: verification_table.py [--check] FOLDER    (FOLDER: build/release/verification)

--check compares with the committed page instead. Problems, quantities, references, sources and
bounds must be the same; what was computed may differ by a twentieth of its bound, which other
processors and compilers make of a solver that stops at a tolerance. Rows of a problem that was
skipped on this machine, with its reason, are not missed."""
import json
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "docs" / "VERIFICATION.md"
DRIFT = 0.05  # of the bound
ROUNDING = 6e-6  # of six printed digits
HEAD = """# Verification

Made by `scripts/verification_table.py build/release/verification` from the rows that
`ctest --preset release -L verification` leaves; not written by hand, and held to them by the last of these tests
(`verification_page`). Marks of the sources: [P] printed in a public source, [C] computed for this project
independently of the solver, [R] recalled from the literature. A test fails when an error exceeds its bound.
"""


def read_rows(folder):
    """Rows by (problem, quantity), and the reasons of skipped problems."""
    rows, skipped = {}, {}
    for file in sorted(folder.glob("*.jsonl")):
        for line in file.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            if "skipped" in row:
                skipped[row["problem"]] = row["skipped"]
                continue
            key = (row["problem"], row["quantity"])
            if key in rows:
                sys.exit(f"{file}: a second row {key}; remove {folder} and run the tests again")
            rows[key] = row
    if not rows:
        sys.exit(f"{folder}: no rows; run `ctest --preset release -L verification` first")
    return rows, skipped


def share(row, value):
    """An error or a bound, with its unit."""
    if row["relative"]:
        return f"{100 * value:.2g} %"
    return f"{value:.2g}" + ("" if row["unit"] == "1" else " " + row["unit"])


def cells_of(row):
    unit = "" if row["unit"] == "1" else " " + row["unit"]
    return (row["quantity"], f"{row['computed']:.6g}{unit}", f"{row['reference']:.6g}{unit}",
            row["source"], share(row, row["error"]), share(row, row["bound"]))


def page_of(rows):
    text = HEAD
    problem = None
    for key in sorted(rows):
        if key[0] != problem:
            problem = key[0]
            text += (f"\n## {problem}\n\n| quantity | computed | reference | source | error | bound |\n"
                     "|---|---|---|---|---|---|\n")
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


def differences(rows, skipped, committed):
    """One line for each way in which the committed page is not what the tests give."""
    for key in sorted(set(committed) - set(rows)):
        if key[0] not in skipped:
            yield f"{key[0]}: {key[1]}: on the page, but no test gave it"
    for key in sorted(rows):
        row, now = rows[key], cells_of(rows[key])
        where = f"{key[0]}: {key[1]}"
        if key not in committed:
            yield f"{where}: not on the page"
            continue
        page = committed[key]
        for name, column in (("reference", 2), ("source", 3), ("bound", 5)):
            if now[column] != page[column]:
                yield f"{where}: {name} {now[column]}, on the page {page[column]}"
        printed = float(page[1].split()[0])
        allowed = DRIFT * row["bound"] * (abs(row["reference"]) if row["relative"] else 1)
        if abs(printed - row["computed"]) > allowed + ROUNDING * abs(printed):
            yield f"{where}: computed {now[1]}, on the page {page[1]}"


def main(arguments):
    check = "--check" in arguments
    folders = [argument for argument in arguments if argument != "--check"]
    if len(folders) != 1:
        sys.exit(__doc__)
    rows, skipped = read_rows(Path(folders[0]))
    if not check:
        if skipped:
            sys.exit("not made: " + "; ".join(f"{p} was skipped, {why}" for p, why in skipped.items()))
        PAGE.write_text(page_of(rows), encoding="utf-8")
        return 0
    if not PAGE.exists():
        sys.exit(f"{PAGE} is missing; make it: scripts/verification_table.py {folders[0]}")
    found = list(differences(rows, skipped, committed_cells()))
    for line in found:
        print(line)
    if found:
        print(f"docs/VERIFICATION.md is not what the tests give; make it anew: "
              f"scripts/verification_table.py {folders[0]}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
