#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The nodule of the liver of scripts/demo is felt, and only where it is.

Usage: test_liver.py PALPATE CASE. The case is pressed as it is, but on larger patches and elements and at few sites, once with
the nodule and once with the same tetrahedra all of liver.
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

PALPATE = None
CASE = None
TOP = np.array([-0.075, -0.0961, 1.520])  # m, the point of the surface above the nodule
DEPTH = 0.004  # m, from there to the nodule
RADIUS = 0.012  # m, of the nodule
NEAR, FAR = 0.006, 0.030  # m, from the point above the nodule


def palpate(*arguments):
    result = subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise AssertionError(result.stdout + result.stderr)
    return result.stdout


def replaced(text, **values):
    """The case with other values of keys that occur once."""
    for key, value in values.items():
        text, count = re.subn(rf"^{key} = .*$", f"{key} = {value}", text, flags=re.MULTILINE)
        assert count == 1, key
    return text


def coarse_case(text):
    text = replaced(text, patch_spacing='"11 mm"', element_size='"5.5 mm"', increments=3, lateral_increments=2)
    # Two bands of sites: over the nodule, and as far from it as the press zone reaches.
    zone = re.search(r"^\[\[press\]\].*?(?=^\[)", text, re.MULTILINE | re.DOTALL).group()
    assert "radius = " in zone
    return text.replace('"../', f'"{CASE.parent.parent}/')


class Liver(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        with_nodule = coarse_case(CASE.read_text(encoding="utf-8"))
