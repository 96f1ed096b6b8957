#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The command behaves as users of a terminal expect.

Usage: test_manners.py PALPATE
"""
import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import CASE, SIZE, block, write_case, write_off  # noqa: E402

PALPATE = None
DONE, INTERNAL, USAGE, GEOMETRY = 0, 1, 2, 3


def palpate(*arguments, **options):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False, **options)


def on_a_terminal(arguments, columns=80, **environment):
    """(exit code, what a terminal of so many columns receives)."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 25, columns, 0, 0))
    variables = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
    process = subprocess.Popen([PALPATE, *map(str, arguments)], stdin=follower, stdout=follower, stderr=follower,
                               env={**variables, "TERM": "xterm", **environment})
    os.close(follower)
    received = b""
    while True:
        try:
            part = os.read(leader, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        received += part
    os.close(leader)
    return process.wait(), received.decode()


class Manners(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.case = write_case(cls.root)
        cls.out = cls.root / "out"
        made = palpate("build", cls.case, "--out", cls.out)
        assert (cls.out / "library.h5").exists(), made.stderr
        cls.printed = made.stdout

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_errors_and_warnings_are_marked_and_leave_the_standard_output_alone(self):
        refused = palpate("build", self.root / "none.toml")
        self.assertEqual((refused.returncode, refused.stdout), (USAGE, ""))
        self.assertTrue(refused.stderr.startswith("error: "), refused.stderr)
        (self.root / "linear").mkdir()
        case = write_case(self.root / "linear", CASE + '[solver]\nelement = "tet4"\n')
        warned = palpate("mesh", case, "--out", self.root / "linear/out")
        self.assertEqual(warned.returncode, DONE, warned.stderr)
        warned = palpate("precompute", case, "--out", self.root / "linear/out")
        self.assertIn("\nwarning: element = \"tet4\"", "\n" + warned.stderr)
        self.assertNotIn("warning:", warned.stdout)

    def test_quiet_prints_nothing_but_warnings(self):
        for arguments in (["--quiet", "certify", self.case], ["certify", self.case, "-q"]):
            quiet = palpate(*arguments, "--out", self.out)
            self.assertEqual((quiet.returncode, quiet.stdout), (DONE, ""), quiet.stderr)

    def test_quiet_leaves_files_errors_and_results_that_were_asked_for(self):
        surface, first = self.root / "block.off", self.root / "quiet.toml"
        for words in (["check", surface, "--unit", "mm"], ["init", surface, "--minutes", 0, "-o", first]):
            quiet = palpate(*words, "-q")
            self.assertEqual((quiet.returncode, quiet.stdout, quiet.stderr), (DONE, "", ""))
        self.assertTrue(first.exists())
        refused = palpate("check", self.root / "none.off", "-q")
        self.assertEqual((refused.returncode, refused.stdout), (USAGE, ""))
        self.assertTrue(refused.stderr.startswith("error: "), refused.stderr)
        inspect = ["inspect", self.out / "body.h5"]
        self.assertEqual(palpate(*inspect, "-q").stdout, palpate(*inspect).stdout)
        self.assertIn("processors", palpate("doctor", "-q").stdout)

    def test_quiet_prints_estimates_rates_and_searches(self):
        """They are printed and nowhere else."""
        for command, words in ((["build", "--estimate"], "estimate: "), (["certify", "--rate", 2000], "certifiable stiffness"),
                               (["certify", "--challenge", 4], "the search confirms the certificate")):
            quiet = palpate(command[0], self.case, *command[1:], "--out", self.out, "-q")
            self.assertEqual((quiet.returncode, quiet.stderr), (DONE, ""))
            self.assertIn(words, quiet.stdout)

    def test_verbose_prints_every_site(self):
        out = self.root / "verbose"
        palpate("mesh", self.case, "--out", out)
        verbose = palpate("precompute", self.case, "--out", out, "-v").stdout
        sites = json.loads(palpate("inspect", out / "curves.h5", "--json").stdout)
        self.assertEqual(len(re.findall(r"^  site \d+: (complete|stopped early|failed)", verbose, re.MULTILINE)),
                         sites["sites"])

    def test_both_spellings_of_the_version(self):
        self.assertEqual(palpate("-V").stdout, palpate("--version").stdout)
        self.assertRegex(palpate("-V").stdout, r"palpate \d+\.\d+\.\d+")

    def test_help_of_a_subcommand(self):
        self.assertEqual(palpate("help", "export", "site").stdout, palpate("export", "site", "--help").stdout)
        self.assertEqual(palpate("help").stdout, palpate("--help").stdout)

    def test_a_mistyped_word_is_answered_with_the_nearest(self):
        for words, answer in ((["biuld"], "'build'"), (["build", "a.toml", "--thread", "2"], "'--threads'"),
                              (["export", "sites"], "'site'"), (["help", "certfy"], "'certify'"),
                              (["init", "a.stl", "--out", "a.toml"], "'--output'")):
            refused = palpate(*words)
            self.assertEqual(refused.returncode, USAGE, refused.stderr)
            self.assertIn(f"the nearest is {answer}", refused.stderr)

    def test_a_word_that_is_like_none_is_answered_with_the_help(self):
        refused = palpate("frobnicate")
        self.assertEqual(refused.returncode, USAGE)
        self.assertNotIn("the nearest", refused.stderr)
        self.assertIn("'palpate help'", refused.stderr)
        refused = palpate("build", "--frobnicate")
        self.assertIn("'palpate help build'", refused.stderr)

    def commands(self, words=()):
        """Each command of more than one part as well, with its help."""
        text = palpate(*words, "--help").stdout
        if words:
            yield list(words), text
        for line in text.split("Subcommands:")[1].splitlines() if "Subcommands:" in text else ():
            if name := re.match(r"  ([a-z]+)( |$)", line):
                yield from self.commands((*words, name[1]))

    def test_examples_are_commands_that_the_parser_takes(self):
        """Tried where none of their files is."""
        tried = 0
        for words, text in self.commands():
            shown = re.split(r"^Examples?:", text, flags=re.MULTILINE)[1]
            for example in ("palpate " + part for part in " ".join(shown.split()).split("palpate ")[1:]):
                arguments = example.split()[1:]
                self.assertEqual(arguments[:len(words)], words, text)
                if not re.search(r"\.(toml|h5|json|journal)\b", example):
                    continue
                with tempfile.TemporaryDirectory() as empty:
                    refused = palpate(*arguments, cwd=empty)
                self.assertNotIn("command line:", refused.stderr, example)
                tried += 1
        self.assertGreater(tried, 25)

    def test_a_surface_in_place_of_a_case(self):
        refused = palpate("build", self.root / "block.off")
        self.assertEqual(refused.returncode, USAGE)
        self.assertIn("is no case", refused.stderr)
        self.assertIn("palpate init", refused.stderr)

    def test_a_folder_of_another_case_is_left_alone(self):
        other = self.root / "other.toml"
        other.write_text(self.case.read_text().replace('name = "block"', 'name = "other"'))
        before = (self.out / "body.h5").read_bytes()
        refused = palpate("mesh", other, "--out", self.out)
        self.assertEqual(refused.returncode, USAGE, refused.stderr)
        self.assertIn("holds the artifacts of case 'block', not of 'other'", refused.stderr)
        self.assertEqual((self.out / "body.h5").read_bytes(), before)

    def test_sites_are_left_out_of_measured_cases_alone(self):
        refused = palpate("compare", "--leave-out", self.case, "--out", self.out)
        self.assertEqual(refused.returncode, USAGE)
        self.assertIn("has no [measured]", refused.stderr)

    def test_positions_are_in_the_unit_of_the_surface(self):
        folder = self.root / "metres"
        folder.mkdir()
        case = write_case(folder, CASE.replace('unit = "mm"', 'unit = "cm"'))
        vertices, triangles = block(SIZE, 5)
        write_off(folder / "block.off", ([[0.1 * x for x in v] for v in vertices], triangles))
        said = palpate("mesh", case, "--out", folder / "out")
        self.assertEqual(said.returncode, DONE, said.stderr)
        self.assertIn("watertight, (0, 0, 0) cm to (5, 5, 2) cm", said.stdout)
        self.assertNotIn(") mm", said.stdout)
        checked = palpate("check", folder / "block.off", "--unit", "cm")
        self.assertNotIn(") mm", checked.stdout + checked.stderr)
        built = palpate("build", case, "--out", folder / "out", "--threads", 2)
        self.assertRegex(built.stdout, r"in triangle \d+ near \([-\d.]+, [-\d.]+, [-\d.]+\) cm")

    def test_an_estimate_writes_nothing_and_is_of_the_size_of_what_is_built(self):
        out = self.root / "estimated"
        said = palpate("build", self.case, "--out", out, "--estimate", "--json", "--threads", 2)
        self.assertEqual(said.returncode, DONE, said.stderr)
        self.assertFalse(out.exists())
        estimate = [e for e in map(json.loads, said.stdout.splitlines()) if e["event"] == "estimate"][0]
        again = palpate("precompute", self.case, "--out", self.out, "--estimate", "--json", "--threads", 2)
        self.assertEqual(again.returncode, DONE, again.stderr)
        inspected = json.loads(palpate("inspect", "--json", self.out / "body.h5").stdout)
        for e in (estimate, json.loads(again.stdout.splitlines()[-1])):
            self.assertEqual(e["nodes"], inspected["nodes"])
            self.assertGreater(e["seconds"], e["set_up_seconds"])
            self.assertGreater(e["memory_bytes"], 1e7)
            size = (self.out / "library.h5").stat().st_size
            self.assertLess(abs(e["library_bytes"] - size), 0.2 * size)
        self.assertIn(f"{estimate['sites']} sites complete", self.printed)

    def test_compare_with_direct_solutions_looks_where_build_writes(self):
        name = re.search(r'^name = "(.*)"', self.case.read_text(encoding="utf-8"), re.MULTILINE).group(1)
        refused = palpate("compare", "--fem", self.case, cwd=self.root)
        self.assertEqual(refused.returncode, USAGE, refused.stderr)
        self.assertIn(f"out/{name}/body.h5: the file does not exist", refused.stderr)
        refused = palpate("compare", "a.h5", "b.h5")
        self.assertEqual(refused.returncode, USAGE)
        self.assertIn("--out is required", refused.stderr)

    def test_a_reader_that_ends_early_ends_nothing_else(self):
        out = self.root / "head"
        line = f'"{PALPATE}" build "{self.case}" --out "{out}" | head -1; exit "${{PIPESTATUS[0]}}"'
        piped = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
        self.assertEqual(piped.returncode, palpate("build", self.case, "--out", self.out).returncode, piped.stderr)
        self.assertEqual(piped.stdout.count("\n"), 1)
        self.assertTrue((out / "library.h5").exists())

    def test_a_full_disk_under_the_standard_output_is_an_error(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run([PALPATE, "inspect", self.out / "library.h5", "--json"], stdout=full,
                                    stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.returncode, INTERNAL)
        self.assertIn("error: standard output: not everything could be written", result.stderr)

    def test_an_interrupted_campaign_says_what_is_kept_and_goes_on(self):
        out = self.root / "interrupted"
        palpate("mesh", self.case, "--out", out)
        process = subprocess.Popen([PALPATE, "precompute", self.case, "--out", out, "--threads", "1", "--json"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for line in process.stdout:
            event = json.loads(line)
            if event.get("event") == "progress" and event["done"] > 0:
                process.send_signal(signal.SIGINT)
                break
        rest, said = process.communicate()
        del rest
        self.assertEqual(process.returncode, -signal.SIGINT)
        kept, total = map(int, re.search(r"interrupted; (\d+) of (\d+) sites are kept in .*: run the same command",
                                         said).groups())
        self.assertGreater(kept, 0)
        again = palpate("precompute", self.case, "--out", out, "--threads", "1")
        self.assertRegex(again.stdout, rf"{kept} finished sites? found|{kept + 1} finished sites? found", again.stderr)
        self.assertLess(kept, total)

    def test_colours_on_terminals_alone(self):
        code, shown = on_a_terminal(["build", "none.toml"])
        self.assertEqual(code, USAGE)
        self.assertIn("\x1b[1;31merror:\x1b[0m none.toml", shown)
        for off in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertIn("error: none.toml", on_a_terminal(["build", "none.toml"], **off)[1])
        self.assertNotIn("\x1b", palpate("build", "none.toml").stderr)

    def test_progress_fits_a_terminal_of_any_width(self):
        for columns in (80, 40):
            out = self.root / f"columns{columns}"
            palpate("mesh", self.case, "--out", out)
            shown = on_a_terminal(["precompute", self.case, "--out", out], columns)[1]
            bars = [bar for line in shown.split("\n") for bar in line.split("\r") if "\x1b[K" in bar]
            self.assertGreater(len(bars), 0, shown)
            for bar in bars:
                self.assertLess(len(bar.replace("\x1b[K", "")), columns, bar)

    def assert_no_line_is_wider(self, shown, columns, what):
        """A digest or a path alone on its line may be wider: it is not broken."""
        for line in re.split(r"\r?\n|\r", re.sub(r"\x1b\[[0-9;]*[mK]", "", shown)):
            if len(line.split()) > 1:
                self.assertLessEqual(len(line), columns, f"{what}: {line}")

    def test_lines_fit_a_terminal_of_any_width(self):
        out = self.root / "narrow"
        slow = ["--rate", "1000", "--device", self.root / "device.toml"]
        palpate("simulate", self.case, "--out", self.out)
        files = [self.out / f"{name}.h5" for name in ("body", "curves", "library", "recording")]
        for columns in (80, 60):
            for words in (["build", self.case, "--out", out], ["fit", self.case, "--out", out],
                          ["certify", self.case, "--out", out], ["certify", self.case, "--out", out, *slow],
                          ["simulate", self.case, "--out", out], ["report", self.case, "--out", out],
                          ["build", self.case, "--out", out / "estimated", "--estimate"],
                          ["check", self.root / "block.off", "--unit", "mm"], ["doctor"],
                          ["init", self.root / "block.off", "--minutes", "0", "-o", self.root / f"first{columns}.toml"],
                          ["biuld"], ["mesh", self.root / "block.off"], *(["inspect", file] for file in files)):
                shown = on_a_terminal(words, columns)[1]
                self.assertGreater(len(shown), 20)
                self.assert_no_line_is_wider(shown, columns, words[0])

    def test_help_fits_eighty_columns(self):
        commands = re.findall(r"^  ([a-z]+) ", palpate("--help").stdout.split("Subcommands:")[1], re.MULTILINE)
        self.assertGreater(len(commands), 20)
        for command in ["", *commands]:
            self.assert_no_line_is_wider(palpate(*command.split(), "--help").stdout, 80, command)

    def test_programs_read_whole_lines(self):
        certified = palpate("certify", self.case, "--out", self.out).stdout.splitlines()
        self.assertGreater(max(map(len, certified)), 80)
        shown = on_a_terminal(["inspect", self.out / "library.h5", "--json"], 40)[1]
        self.assertEqual(json.loads(shown), json.loads(palpate("inspect", self.out / "library.h5", "--json").stdout))

    def test_manual_pages_say_what_help_says(self):
        pages = self.root / "man1"
        self.assertEqual(palpate("manual", pages).returncode, DONE)
        for words in (["build"], ["export", "site"], ["run"]):
            page = pages / f"palpate-{'-'.join(words)}.1"
            shown = subprocess.run(["groff", "-man", "-Tascii", "-ww", "-P-c", "-P-b", "-P-u", page], capture_output=True,
                                   text=True, check=True)
            self.assertEqual(shown.stderr, "")
            for option in re.findall(r"--[a-z][a-z-]+", palpate(*words, "--help").stdout):
                self.assertIn(option, shown.stdout, page)


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main()
