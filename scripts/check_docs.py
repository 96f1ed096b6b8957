#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The Markdown pages are in step with the tree: links lead to files, named files exist, lines are
short (rows of tables excepted), and README's tour shows lines that the commands printed
(docs/tour.txt, which scripts/tour writes).

Usage: check_docs.py [ROOT] | --self-test
"""
import re
import subprocess
import sys
from pathlib import Path

from source_check import main

LONGEST_LINE = 200
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
# Names in backticks that must be those of files somewhere in the tree.
NAMED = re.compile(r"`(?:[\w./-]*/)?((?:test_|bench_)\w+\.(?:cpp|py)|\w+\.(?:hpp|toml|off))`")
TOUR = "docs/tour.txt"


def pages(root):
    listing = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False)
    if listing.returncode == 0:
        names = [Path(name) for name in listing.stdout.decode().split("\0") if name]
    else:
        names = [path.relative_to(root) for path in sorted(root.rglob("*")) if path.is_file()]
    return names


def faults_of_line(root, page, line, known):
    if len(line) > LONGEST_LINE and not line.startswith("|"):
        yield f"{len(line)} characters, at most {LONGEST_LINE}"
    for target in LINK.findall(line):
        if "://" not in target and not (root / page.parent / target).exists():
            yield f"the link {target} leads nowhere"
    for name in NAMED.findall(line):
        if name not in known:
            yield f"there is no file {name}"


def tour_lines(root):
    """Number and text of each line of README's blocks that show commands and their output."""
    shown, fence = [], None
    for number, line in enumerate((root / "README.md").read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("```"):
            fence = line if fence is None else None
        elif fence == "```":
            shown.append((number, line))
    return shown


def faults(root):
    names = pages(root)
    known = {name.name for name in names}
    for page in names:
        if page.suffix != ".md" or not (root / page).is_file():
            continue
        for number, line in enumerate((root / page).read_text(encoding="utf-8").splitlines(), 1):
            for fault in faults_of_line(root, page, line, known):
                yield f"{page}:{number}: {fault}"
    if (root / TOUR).is_file():
        printed = set((root / TOUR).read_text(encoding="utf-8").splitlines())
        for number, line in tour_lines(root):
            if line not in printed:
                yield f"README.md:{number}: not in {TOUR}: {line}"


# The check must see each kind of fault, and nothing in sound files.
SAMPLES = {
    "README.md": "[a](docs/a.md) `test_a.cpp`\n```sh\nls\n```\n```\n$ run\n 1 N\n 2 N\n```\n",
    "docs/a.md": "[b](b.md#c) [web](https://example.org)\n",
    "docs/b.md": "`test_b.cpp`\n" + 201 * "x" + "\n[none](c.md)\n",
    "docs/tour.txt": "$ run\n 1 N\n",
    "tests/test_a.cpp": "\n",
}
FAULTY = ["README.md:8", "docs/b.md:1", "docs/b.md:2", "docs/b.md:3"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))
