# SPDX-License-Identifier: AGPL-3.0-or-later
"""The command that a pipeline test runs; the test sets PALPATE."""
import subprocess

PALPATE = None


def palpate(*arguments):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)


MAY_WARN = ("calibrate", "import")  # of the data that they are given


def output_of(*arguments, may_warn=False):
    """What the command prints, and what it warns of. It must succeed, and warn only where it may."""
    result = palpate(*arguments)
    if result.returncode != 0 or (result.stderr and not may_warn and arguments[0] not in MAY_WARN):
        raise AssertionError(f"{arguments}: {result.stdout}{result.stderr}")
    return result.stdout + result.stderr
