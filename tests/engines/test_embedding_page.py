#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_embedding_page.py BUILD SOURCE CMAKE CC CXX MCS: the commands of docs/embedding.md for C, C++, Python and Unity run as they
stand, with the runtime installed under a prefix, and print the force that the page shows. Those for CHAI3D and SOFA are run by
chai3d/run.sh and sofa/run.sh, that for Windows by tests/windows/run.sh."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, CMAKE, CC, CXX, MCS = sys.argv[1:7]
PAGE = pathlib.Path(SOURCE, "docs/embedding.md").read_text()
ELSEWHERE = {"CHAI3D", "SOFA", "Windows"}


def blocks():
    """Section -> its commands."""
    found = {}
    for section in re.split(r"^## ", PAGE, flags=re.M)[1:]:
        commands = re.findall(r"^```sh\n(.*?)^```", section, re.S | re.M)
        if commands:
            found[section.splitlines()[0]] = "".join(commands)
    return found


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.work = pathlib.Path(cls.folder.name, "checkout")
        prefix = pathlib.Path(cls.folder.name, "prefix")
        cls.work.mkdir()
        for name in ("examples", "data"):
            (cls.work / name).symlink_to(pathlib.Path(SOURCE, name))
        for component in ("runtime", "development"):
            subprocess.run([CMAKE, "--install", BUILD, "--component", component, "--prefix", prefix], check=True,
                           stdout=subprocess.DEVNULL)
        folder = next(prefix.rglob("palpate.pc")).parent
        programs = pathlib.Path(cls.folder.name, "bin")
        programs.mkdir()
        for name, program in (("cc", CC), ("cmake", CMAKE), ("python3", sys.executable)):
            (programs / name).symlink_to(program)
        cls.environment = {**os.environ, "PKG_CONFIG_PATH": str(folder), "LD_LIBRARY_PATH": str(folder.parent), "CC": CC, "CXX": CXX,
                           "CMAKE_PREFIX_PATH": str(prefix), "PATH": f"{programs}:{os.environ['PATH']}"}

    def run_section(self, name):
        said = subprocess.run(["bash", "-e", "-c", blocks()[name]], cwd=self.work, env=self.environment, capture_output=True, text=True,
                              timeout=100)
        self.assertEqual(said.returncode, 0, said.stderr + said.stdout)
        return said.stdout.splitlines()[-1]

    def test_the_sections_give_the_force_of_the_page(self):
        shown = re.search(r"^```\n(\(.* deep)\n```", PAGE, re.M)[1]
        for name in blocks():
            if name in ELSEWHERE or (name == "Unity" and MCS.endswith("-NOTFOUND")):
                continue
            with self.subTest(section=name):
                self.assertEqual(self.run_section(name).replace("-0.0000", "0.0000"), shown.replace("-0.0000", "0.0000"))

    def test_no_section_is_left_out(self):
        self.assertEqual(set(blocks()), {"C", "C++", "Python", "Unity"} | ELSEWHERE)

    def test_what_is_run_elsewhere_is_the_command_of_the_page(self):
        for section, script, words in (
                ("CHAI3D", "tests/engines/chai3d/run.sh", ("-S", "examples/chai3d", "-DCHAI3D_DIR=")),
                ("SOFA", "tests/engines/sofa/run.sh", ("-S", "examples/sofa", "-DCMAKE_PREFIX_PATH=")),
                ("Windows", "tests/windows/run.sh", ("--toolchain", "cmake/mingw-w64.cmake", "-DPALPATE_HDF5=OFF", "-DBUILD_TESTING=OFF"))):
            run = pathlib.Path(SOURCE, script).read_text()
            for word in words:
                self.assertIn(word, blocks()[section])
                self.assertIn(word, run)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
