#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""A campaign that is killed, starved of disk or divided gives the bits of one that is not.

Usage: campaign_restart_test.py PALPATE. What is compared is the SHA-256 over all computed curves that
`palpate inspect` prints; processor times are not in it.
"""
import contextlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import write_case  # noqa: E402

PALPATE = None
DONE, INTERNAL, CONFIGURATION, SOME_SITES_FAILED = 0, 1, 2, 4


def palpate(*arguments, **options):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False,
                          **options)


def summary(file):
    result = palpate("inspect", file, "--json")
    assert result.returncode == DONE, result.stderr
    return json.loads(result.stdout)


class Campaign(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.case = write_case(cls.root)
        cls.whole = cls.root / "whole"
        assert palpate("mesh", cls.case, "--out", cls.whole).returncode == DONE
        start = time.monotonic()
        result = palpate("precompute", cls.case, "--out", cls.whole, "--threads", 1)
        cls.seconds = time.monotonic() - start
        assert result.returncode in (DONE, SOME_SITES_FAILED), result.stderr
        cls.code = result.returncode
        cls.expected = summary(cls.whole / "curves.h5")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def fresh(self, name):
        """A folder with the body and nothing else."""
        out = self.root / name
        out.mkdir()
        shutil.copy(self.whole / "body.h5", out)
        return out

    def precompute(self, out, *options, **more):
        return palpate("precompute", self.case, "--out", out, *options, **more)

    def assert_same_bits(self, out):
        self.assertEqual(summary(out / "curves.h5")["content_sha256"], self.expected["content_sha256"])

    def test_threads_do_not_change_the_bits(self):
        out = self.fresh("threads")
        self.assertEqual(self.precompute(out, "--threads", 2).returncode, self.code)
        self.assert_same_bits(out)
        self.assertFalse((out / "curves.journal").exists())

    def test_killed_again_and_again_it_repeats_nothing_that_was_finished(self):
        chance = random.Random(20)
        patience = self.seconds
        for attempt in range(10):
            out = self.fresh(f"killed-{attempt}")
            if self.kill_until_done(out, lambda: chance.uniform(0.1, 0.6) * patience) > 0:
                return self.assert_same_bits(out)
            patience /= 2  # the machine is faster now than when the time was taken
        self.fail("no run was killed before it ended")

    def kill_until_done(self, out, moment):
        """Starts the campaign again and again, killing it at random moments, until it ends. @return the kills."""
        journal = out / "curves.journal"
        saved, kills, stretch = 0, 0, 1.0
        while True:
            run = subprocess.Popen([PALPATE, "precompute", self.case, "--out", out, "--threads", "2"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            # Late enough for some progress once in a while, early enough to kill many times.
            try:
                run.wait(timeout=stretch * moment())
            except subprocess.TimeoutExpired:
                run.send_signal(signal.SIGKILL)
            run.stderr.close()
            run.wait()
            if run.returncode != -signal.SIGKILL:
                self.assertEqual(run.returncode, self.code)
                return kills
            kills += 1
            if (out / "curves.h5").exists():
                return kills  # killed after the result was written, in the last moments of the process
            self.assertLess(kills, 200, "no progress")
            now = summary(journal)["sites_done"] if journal.exists() and journal.stat().st_size > 90 else 0
            self.assertGreaterEqual(now, saved)
            # Sites end in batches: on a machine that has become slower no kill would be late enough for one.
            stretch = 1.0 if now > saved else 1.2 * stretch
            saved = now

    def test_is_found_by_its_name_while_it_runs(self):
        out = self.fresh("named")
        run = subprocess.Popen([PALPATE, "precompute", self.case, "--out", out], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        while not (out / "curves.journal").exists() and run.poll() is None:
            time.sleep(0.001)
        name = Path(f"/proc/{run.pid}/comm").read_text().strip()
        run.kill()
        run.wait()
        self.assertEqual(name, Path(PALPATE).name)

    def test_a_full_disk_ends_in_one_line_and_the_run_can_go_on(self):
        out = self.fresh("full")
        limit = 12000  # bytes a file may have: a few sites of the journal

        def starve():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))

        starved = self.precompute(out, preexec_fn=starve)
        self.assertEqual(starved.returncode, INTERNAL, starved.stdout + starved.stderr)
        self.assertEqual(len(starved.stderr.splitlines()), 1, starved.stderr)
        self.assertIn("curves.journal", starved.stderr)
        self.assertFalse((out / "curves.h5").exists())
        self.assertGreater(summary(out / "curves.journal")["sites_done"], 0)
        self.assertEqual(self.precompute(out).returncode, self.code)
        self.assert_same_bits(out)

    @unittest.skipUnless(os.geteuid() == 0, "mounting a small disk needs root")
    def test_a_small_disk_that_fills_up(self):
        out = self.root / "small"
        out.mkdir()
        kilobytes = 60 + (self.whole / "body.h5").stat().st_size // 1024
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "none", out], check=False)
        if mounted.returncode != 0:
            self.skipTest("this system lets nobody mount a disk")
        with contextlib.ExitStack() as cleanup:
            cleanup.callback(subprocess.run, ["umount", "-l", out], check=True)
            shutil.copy(self.whole / "body.h5", out)
            (out / "ballast").write_bytes(b"\0" * 1024 * 40)
            filled = self.precompute(out)
            self.assertEqual(filled.returncode, INTERNAL, filled.stdout + filled.stderr)
            self.assertIn("space", filled.stderr)
            self.assertFalse((out / "curves.h5").exists())
            (out / "ballast").unlink()
            subprocess.run(["mount", "-o", "remount,size=4m", out], check=True)
            self.assertEqual(self.precompute(out).returncode, self.code)
            self.assert_same_bits(out)

    def test_shards_merge_into_the_bits_of_the_whole(self):
        out = self.fresh("shards")
        for i in (1, 2, 3):
            self.assertIn(self.precompute(out, "--shard", f"{i}/3").returncode, (DONE, SOME_SITES_FAILED))
        self.assertFalse((out / "curves.h5").exists())
        self.assertEqual(palpate("merge", self.case, "--out", out).returncode, self.code)
        self.assert_same_bits(out)
        parts = [out / f"curves.{i}-of-3.h5" for i in (1, 2, 3)]
        self.refuses_a_missing_part(out, parts)
        self.refuses_a_part_given_twice(out, parts)
        self.refuses_a_damaged_part(out, parts)
        self.refuses_parts_of_another_case(out)

    def refused(self, *arguments):
        result = palpate("merge", *arguments)
        self.assertEqual(result.returncode, CONFIGURATION, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1)
        return result.stderr

    def refuses_a_missing_part(self, out, parts):
        self.assertIn("none of the parts", self.refused(self.case, "--out", out, *parts[:2]))

    def refuses_a_part_given_twice(self, out, parts):
        self.assertIn("as well", self.refused(self.case, "--out", out, *parts, parts[0]))

    def refuses_a_damaged_part(self, out, parts):
        bad = out / "damaged.h5"
        content = bytearray(parts[1].read_bytes())
        content[len(content) // 2] ^= 1
        bad.write_bytes(content)
        self.assertIn("damaged.h5", self.refused(self.case, "--out", out, parts[0], bad, parts[2]))

    def refuses_parts_of_another_case(self, out):
        other = self.root / "other.toml"
        other.write_text(self.case.read_text(encoding="utf-8").replace("10 kPa", "11 kPa"), encoding="utf-8")
        self.assertIn("the case has changed", self.refused(other, "--out", out))

    def test_json_events_tell_every_site(self):
        out = self.fresh("json")
        lines = self.precompute(out, "--json").stdout.splitlines()
        events = [json.loads(line) for line in lines]
        self.assertEqual(events[0]["event"], "start")
        self.assertEqual(events[-1]["event"], "end")
        vertices = [e["vertex"] for e in events if e["event"] == "site"]
        self.assertEqual(len(vertices), self.expected["sites"])
        self.assertEqual(len(set(vertices)), len(vertices))

    def test_the_kernel_is_the_fastest_of_the_processor_or_the_users_own_and_told(self):
        flags = Path("/proc/cpuinfo").read_text(encoding="utf-8").split("flags", 2)[1].split("\n")[0].split()
        environment = {k: v for k, v in os.environ.items() if not k.startswith("OPENBLAS_")}
        own = {"avx512vl": "SkylakeX", "avx2": "Haswell"}
        fastest = next((kernel for flag, kernel in own.items() if flag in flags), None)
        for kernel, asked in ((fastest, {}), ("Nehalem", {"OPENBLAS_CORETYPE": "Nehalem"})):
            if kernel is None:  # neither: OpenBLAS itself knows such processors
                continue
            out = self.fresh(f"kernel-{kernel}")
            printed = self.precompute(out, "--shard", "1/16", env=environment | asked).stdout
            self.assertIn(f"BLAS kernel: {kernel}\n", printed)
            step = summary(out / "curves.1-of-16.h5")["provenance"][-1]
            self.assertEqual(step["facts"]["blas_kernel"], kernel)

    def peak(self, out, *options):
        """Exit code and largest resident memory, bytes."""
        pid = os.posix_spawn(PALPATE, [PALPATE, "precompute", str(self.case), "--out", str(out), *options],
                             os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
        _, status, usage = os.wait4(pid, 0)
        return os.waitstatus_to_exitcode(status), 1024 * usage.ru_maxrss

    def test_a_bound_on_the_memory_is_kept_and_changes_no_bits(self):
        out = self.fresh("memory")
        _, free = self.peak(out, "--threads", "2")
        (out / "curves.h5").unlink()
        bound = int(0.9 * free)
        code, used = self.peak(out, "--threads", "2", "--memory", f"{bound}B")
        self.assertEqual(code, self.code)
        self.assertLess(used, bound)
        self.assert_same_bits(out)
        (out / "curves.h5").unlink()
        refused = self.precompute(out, "--memory", "1MB")
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("memory of 1 MB", refused.stderr)

    def test_wrong_shards_are_refused(self):
        out = self.fresh("wrong")
        for text in ("0/3", "4/3", "2", "a/b", "1/3x"):
            result = self.precompute(out, "--shard", text)
            self.assertEqual(result.returncode, CONFIGURATION, text)
            self.assertIn("I/N", result.stderr)


if __name__ == "__main__":
    PALPATE = sys.argv.pop(1)
    unittest.main()
