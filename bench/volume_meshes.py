#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Which volume meshes of a collection become a body: runs `palpate init` and `palpate mesh` on every file.

Usage: volume_meshes.py PALPATE FOLDER... [--details FILE]

The case is the one that `init` writes, without a change. A copy of an earlier file is left out. Prints one row a folder: files, files of tetrahedra alone,
bodies at the first try, bodies whose boundary was separated where it touches itself, refusals, and the longest time of
the processor. --details has a line a file, with the message of a refusal.
"""
import collections
import pathlib
import subprocess
import tempfile

from surfaces import LIMIT_S, parse_arguments, processor_seconds, without_copies

ENDINGS = (".feb", ".inp", ".mesh", ".msh", ".vtk", ".vtu")
# What `init` says of files that hold no solid of tetrahedra alone: other elements, surfaces, wires, points.
NO_SOLID = ("has no tetrahedra", "has no febio_spec element", "volume elements that are no tetrahedra",
            "the file has volume elements")


def run(arguments):
    """(exit code, output)"""
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=LIMIT_S)
    return done.returncode, (done.stdout + done.stderr).strip()


def mesh(palpate, path, scratch):
    """(outcome, last line of the output) of one file."""
    case = scratch / "body.toml"
    code, output = run([palpate, "init", path, "--output", case])
    if code == 0:
        code, output = run([palpate, "mesh", case, "--out", scratch / "out"])
    last = output.splitlines()[-1] if output else ""
    if code == 0:
        return "separated" if "separated" in output else "body", last
    if any(words in output for words in NO_SOLID):
        return "no solid of tetrahedra", last
    return "refused" if code in (2, 3) else f"exit {code}", last


def outcome_of(palpate, path):
    """(outcome, processor seconds, last line)"""
    start = processor_seconds()
    with tempfile.TemporaryDirectory() as scratch:
        try:
            outcome, last = mesh(palpate, path, pathlib.Path(scratch))
        except subprocess.TimeoutExpired:
            return "over the time limit", LIMIT_S, ""
    return outcome, processor_seconds() - start, last


def main():
    arguments = parse_arguments(__doc__)
    print("| collection | files | of tetrahedra | bodies | of them separated | refused | other | longest, s |")
    print("|---|---|---|---|---|---|---|---|")
    seen = set()
    for folder in arguments.folders:
        files = list(without_copies(sorted(p for p in folder.rglob("*") if p.suffix.lower() in ENDINGS), seen))
        outcomes, longest = collections.Counter(), 0.0
        for path in files:
            outcome, seconds, last = outcome_of(arguments.palpate, path)
            outcomes[outcome] += 1
            longest = max(longest, seconds)
            if arguments.details:
                print(f"{path}\t{outcome}\t{seconds:.1f}\t{last}", file=arguments.details, flush=True)
        solids = len(files) - outcomes["no solid of tetrahedra"]
        bodies = outcomes["body"] + outcomes["separated"]
        print(f"| {folder.name} | {len(files)} | {solids} | {bodies} | {outcomes['separated']} | {outcomes['refused']} | "
              f"{solids - bodies - outcomes['refused']} | {longest:.0f} |", flush=True)


if __name__ == "__main__":
    main()
