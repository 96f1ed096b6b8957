#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""A session that is killed, or whose disk fills up, keeps what it recorded; a long one takes no memory; some never begin.

Usage: session_test.py PALPATE WRITE_PLATE. Sessions are those of the real command with the simulated device.
"""
import contextlib
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import CASE, DEVICE, write_case  # noqa: E402

PALPATE = None
WRITE_PLATE = None
DONE, INTERNAL, CONFIGURATION, INCOMPLETE = 0, 1, 2, 4
RATE = 1000  # Hz


def palpate(*arguments, **options):
    return subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True, check=False, **options)


def record(payload):
    return struct.pack("<I", len(payload)) + payload + hashlib.sha256(payload).hexdigest().encode()


def errors_of(result):
    """Lines that are not warnings, of which an uncertified session has some."""
    return [line for line in result.stderr.splitlines() if not line.startswith("warning: ")]


class Session(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.library = self.root / "plate.h5"
        subprocess.run([WRITE_PLATE, self.library], check=True)

    def run_arguments(self, out, duration):
        # Without a search thread, so that the session can be replayed to the bit.
        return ["run", self.library, "--uncertified", "--rate", RATE, "--duration", duration, "--priority", 0,
                "--watchdog", 60, "--search-rate", 0, "--out", out]

    def start(self, out, duration=600):
        """A session under way: its process, once it has begun."""
        command = [PALPATE, *map(str, self.run_arguments(out, duration))]
        process = subprocess.Popen(["stdbuf", "-oL", *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        while not (line := process.stdout.readline()).startswith("run: "):
            self.assertTrue(line, "the session did not begin")
        return process

    def wait_for(self, what, happened):
        """Until it happened: a busy machine makes the test longer, not wrong."""
        limit = time.monotonic() + 240
        while not happened():
            self.assertLess(time.monotonic(), limit, f"{what}: not in four minutes")
            time.sleep(0.05)

    def wait_for_steps(self, journal, least):
        """Waits until the journal contains so many steps: a step takes 168 bytes, a record of them 68 more."""
        self.wait_for(f"{least} steps", lambda: journal.exists() and journal.stat().st_size > 170 * least + 4096)
        self.assertGreaterEqual(self.steps_in(journal), least)

    @staticmethod
    def steps_in(journal):
        said = palpate("inspect", journal)
        found = re.search(r"^steps: (\d+)$", said.stdout, re.MULTILINE)
        return int(found.group(1)) if found else 0

    @staticmethod
    def duration_of(journal):
        """Seconds of the session that the journal holds."""
        said = palpate("inspect", "--json", journal)
        return json.loads(said.stdout)["duration"]["value"] if said.returncode == DONE else 0

    def assert_good(self, recording):
        """Whole, sealed, and the motion gives the same forces again."""
        content = recording.read_bytes()
        seal = re.search(rb"\npalpate-sha256:([0-9a-f]{64})\n$", content)
        self.assertTrue(seal, "no seal")
        self.assertEqual(hashlib.sha256(content[: seal.start()]).hexdigest().encode(), seal.group(1))
        replayed = palpate("replay", recording, "--library", self.library)
        self.assertEqual(replayed.returncode, DONE, replayed.stderr)

    def test_killed_it_keeps_all_but_the_last_moment(self):
        out, journal = self.root / "recording.h5", self.root / "recording.journal"
        process = self.start(out)
        begun = time.monotonic()
        self.wait_for_steps(journal, RATE)
        # The journal follows within a second, whenever the machine is not too busy to let it: stop the session dead and look.
        def all_but_the_last_second():
            process.send_signal(signal.SIGSTOP)
            age = time.monotonic() - begun
            if age - self.duration_of(journal) < 1:
                return True
            process.send_signal(signal.SIGCONT)
            return False

        self.wait_for("a journal of all but the last second", all_but_the_last_second)
        before, duration = self.steps_in(journal), self.duration_of(journal)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertFalse(out.exists())
        recovered = palpate("recover", journal)
        self.assertEqual(recovered.returncode, DONE, recovered.stderr)
        self.assertFalse(journal.exists())
        with h5py.File(out) as file:
            self.assertEqual(len(file["step/time"]), before)
            self.assertAlmostEqual(file["step/time"][-1] * 1e-9, duration, delta=1e-3)
            self.assertRegex(sorted(file["provenance"])[-1], "^[0-9]+_recover$")
            self.assertEqual(file.attrs["device"], "simulated")
        self.assert_good(out)

    def test_the_next_session_saves_what_was_left(self):
        out, journal = self.root / "recording.h5", self.root / "recording.journal"
        process = self.start(out)
        self.wait_for_steps(journal, RATE // 2)
        second = palpate(*self.run_arguments(out, 0.2))
        self.assertEqual(second.returncode, CONFIGURATION)
        self.assertIn("still running", second.stderr)
        process.send_signal(signal.SIGKILL)
        process.wait()
        left = self.steps_in(journal)
        after = palpate(*self.run_arguments(out, 0.3))
        self.assertEqual(after.returncode, DONE, after.stderr)
        saved = self.root / "recording.recovered-1.h5"
        self.assertIn(f"recover: {left} steps", after.stdout)
        with h5py.File(saved) as file:
            self.assertEqual(len(file["step/time"]), left)
        self.assert_good(saved)
        self.assert_good(out)
        self.assertFalse(journal.exists())

    def test_ctrl_c_and_sigterm_end_it_whole(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            out = self.root / f"{number}.h5"
            process = self.start(out)
            self.wait_for_steps(self.root / f"{number}.journal", 300)
            process.send_signal(number)
            self.assertEqual(process.wait(timeout=60), DONE)
            self.assert_good(out)
            self.assertFalse((self.root / f"{number}.journal").exists())

    @unittest.skipUnless(os.geteuid() == 0, "mounting a small disk needs root")
    def test_on_a_disk_that_fills_up_it_ends_and_keeps_what_was_written(self):
        disk = self.root / "small"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", disk], check=False).returncode != 0:
            self.skipTest("this system lets nobody mount a disk")
        with contextlib.ExitStack() as cleanup:
            cleanup.callback(subprocess.run, ["umount", "-l", disk], check=True)
            out, journal = disk / "recording.h5", disk / "recording.journal"
            filled = palpate(*self.run_arguments(out, 600), timeout=300)
            self.assertEqual(filled.returncode, INTERNAL, filled.stdout + filled.stderr)
            self.assertEqual(len(errors_of(filled)), 1, filled.stderr)
            self.assertIn("No space left", filled.stderr)
            self.assertIn(f"palpate recover {journal}", filled.stderr)
            self.assertEqual(os.listdir(disk), ["recording.journal"])
            recorded = self.steps_in(journal)
            self.assertGreater(recorded, RATE)
            # Still no room: the journal stays as it is. Elsewhere there is.
            again = palpate("recover", journal)
            self.assertEqual(again.returncode, INTERNAL)
            self.assertIn("space", again.stderr)
            self.assertEqual(self.steps_in(journal), recorded)
            elsewhere = palpate("recover", journal, "--out", self.root / "elsewhere.h5")
            self.assertEqual(elsewhere.returncode, DONE, elsewhere.stderr)
        with h5py.File(self.root / "elsewhere.h5") as file:
            self.assertEqual(len(file["step/time"]), recorded)
        self.assert_good(self.root / "elsewhere.h5")

    def scripted(self, out, press_speed):
        """Arguments of a session of the plate at 20 kHz: the slower the press, the longer it is."""
        case = write_case(self.root, CASE.replace('press_speed = "40 mm/s"',
                                                  f'press_speed = "{press_speed} mm/s"\nrate = "20 kHz"'))
        out.mkdir(exist_ok=True)
        if self.library.parent != out:
            shutil.copy(self.library, out / "library.h5")
        certified = palpate("certify", case, "--out", out)
        self.assertEqual(certified.returncode, DONE, certified.stderr)
        self.library = out / "library.h5"
        return ["simulate", case, "--out", out]

    def test_certified_is_said_of_what_is_and_of_nothing_else(self):
        out = self.root / "out"
        self.scripted(out, 40)
        profile = self.root / "bench.toml"
        profile.write_text(DEVICE.replace("0.5 N s/m", "50 N s/m"), encoding="ascii")
        command = ["run", self.library, "--profile", profile, "--duration", 0.1, "--priority", 0,
                   "--out", self.root / "felt.h5"]
        felt = palpate(*command)
        self.assertEqual(felt.returncode, DONE, felt.stderr)
        self.assertIn("run: certified passive on bench", felt.stdout)
        slippery = palpate(*command, "--friction", 0.9)
        self.assertEqual(slippery.returncode, CONFIGURATION)
        self.assertIn("friction coefficient of 0.9", slippery.stderr)
        profile.write_text(profile.read_text(encoding="ascii").replace('delay = "0 s"\n', ""), encoding="ascii")
        late = palpate(*command)
        self.assertEqual(late.returncode, CONFIGURATION)
        self.assertIn("its delay is unknown", late.stderr)
        accepted = palpate(*command, "--uncertified")
        self.assertEqual(accepted.returncode, DONE, accepted.stderr)
        self.assertIn("no guarantee: bench: its delay is unknown", accepted.stderr)
        self.assertNotIn("certified passive", accepted.stdout)

    def test_an_identified_device_is_certified_by_its_own_profile(self):
        subprocess.run([WRITE_PLATE, self.library, "0.3"], check=True)
        profile = self.root / "measured.toml"
        measure = ["identify", "--watchdog", 60, "--rate", 6000, "--seconds", 9, "--out", profile]
        incomplete = palpate(*measure)
        self.assertEqual(incomplete.returncode, INCOMPLETE, incomplete.stderr)
        self.assertIn("force resolution is left out", incomplete.stderr)
        self.assertNotIn("force_resolution =", profile.read_text(encoding="utf-8"))
        self.assertIn("it exists", palpate(*measure).stderr)
        profile.unlink()
        measured = palpate(*measure, "--force-resolution-mN", 0)
        self.assertEqual(measured.returncode, DONE, measured.stderr)
        values = dict(re.findall(r'^(\w+) = "([0-9.e-]+) ', profile.read_text(encoding="utf-8"), re.MULTILINE))
        # The simulated device: 0.081 N s/m, 0.01 N, the delay of one sample of the loop, no steps.
        self.assertLessEqual(float(values["damping"]), 0.081)
        self.assertGreater(float(values["damping"]), 0.95 * 0.081)
        self.assertLessEqual(float(values["coulomb_friction"]), 0.01)
        self.assertGreater(float(values["coulomb_friction"]), 0.95 * 0.01)
        self.assertAlmostEqual(float(values["delay"]), 1 / 6000, delta=1e-5)
        self.assertLess(float(values["position_resolution"]), 1e-5)  # an upper estimate
        felt = palpate("run", self.library, "--profile", profile, "--rate", 8000, "--watchdog", 60,
                       "--duration", 0.1, "--priority", 0, "--out", self.root / "identified.h5")
        self.assertEqual(felt.returncode, DONE, felt.stderr)
        self.assertIn("run: certified passive on simulated, at 8000 Hz", felt.stdout)

    def test_identify_writes_nothing_when_the_motion_does_not_end_well(self):
        profile = self.root / "never.toml"
        for options, said in ((("--box-mm", 1, "--max-force", 5), "left the box"),
                              (("--max-speed", 0.01), "faster than 0.01 m/s"),
                              (("--seconds", "nan"), "out of range"), (("--axes", ""), "does not name axes"),
                              (("--axes", "xx"), "does not name axes")):
            refused = palpate("identify", "--watchdog", 60, "--out", profile, *options)
            self.assertEqual(refused.returncode, CONFIGURATION, options)
            self.assertIn(said, refused.stderr)
            self.assertFalse(profile.exists())

    def test_a_session_beyond_the_deepest_sample_says_so_and_does_not_flatter(self):
        """The plate is known to 20 mm; its samples end there whatever the script asks for."""
        out = self.root / "out"
        for depth in (12, 30):
            command = self.scripted(out, 40)
            case = Path(command[1])
            case.write_text(case.read_text(encoding="utf-8").replace('press_depth = "1 mm"', f'press_depth = "{depth} mm"'),
                            encoding="utf-8")
            felt = palpate(*command)
            strict = palpate(*command, "--strict")
            self.assertEqual(felt.returncode, DONE, felt.stderr)
            with h5py.File(out / "recording.h5") as file:
                deep = int(np.count_nonzero(file["step/depth"][:] > 0.020))
            shown = json.loads(palpate("inspect", "--json", out / "recording.h5").stdout)
            self.assertEqual(shown["steps_extrapolated_beyond_depth"], deep)
            if depth < 20:
                self.assertEqual((deep, felt.stderr, strict.returncode), (0, "", DONE))
                continue
            self.assertGreater(deep, 1000)
            self.assertEqual(strict.returncode, INCOMPLETE)
            self.assertIn(f"warning: {deep} of {shown['steps_in_contact']} steps in contact went beyond the deepest sample",
                          felt.stderr)
            self.assertIn("every response is known to 20.0 mm", felt.stderr)
            self.assertIn(f"extrapolated beyond the computed depth {deep}", felt.stdout)
            self.assertNotIn("beyond the deepest sample", felt.stdout)

    def test_a_live_session_states_its_steps_beyond_the_deepest_sample(self):
        felt = palpate(*self.run_arguments(self.root / "felt.h5", 1), "--strict")
        self.assertEqual(felt.returncode, DONE, felt.stderr)
        self.assertRegex(felt.stdout, r"steps in contact \d+, extrapolated beyond the computed depth 0\n")
        self.assertNotIn("beyond", felt.stderr)

    def test_a_killed_simulation_keeps_its_steps(self):
        out = self.root / "out"
        command = self.scripted(out, 0.005)
        process = subprocess.Popen([PALPATE, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        self.wait_for_steps(out / "recording.journal", 100_000)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL)
        recovered = palpate("recover", out / "recording.journal")
        self.assertEqual(recovered.returncode, DONE, recovered.stderr)
        self.assert_good(out / "recording.h5")

    def peak(self, *arguments):
        """Exit code and largest resident memory, bytes."""
        pid = os.posix_spawn(PALPATE, [PALPATE, *map(str, arguments)], os.environ,
                             file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
        _, status, usage = os.wait4(pid, 0)
        return os.waitstatus_to_exitcode(status), 1024 * usage.ru_maxrss

    def test_memory_does_not_grow_with_the_session(self):
        """Neither that of recording it nor that of whoever reads it afterwards."""
        out = self.root / "out"
        recording = out / "recording.h5"
        readers = {"replay": ["replay", recording, "--library", out / "library.h5"],
                   "export": ["export", "recording", recording], "inspect": ["inspect", recording]}
        peaks, steps = {name: [] for name in ("simulate", *readers)}, []
        for press_speed in (1, 0.1):
            commands = {"simulate": self.scripted(out, press_speed), **readers}
            for name, command in commands.items():
                code, used = self.peak(*command)
                self.assertEqual(code, DONE, name)
                peaks[name].append(used)
            with h5py.File(recording) as file:
                steps.append(len(file["step/time"]))
        more = 168 * (steps[1] - steps[0])  # bytes of steps
        self.assertGreater(more, 150e6)
        for name, (short, long) in peaks.items():
            self.assertLess(long - short, 0.05 * more, name)
        with open(out / "recording.csv", encoding="ascii") as csv:
            self.assertEqual(sum(1 for _ in csv), 1 + steps[1])

    def test_a_journal_written_as_its_page_says_is_read(self):
        text = lambda s: struct.pack("<I", len(s)) + s.encode()  # noqa: E731
        heading = (text("bench") + text("") + struct.pack("<2d", 500, 0.25)
                   + struct.pack("<7d", 5e-3, 300, 100, 0.5, 0.02, 4, 3) + struct.pack("<3d", 0.1, 0, -0.2)
                   + struct.pack("<B", 1) + struct.pack("<I", 1)
                   + b"".join(map(text, ("run", "0", "abc", "2026-01-31T12:00:00Z", "rate = 500")))
                   + struct.pack("<I", 1) + text("library.h5") + text("f" * 64)
                   + struct.pack("<I", 1) + text("fact") + text("value"))
        steps = [struct.pack("<q12d6diIq", 2_000_000 * i, *(i + 0.01 * np.arange(18)), i - 1, i, 900 + i)
                 for i in range(5)]
        journal = self.root / "by-hand.journal"
        journal.write_bytes(b"palpate.session 1\n" + record(heading) + record(b"".join(steps[:3]))
                            + record(b"".join(steps[3:])) + b"cut short")
        recovered = palpate("recover", journal)
        self.assertEqual(recovered.returncode, DONE, recovered.stderr)
        self.assertIn("9 bytes", recovered.stdout)
        with h5py.File(self.root / "by-hand.h5") as file:
            self.assertEqual(file["step/time"][()].tolist(), [0, 2_000_000, 4_000_000, 6_000_000, 8_000_000])
            self.assertEqual(file["step/position"][2].tolist(), [2.0, 2.01, 2.02])
            self.assertEqual(file["step/absorbed"][4], 4 + 0.01 * 17)
            self.assertEqual(file["step/element"][()].tolist(), [-1, 0, 1, 2, 3])
            self.assertEqual(file["step/latency"][1], 901)
            self.assertEqual(file["settings"].attrs["body_z"], -0.2)
            self.assertEqual(file["settings"].attrs["max_force"], 4)
            self.assertEqual(file["provenance/00_run"].attrs["git_revision"], "abc")
            self.assertEqual(file["provenance/01_recover"].attrs["fact_value"][0], "9")

    def test_what_is_not_certified_or_not_there_is_refused_in_one_line(self):
        listed = palpate("run", "--list")
        self.assertEqual(listed.returncode, DONE)
        devices = re.findall(r"^  ([a-z-]+) ", listed.stdout, re.MULTILINE)
        self.assertEqual(set(devices), {"simulated", "force-dimension", "openhaptics", "haply", "lab"})
        out = self.root / "recording.h5"
        refused = palpate("run", self.library, "--duration", 1, "--out", out)
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("--uncertified", refused.stderr)
        unknown = palpate("run", self.library, "--device", "simulatd", "--out", out)
        self.assertEqual(unknown.returncode, CONFIGURATION)
        self.assertIn("--device: 'simulatd' is not known; the nearest is 'simulated'", unknown.stderr)
        for device, missing in (("force-dimension", "libdhd"), ("openhaptics", "libHD"), ("haply", "localhost")):
            absent = palpate("run", self.library, "--device", device, "--port", 1, "--uncertified", "--out", out)
            self.assertEqual(absent.returncode, CONFIGURATION, device)
            self.assertEqual(len(errors_of(absent)), 1, absent.stderr)
            self.assertIn(missing, absent.stderr)
        self.assertEqual(sorted(os.listdir(self.root)), ["plate.h5"])  # no journal of what never began

    def test_a_damaged_byte_costs_its_record_and_the_journal_is_kept(self):
        """The file is taken apart by its page, not by the program."""
        out, journal = self.root / "recording.h5", self.root / "recording.journal"
        process = self.start(out)
        self.wait_for_steps(journal, 2 * RATE)
        process.send_signal(signal.SIGKILL)
        process.wait()
        content = bytearray(journal.read_bytes())
        starts, at = [], len(b"palpate.session 1\n")
        while at + 68 <= len(content):
            length = struct.unpack_from("<I", content, at)[0]
            starts.append((at, length))
            at += 68 + length
        whole = sum(length // 168 for _, length in starts[1:])
        victim, length = starts[2]
        content[victim + 1000] ^= 4
        journal.write_bytes(content)
        recovered = palpate("recover", journal)
        self.assertEqual(recovered.returncode, 4, recovered.stdout + recovered.stderr)
        self.assertIn(f"lacks {length // 168} steps ({length + 68} bytes at byte {victim})", recovered.stderr)
        kept = self.root / "recording.journal.damaged"
        self.assertEqual(kept.read_bytes(), content)
        self.assertFalse(journal.exists())
        with h5py.File(out) as file:
            self.assertEqual(len(file["step/time"]), whole - length // 168)
            facts = file[f"provenance/{sorted(file['provenance'])[-1]}"].attrs
            self.assertIn("gap", facts["fact_name"])

    def test_options_out_of_range_are_refused_before_anything_is_written(self):
        for option, value in (("--friction", "nan"), ("--friction", "inf"), ("--friction", "1e9"), ("--friction", "-1"),
                              ("--search-rate", "nan"), ("--search-rate", "1e12"), ("--search-rate", "-5"),
                              ("--max-force", "-1"), ("--max-force", "nan"), ("--watchdog", "1e9"), ("--watchdog", "-1"),
                              ("--duration", "nan"), ("--duration", "-1"), ("--ramp", "nan"), ("--rate", "nan"),
                              ("--max-speed", "nan"), ("--at-mm", "nan 0 0"), ("--at-mm", "0 1e300 0")):
            base = ["run", self.library, "--uncertified", "--priority", 0, "--out", self.root / "recording.h5"]
            if option != "--duration":
                base += ["--duration", 0.05]
            refused = palpate(*base, option, *value.split(), timeout=60)
            self.assertEqual(refused.returncode, CONFIGURATION, (option, value, refused.stderr))
            self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)
            self.assertIn(f"error: {option}: ", refused.stderr)
            self.assertEqual(os.listdir(self.root), ["plate.h5"], (option, value))

    def test_a_duration_is_that_of_the_session(self):
        out = self.root / "recording.h5"
        done = palpate(*self.run_arguments(out, 0.5))
        self.assertEqual(done.returncode, DONE, done.stderr)
        missed = int(re.search(r"periods missed (\d+)", done.stdout).group(1))
        with h5py.File(out) as file:
            self.assertEqual(len(file["step/time"]) + missed, 500)

    def test_a_replay_takes_the_words_for_a_library_that_a_session_takes(self):
        out, folder = self.root / "recording.h5", self.root / "folder"
        session = self.run_arguments(out, 0.2)
        session[session.index(self.library)] = "gel"
        done = palpate(*session)
        self.assertEqual(done.returncode, DONE, done.stderr)
        folder.mkdir()
        gel = Path(PALPATE).resolve().parent.parent / "share/palpate/libraries/gel.plib"
        shutil.copy(gel, folder / "library.plib")
        for word in ("gel", gel, folder):
            replayed = palpate("replay", out, "--library", word)
            self.assertEqual(replayed.returncode, DONE, (word, replayed.stderr))
        refused = palpate("replay", out, "--library", "jelly")
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("gel", refused.stderr)  # it has the names
        refused = palpate("replay", out, "--library", "tissue")
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("not the library of the recording", refused.stderr)

    def test_a_fifo_as_library_is_refused_at_once(self):
        fifo = self.root / "fifo.h5"
        os.mkfifo(fifo)
        for command in (["run", fifo], ["inspect", fifo], ["compare", fifo, fifo, "--out", self.root / "out"],
                        ["run", "/dev/zero"], ["run", self.root]):
            refused = palpate(*command, timeout=60)
            self.assertNotEqual(refused.returncode, DONE, command)
            self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)

    def test_recover_overwrites_nothing_it_was_not_told_to(self):
        (self.root / "recording.h5").write_text("an older recording", encoding="ascii")
        journal = self.root / "recording.journal"
        journal.write_bytes(b"palpate.session 1\n")
        refused = palpate("recover", journal)
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("--out", refused.stderr)
        refused = palpate("recover", journal, "--out", self.root / "new.h5")
        self.assertEqual(refused.returncode, CONFIGURATION)
        self.assertIn("no journal", refused.stderr)
        self.assertFalse((self.root / "new.h5").exists())


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    WRITE_PLATE = sys.argv.pop(2)
    PALPATE = sys.argv.pop(1)
    unittest.main()
