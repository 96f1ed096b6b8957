# SPDX-License-Identifier: AGPL-3.0-or-later
"""The command line common to all checks of the sources, and the test that each check can fail."""
import tempfile
from pathlib import Path


def self_test(faults, files, expected):
    """`faults` of a tree of `files` (path: text) must name exactly the places `expected`."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        found = sorted(fault.split(": ", 1)[0] for fault in faults(root))
    if found != expected:
        print(f"self-test: expected {expected}, found {found}")
        return 1
    return 0


def main(arguments, faults, files, expected):
    """[ROOT] | --self-test. `faults(root)` gives lines "place: what is wrong"; exit code 1 when any."""
    if arguments == ["--self-test"]:
        return self_test(faults, files, expected)
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    found = list(faults(root))
    for fault in found:
        print(fault)
    return 1 if found else 0
