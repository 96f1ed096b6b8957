#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_wasm.py <write_steps> <palpate.wasm> <runtime.js> <chromium>

The runtime compiled to WebAssembly repeats, in a browser, what the C interface of this machine computes: every
number of every step, and every vertex of the skin as it is pressed, is the same to the last bit; where the tissue
relaxes, to 1e-12. A library that it cannot read ends in its message.
"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "support"))
from chromium import Chromium  # noqa: E402

WRITER, WASM, RUNTIME, BROWSER = sys.argv[1:5]
COLUMNS = 26  # numbers of a step
DEPTH, OFFSETS = 14, (16, 23, 24, 25)
LARGEST = 300_000  # bytes of palpate.wasm

PAGE = """<!doctype html><html><body><p id="said"></p><script type="module">
%(runtime)s
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const WASM = '%(wasm)s';
const flat = ({ force, status, seen }) => [status, seen.element, ...force, ...seen.contactPoint, ...seen.natural,
  ...seen.normal, seen.depth, seen.lateral, seen.offset, seen.energy, seen.tank, seen.absorbed, ...seen.forceOnBody,
  ...seen.lateralOffset];
function repeat(played) {
  const runtime = new Runtime(bytes(WASM));
  const library = runtime.load(bytes(played.library));
  const state = runtime.state(library, { friction: played.friction });
  const skin = runtime.loadSkin(library, bytes(played.skin));
  const positions = new Float64Array(bytes(played.positions).buffer);
  const out = [];
  const deformed = [];
  for (let i = 0; i < positions.length; i += 3) {
    const step = state.step(positions.subarray(i, i + 3), [0, 0, 0], played.dt);
    out.push(...flat({ ...step, seen: state.observe() }));
    if (i / 3 %% played.between_pictures === 0) deformed.push(...skin.deform(state));
  }
  return { steps: text(out), deformed: text(deformed) };
}
function text(numbers) {
  const result = new Uint8Array(Float64Array.from(numbers).buffer);
  let text = '';
  for (let i = 0; i < result.length; i += 8192) text += String.fromCharCode(...result.subarray(i, i + 8192));
  return btoa(text);
}
function otherSkin(one, other) {
  try {
    const runtime = new Runtime(bytes(WASM));
    runtime.loadSkin(runtime.load(bytes(one.library)), bytes(other.skin));
    return 'accepted';
  } catch (error) {
    return error.message;
  }
}
function refused(library) {
  try {
    const runtime = new Runtime(bytes(WASM));
    runtime.load(library);
    return 'accepted';
  } catch (error) {
    return error.message;
  }
}
function badSettings(played) {
  const runtime = new Runtime(bytes(WASM));
  const library = runtime.load(bytes(played.library));
  try {
    runtime.state(library, { friction: -3, tankCap: -1 });
    return 'accepted';
  } catch (error) {
    return error.message;
  }
}
const said = {};
try {
  const all = %(played)s;
  said.repeated = all.map(repeat);
  said.otherSkin = otherSkin(all[0], all[2]);
  said.garbage = refused(new Uint8Array(100));
  const damaged = bytes(all[0].library);
  damaged[damaged.length >> 1] ^= 1;
  said.damaged = refused(damaged);
  said.settings = badSettings(all[0]);
} catch (error) {
  said.error = String(error.stack);
}
document.getElementById('said').textContent = JSON.stringify(said);
</script></body></html>
"""


class Wasm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        lines = subprocess.run([WRITER], capture_output=True, check=True).stdout.decode().splitlines()
        cls.played = [json.loads(line) for line in lines]
        wasm = base64.b64encode(pathlib.Path(WASM).read_bytes()).decode()
        text = PAGE % {"runtime": pathlib.Path(RUNTIME).read_text(), "wasm": wasm, "played": json.dumps(cls.played)}
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "wasm.html"
            page.write_text(text)
            with Chromium(BROWSER) as browser:
                browser.open(page.as_uri())
                cls.said = browser.said()

    def test_every_step_is_the_same_to_the_last_bit(self):
        self.assertNotIn("error", self.said)
        self.assertEqual(len(self.said["repeated"]), 4)
        for played, repeated in zip(self.played, self.said["repeated"]):
            ours, theirs = base64.b64decode(played["expected"]), base64.b64decode(repeated["steps"])
            numbers = struct.unpack(f"<{len(ours) // 8}d", ours)
            self.assertEqual(len(numbers), COLUMNS * 6000)
            touched = [row for row in range(6000) if int(numbers[COLUMNS * row]) & 1]
            sliding = [row for row in touched if int(numbers[COLUMNS * row]) & 8]
            self.assertGreater(len(touched), 1000, played["name"])  # else there is nothing to compare
            self.assertGreater(len(sliding), 100, played["name"])
            if not played["name"].startswith("relaxing"):
                self.assertEqual(ours, theirs, played["name"])
                continue
            # The decay of a memory in a step, exp(-dt/tau), is of the C library, whose last bit may differ.
            for column in range(COLUMNS):
                one, other = numbers[column::COLUMNS], struct.unpack(f"<{len(theirs) // 8}d", theirs)[column::COLUMNS]
                # Offsets are small differences of lengths: they are measured by the depth of the press.
                scale = max(map(abs, numbers[DEPTH::COLUMNS] if column in OFFSETS else one)) or 1
                self.assertLess(max(abs(a - b) for a, b in zip(one, other)) / scale, 1e-12, (played["name"], column))

    def test_the_skin_is_the_same_to_the_last_bit(self):
        for played, repeated in zip(self.played, self.said["repeated"]):
            ours, theirs = (base64.b64decode(text["deformed"]) for text in (played, repeated))
            count = len(ours) // 8
            at = struct.unpack(f"<{count}d", ours)
            pictures = 6000 // played["between_pictures"]
            vertices = count // pictures
            rest = at[:vertices]  # before the first touch
            moved = [max(abs(a - b) for a, b in zip(at[vertices * k:], rest)) for k in range(pictures)]
            self.assertGreater(max(moved), 0.003, played["name"])  # else there is nothing to compare
            self.assertGreater(len(set(moved)), pictures // 4, played["name"])
            if played["name"].startswith("relaxing"):  # as for the steps
                other = struct.unpack(f"<{count}d", theirs)
                self.assertLess(max(abs(a - b) for a, b in zip(at, other)), 1e-12 * max(moved), played["name"])
            else:
                self.assertEqual(ours, theirs, played["name"])

    def test_the_skin_of_another_library_ends_in_its_message(self):
        self.assertIn("belongs to another library", self.said["otherSkin"])

    def test_an_unreadable_library_ends_in_its_message(self):
        self.assertEqual(self.said["garbage"],
                         "library in memory: is not a flat library (.plib); make it again with 'palpate export runtime'")
        self.assertIn("is damaged", self.said["damaged"])

    def test_refused_settings_end_in_their_message(self):
        self.assertIn("tank_cap finite and not negative", self.said["settings"])

    def test_it_stays_small(self):
        self.assertLess(pathlib.Path(WASM).stat().st_size, LARGEST)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
