#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_play.py PALPATE LIBPALPATE CHROMIUM: `palpate play` lists what is ready to be touched, writes its page without a
campaign, shows it where there is a screen, and the page presses with the forces of libpalpate.so on the same file."""
import ctypes
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from chromium import Chromium  # noqa: E402

PALPATE, LIBRARY, BROWSER = sys.argv[1:4]
SHIPPED = pathlib.Path(PALPATE).resolve().parent.parent / "share" / "palpate" / "libraries"
NAMES = ["gel", "liver", "tissue"]

# Presses the stiffest node at the depth that the slider has, drags a little, and gives the steps as CSV. Without a
# screen the browser makes hardly any frames: a timer makes them.
ACT = """
let csv = null;
window.requestAnimationFrame = (f) => setTimeout(() => f(performance.now()), 1000 / 60);
window.Blob = class { constructor(parts) { csv = parts[0]; } };
URL.createObjectURL = () => '';
HTMLAnchorElement.prototype.click = () => {};
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const get = (name) => document.getElementById(name);
addEventListener('load', async () => {
  const said = {};
  try {
    await wait(200);
    get('touch-press').click();
    await wait(600);
    said.title = document.querySelector('h1').textContent;
    said.state = get('touch-state').textContent;
    said.caption = get('touch-caption').textContent;
    for (let i = 0; i < 8; ++i) {
      document.querySelector('#touch canvas').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}));
      await wait(50);
    }
    const moved = () => document.querySelector('#touch canvas').work.moved;
    said.moved = moved();
    for (let i = 0; i < 20; ++i) { await wait(5); said.moved = Math.max(said.moved, moved()); }
    get('touch-csv').click();
    await wait(50);
    said.csv = csv;
  } catch (error) { said.error = String(error.stack); }
  document.body.append(Object.assign(document.createElement('p'), {id: 'said', textContent: JSON.stringify(said)}));
});
"""


def play(*arguments, **environment):
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run([PALPATE, "play", *map(str, arguments)], capture_output=True, text=True, timeout=60,
                          env={**kept, **environment})


def acted(page):
    """What the page said of the act."""
    text = page.read_text()
    cut = text.rindex("</body>")
    page.write_text(f"{text[:cut]}<script>{ACT}</script>{text[cut:]}")
    with Chromium(BROWSER, width=1300, height=900) as browser:
        browser.play(page.as_uri())
        said = browser.said()
        return browser.document(), said


def forces_of_the_runtime(file, positions):
    """Forces on the tool, one step of 1 ms to each position."""
    runtime = ctypes.CDLL(LIBRARY)
    library, state = ctypes.c_void_p(), ctypes.c_void_p()
    three = ctypes.c_double * 3
    assert runtime.palpate_library_load(str(file).encode(), ctypes.byref(library)) == 0
    assert runtime.palpate_state_create(library, None, ctypes.byref(state)) == 0
    force, still, out = three(), three(0, 0, 0), []
    for position in positions:
        runtime.palpate_step(state, three(*position), still, ctypes.c_double(1e-3), force)
        out.append(tuple(force))
    runtime.palpate_state_destroy(state)
    runtime.palpate_library_destroy(library)
    return out


class Play(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_alone_it_lists_what_is_ready(self):
        said = play()
        self.assertEqual(said.returncode, 0, said.stderr)
        listed = [line.split() for line in said.stdout.splitlines()[1:]]
        self.assertEqual([words[0] for words in listed], NAMES)
        self.assertTrue(all(len(words) > 6 for words in listed), said.stdout)  # each says what it is
        self.assertLess(sum(int(words[1]) for words in listed), 1000)  # kB

    def test_a_page_has_the_forces_of_the_runtime(self):
        """To the last bit where the tissue does not relax; where it does, exp of two C libraries may differ by one."""
        for name, error in (("gel", 0), ("liver", 1e-12)):
            page = self.folder / f"{name}.html"
            said = play(name, "--out", page, "--no-open")
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertNotIn("http://", re.sub(r"http://www.w3.org/\S*", "", page.read_text().split('id="data"')[0]))
            shown, touched = acted(page)
            self.assertNotIn("error", touched)
            self.assertIn('data-errors="0"', shown)
            self.assertEqual("relaxes by 0.25 in 50 ms and 0.25 in 600 ms, instantaneous moduli" in shown, name == "liver")
            self.assertEqual((touched["title"], touched["state"]), (name, "in contact, sticking"))
            # The liver comes with its skin and its nodule, the pads do not.
            self.assertEqual("of the solved states, blended by the runtime" in touched["caption"], name == "liver")
            self.assertEqual('"region":"nodule"' in shown, name == "liver")
            self.assertEqual(touched["moved"] > 100, name == "liver")
            names, *rows = (line.split(",") for line in touched["csv"].strip().split("\n"))
            rows = [dict(zip(names, map(float, row))) for row in rows]
            self.assertTrue(any(row["lateral_m"] > 0 for row in rows))
            ours = forces_of_the_runtime(SHIPPED / f"{name}.plib", [[row[f"{a}_m"] for a in "xyz"] for row in rows])
            largest = max(max(map(abs, force)) for force in ours)
            self.assertGreater(largest, 0.02)
            for row, force in zip(rows, ours):
                for axis, value in zip("xyz", force):
                    self.assertLessEqual(abs(row[f"force_{axis}_N"] - value), error * largest)

    def test_the_page_is_shown_where_there_is_a_screen(self):
        opened = self.folder / "opened"
        browser = self.folder / "xdg-open"
        browser.write_text(f'#!/bin/sh\necho "$1" > {opened}.part && mv {opened}.part {opened}\n')
        browser.chmod(0o755)
        path = f"{self.folder}:{os.environ['PATH']}"
        page = self.folder / "cache" / "palpate" / "gel.html"
        said = play("gel", PATH=path, XDG_CACHE_HOME=str(self.folder / "cache"))
        self.assertEqual((said.returncode, said.stdout), (0, f"play: {page} (open it in a browser)\n"), said.stderr)
        self.assertGreater(page.stat().st_size, 100_000)
        said = play("gel", PATH=path, XDG_CACHE_HOME=str(self.folder / "cache"), DISPLAY=":0")
        self.assertEqual((said.returncode, said.stdout), (0, f"play: {page}\n"), said.stderr)
        for _ in range(100):
            if opened.exists():
                break
            time.sleep(0.05)
        self.assertEqual(opened.read_text().strip(), str(page))
        opened.unlink()
        play("gel", "--no-open", PATH=path, XDG_CACHE_HOME=str(self.folder / "cache"), DISPLAY=":0")
        time.sleep(0.2)
        self.assertFalse(opened.exists())

    def test_a_file_or_a_folder_is_a_library_too(self):
        (self.folder / "library.plib").write_bytes((SHIPPED / "gel.plib").read_bytes())
        for word in (self.folder, self.folder / "library.plib"):
            page = self.folder / "page.html"
            said = play(word, "--out", page)
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertIn("<title>gel</title>", page.read_text())
            page.unlink()

    def test_what_is_no_library_is_refused(self):
        said = play("kidney")
        self.assertEqual(said.returncode, 2)
        self.assertIn("gel, liver, tissue", said.stderr)
        empty = self.folder / "empty"
        empty.mkdir()
        said = play(empty)
        self.assertEqual(said.returncode, 2)
        self.assertIn("neither library.h5 nor library.plib", said.stderr)

    def test_for_a_device_it_names_the_command(self):
        said = play("gel", "--device", "force-dimension")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn(f"palpate run {SHIPPED / 'gel.plib'} --device force-dimension", said.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
