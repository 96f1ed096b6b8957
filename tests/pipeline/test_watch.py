#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_watch.py PALPATE LIBPALPATE SOURCE CC CHROMIUM [PICTURE]: `palpate watch` shows a session of `palpate run` in a browser while it runs, as it is,
and whoever watches, reads nothing, or comes and goes a hundred times, no step is lost and no force differs.
PICTURE: where a screenshot goes."""
import contextlib
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from chromium import Chromium  # noqa: E402

PALPATE, RUNTIME, SOURCE, CC, BROWSER = sys.argv[1:6]
PICTURE = sys.argv[6] if len(sys.argv) > 6 else None
LIBRARIES = pathlib.Path(PALPATE).resolve().parent.parent / "share/palpate/libraries"
LIBRARY, LIVER = LIBRARIES / "gel.plib", LIBRARIES / "liver.plib"
RATE = 1000  # Hz


class Watch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.recording = self.root / "recording.h5"

    def start(self, *words, **options):
        process = subprocess.Popen(["stdbuf", "-oL", PALPATE, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   **options)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def session(self, duration, library=LIBRARY):
        """Without a search thread, so that it can be replayed to the bit; a watchdog for a busy machine."""
        return self.start("run", library, "--uncertified", "--rate", RATE, "--duration", duration, "--priority", 0, "--watchdog", 60,
                          "--search-rate", 0, "--out", self.recording)

    def watch(self, library=LIBRARY):
        """The process, and its port."""
        return self.port_of(self.start("watch", library, "--recording", self.recording, "--port", 0, "--no-open"))

    def port_of(self, process):
        line = process.stdout.readline()
        port = re.match(r"watch: http://127\.0\.0\.1:(\d+)/ \(open it in a browser\)", line)
        self.assertTrue(port, line)
        return process, int(port[1])

    def end(self, process):
        process.send_signal(signal.SIGINT)
        said = process.stdout.read()
        self.assertEqual(process.wait(timeout=30), 0, said)
        return said

    def replayed(self):
        """Every step of the recording has the force of the model."""
        said = subprocess.run([PALPATE, "replay", self.recording, "--library", LIBRARY], capture_output=True, text=True, check=False)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_a_browser_sees_the_session_as_it_is(self):
        watch, port = self.watch()
        with Chromium(BROWSER) as page:
            page.open(f"http://127.0.0.1:{port}/")
            page.wait("document.getElementById('live-session').textContent === 'waiting for one to begin'")
            run = self.session(4)
            page.wait("document.getElementById('live-session').textContent.includes('running')")
            page.wait("document.getElementById('live-state').textContent.startsWith('in contact')")
            page.wait("parseFloat(document.getElementById('live-depth').textContent) > 0.5")
            first = page.value("document.querySelector('#live').dataset.shown")
            if PICTURE:
                time.sleep(1)
                page.picture(PICTURE)
            said = run.stdout.read()
            self.assertEqual(run.wait(timeout=60), 0, said)
            page.wait("document.getElementById('live-session').textContent.endsWith('ended')")
            self.assertGreater(int(page.value("document.querySelector('#live').dataset.shown")), int(first))
            shown = page.value("Object.fromEntries([...document.querySelectorAll('#live output')].map((o) => [o.id, o.textContent]))")
            errors = page.value("document.documentElement.dataset.errors")
        with h5py.File(self.recording) as file:
            force = np.linalg.norm(file["step/force"][:], axis=1)
            steps, contact = len(force), int(np.sum(file["step/status"][:] & 1))
        plain = {key: re.sub("[\u202f\u00a0]", " ", text) for key, text in shown.items()}
        digits = lambda text: int(re.sub(r"\D", "", text))  # noqa: E731
        counts = plain["live-steps"].split(",")
        self.assertEqual([digits(count) for count in counts], [steps, contact])
        value, unit = plain["live-largest"].split()
        self.assertAlmostEqual(float(value) * {"N": 1, "mN": 1e-3}[unit] / force.max(), 1, delta=0.006)  # three digits
        self.assertEqual(plain["live-margin"], "never below zero: passive")
        self.assertEqual(errors, "0")
        self.assertIn("a session of", self.end(watch))
        self.replayed()

    def test_the_skin_deforms_where_a_deformation_lies_beside_the_library(self):
        watch, port = self.watch(LIVER)
        with Chromium(BROWSER) as page:
            page.open(f"http://127.0.0.1:{port}/")
            page.wait("document.getElementById('live-session').textContent === 'waiting for one to begin'")
            self.assertIn("the skin as the runtime blends it", page.value("document.getElementById('live').textContent"))
            run = self.session(4, LIVER)
            page.wait("document.querySelector('#live canvas').work.moved > 100")  # points of the skin in a frame
            said = run.stdout.read()
            self.assertEqual(run.wait(timeout=60), 0, said)
            self.assertEqual(page.value("document.documentElement.dataset.errors"), "0")
        self.end(watch)

    def test_the_loop_of_a_program_is_seen_too(self):
        """examples/watched.c through a pipe, with the steps that it printed; damaged text is refused with its line."""
        program = self.root / "watched"
        subprocess.run([CC, "-std=c11", f"-I{SOURCE}/runtime", f"{SOURCE}/examples/watched.c", RUNTIME, "-lm",
                        f"-Wl,-rpath,{pathlib.Path(RUNTIME).parent}", "-o", program], check=True)
        loop = subprocess.Popen([program, LIBRARY, "0", "0", "1", "3"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(loop.stderr.close)
        self.addCleanup(loop.wait)
        watch, port = self.port_of(self.start("watch", LIBRARY, "--stdin", "--port", 0, "--no-open", stdin=loop.stdout))
        loop.stdout.close()
        with Chromium(BROWSER) as page:
            page.open(f"http://127.0.0.1:{port}/")
            page.wait("document.getElementById('live-session').textContent.endsWith('ended')")
            page.wait("document.getElementById('live-steps').textContent.startsWith('3\u202f000,')")
            largest = page.value("document.getElementById('live-largest').textContent")
        self.assertRegex(largest, r"^[1-9][0-9.]*\u00a0mN$")
        self.assertIn("0 not recorded", loop.stderr.read())
        self.end(watch)
        said = subprocess.run([PALPATE, "watch", LIBRARY, "--stdin", "--port", "0", "--no-open"], input="time_ns,x\n", capture_output=True,
                              text=True, check=False)
        self.assertEqual(said.returncode, 2)
        self.assertIn("line 1 of the steps", said.stderr)

    def test_clients_cannot_slow_the_session(self):
        """A watch that is stopped, a client that never reads, a hundred that come and go: the session has every step, in its journal
        as in its recording, none cut off, and the forces of the model."""
        watch, port = self.watch()
        run = self.session(3)
        request = f"GET /steps HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode()
        with contextlib.ExitStack() as clients:
            deaf = clients.enter_context(socket.create_connection(("127.0.0.1", port)))
            deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            deaf.sendall(request)
            for _ in range(100):
                with socket.create_connection(("127.0.0.1", port)) as client:
                    client.sendall(request)
            time.sleep(0.5)
            watch.send_signal(signal.SIGSTOP)
            time.sleep(0.5)
            watch.send_signal(signal.SIGCONT)
            said = run.stdout.read()
        self.assertEqual(run.wait(timeout=60), 0, said)
        steps = int(re.search(r"run: (\d+) steps", said)[1])
        self.assertIn("cut off 0, clamped 0, saturated 0, not recorded 0", said)
        with h5py.File(self.recording) as file:
            self.assertEqual(len(file["step/force"]), steps)
        self.replayed()
        self.assertIn("the session has ended", self.end(watch))

    def test_the_journal_is_only_read(self):
        watch, _ = self.watch()
        run = self.session(600)
        journal = self.recording.with_suffix(".journal")
        opened = None
        for _ in range(600):
            for link in pathlib.Path(f"/proc/{watch.pid}/fd").iterdir():
                with contextlib.suppress(OSError):
                    if link.readlink() == journal:
                        opened = pathlib.Path(f"/proc/{watch.pid}/fdinfo", link.name).read_text()
            if opened:
                break
            time.sleep(0.05)
        flags = int(re.search(r"flags:\s+(\d+)", opened)[1], 8)
        self.assertEqual(flags & 3, 0)  # O_RDONLY
        self.assertNotIn("lock:", opened)
        run.send_signal(signal.SIGINT)
        run.stdout.read()
        self.end(watch)

    def test_what_cannot_be_watched_is_said(self):
        said = subprocess.run([PALPATE, "watch", "kidney"], capture_output=True, text=True, check=False)
        self.assertEqual(said.returncode, 2)
        self.assertIn("gel, liver, tissue", said.stderr)
        _, port = self.watch()
        said = subprocess.run([PALPATE, "watch", LIBRARY, "--port", str(port)], capture_output=True, text=True, check=False)
        self.assertEqual(said.returncode, 2)
        self.assertIn("--port", said.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
