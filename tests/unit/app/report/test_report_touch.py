#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_report_touch.py <write_sample_report> <touch_forces> <chromium>

Presses the body of a report in a browser as a reader would, and compares the forces of the page with those of the C
interface for the same motion, with the curve of the node, and with the laws of friction and energy. Then the pictures:
scale bar, supports, the session in time, and what can be taken along.
"""
import base64
import csv
import io
import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "support"))
from chromium import Chromium  # noqa: E402

WRITER, FORCES, BROWSER = sys.argv[1:4]

# Helpers of the acts. `csv` is what the page gives to download. Without a screen the browser makes hardly any frames:
# a timer makes them, 60 in a second of the page's own time. Pictures are encoded at once: the browser's own thread does
# it in real time, which the page's time can outrun.
ACT = """
let csv = null;
const BrowserBlob = window.Blob;
HTMLCanvasElement.prototype.toBlob = function (take, kind) {
  const [, type, base64] = this.toDataURL(kind).match(/^data:(.*?);base64,(.*)$/);
  take(new BrowserBlob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], {type}));
};
window.requestAnimationFrame = (f) => setTimeout(() => f(performance.now()), 1000 / 60);
window.Blob = class { constructor(parts) { csv = parts[0]; } };
URL.createObjectURL = () => '';
HTMLAnchorElement.prototype.click = () => {};
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const frames = async (n) => { for (let i = 0; i < n; ++i) await new Promise(requestAnimationFrame); };
const rest = async () => { do await frames(1); while (get('touch').dataset.moving === 'true'); };
const get = (name) => document.getElementById(name);
const canvas = () => document.querySelector('#touch canvas');
const press = () => get('touch-press').click();
const read = () => Object.fromEntries(['state', 'depth', 'normal', 'lateral', 'used', 'margin', 'set'].map((k) => [k, get(`touch-${k}`).textContent]));
const pointer = (type, right, down, pointerId = 1) => {
  const box = canvas().getBoundingClientRect();
  canvas().setPointerCapture = () => {};
  canvas().dispatchEvent(new PointerEvent(type, {clientX: box.left + right * box.width, clientY: box.top + down * box.height, pointerId, button: 0, bubbles: true}));
};
const key = (name, more) => canvas().dispatchEvent(new KeyboardEvent('keydown', {key: name, ...more}));
const steps = async () => { get('touch-csv').click(); await wait(50); return csv; };
const taken = (button) => { get(button).click(); return csv; };  // at once: between two frames
const goTo = (node) => { get('touch-node').value = node; get('touch-node').dispatchEvent(new Event('change')); };
const deep = (part) => { const slider = document.querySelector('#touch input[type=range]'); slider.value = part; slider.dispatchEvent(new Event('input')); };
addEventListener('load', async () => {
  const said = {};
  try {
    await wait(200);
    await (async () => { %s })();
  } catch (error) { said.error = String(error.stack); }
  document.body.append(Object.assign(document.createElement('p'), {id: 'said', hidden: true, textContent: JSON.stringify(said)}));
});
"""


def column(value, code):
    raw = base64.b64decode(next(iter(value.values())))
    return struct.unpack(f"<{len(raw) // struct.calcsize(code)}{code}", raw)


def curve_force(data, node, depth):
    """Integral of the piecewise linear slope of the stored curve."""
    offset = column(data["normal"]["offset"], "I")
    knot, slope = (column(data["normal"][k], "f")[offset[node]:offset[node + 1]] for k in ("knot", "slope"))
    force = 0.0
    for x0, x1, s0, s1 in zip(knot, knot[1:], slope, slope[1:]):
        end = min(depth, x1)
        if end > x0:
            force += (end - x0) * (s0 + s0 + (s1 - s0) * (end - x0) / (x1 - x0)) / 2
    return force


def rows_of(text):
    lines = text.strip().split("\n")
    names = lines[0].split(",")
    return [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]


def newtons(text):
    number, unit = text.split("\u00a0")
    return float(number.replace("\u202f", "")) * {"N": 1, "mN": 1e-3, "\u00b5N": 1e-6}[unit]


def by_the_c_interface(arguments, lines=""):
    """Forces of the steps, and the vertices of the skin after the last."""
    out = subprocess.run([FORCES, *arguments], input=lines.encode(), capture_output=True, check=True).stdout.decode()
    return [[tuple(map(float, line.split())) for line in part.splitlines()] for part in out.split("skin\n")]


def read_obj(text):
    rows = [line.split() for line in text.splitlines()]
    return ([tuple(map(float, r[1:])) for r in rows if r[0] == "v"], [tuple(map(int, r[1:])) for r in rows if r[0] == "f"])


class Acted(unittest.TestCase):
    """Opens the sample report, acts on it, and returns what the act said."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        subprocess.run([WRITER, cls.path], check=True)
        cls.text = (cls.path / "full.html").read_text()
        cls.data = json.loads(re.search(r'id="data">(.*?)</script>', cls.text, re.S)[1])
        cls.browser = Chromium(BROWSER, "--hide-scrollbars", width=1300, height=900)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    def act(self, script, text=None, only="touch"):
        text = text or self.text
        cut = text.rindex("</body>")
        page = self.path / "acted.html"
        page.write_text(f"{text[:cut]}<script>{ACT % script}</script>{text[cut:]}")
        self.browser.play(page.as_uri() + (f"?only={only}" if only else ""))
        said = self.browser.said()
        self.assertNotIn("error", said)
        self.assertEqual(self.browser.value("document.documentElement.dataset.errors"), "0")
        return said


class Touch(Acted):
    def forces_of_the_c_interface(self, rows):
        lines = "".join(f"{r['x_m']!r} {r['y_m']!r} {r['z_m']!r}\n" for r in rows)
        return by_the_c_interface([], lines)[0]

    def check_against_the_c_interface(self, rows):
        ours = [(r["force_x_N"], r["force_y_N"], r["force_z_N"]) for r in rows]
        self.assertEqual(ours, self.forces_of_the_c_interface(rows))  # to the last bit

    def test_a_press_at_a_node_gives_the_force_of_its_curve(self):
        node = self.data["chosen"]["median"]
        said = self.act(f"goTo({node}); deep(0.5); press(); await rest(); said.at = read(); said.csv = await steps();"
                        "press(); await rest(); said.after = read();")
        rows = rows_of(said["csv"])
        depth = rows[-1]["depth_m"]
        # The depth counts from the first step inside: what the tip travels in one step, 1/250 of the whole, is lost.
        self.assertLess(depth, 0.5 * self.data["key"]["depth"])
        self.assertGreater(depth, (0.5 - 1 / 250) * self.data["key"]["depth"])
        self.assertEqual(said["at"]["state"], "in contact, sticking")
        force = curve_force(self.data, node, depth)
        self.assertGreater(force, 0)
        self.assertAlmostEqual(newtons(said["at"]["normal"]) / force, 1, delta=0.005)  # three digits are shown
        size = math.hypot(*(rows[-1][f"force_{axis}_N"] for axis in "xyz"))
        self.assertAlmostEqual(size / force, 1, delta=1e-5)  # the data of the page are of single precision
        self.assertEqual(said["after"]["state"], "no contact")
        self.check_against_the_c_interface(rows)

    def test_a_drag_slides_within_the_cone_and_passively(self):
        said = self.act("""deep(0.6); pointer('pointerdown', 0.5, 0.5); await rest();
            for (let i = 0; i <= 20; ++i) { pointer('pointermove', 0.5 + 0.009 * i, 0.5 - 0.0045 * i); await frames(3); }
            said.at = read(); await rest(); pointer('pointerup', 0.68, 0.41); await rest(); said.csv = await steps();""")
        rows = rows_of(said["csv"])
        contact = [r for r in rows if int(r["status"]) & 1]
        slid = [r for r in contact if int(r["status"]) & 8]
        self.assertGreater(len(contact), 1000)
        self.assertGreater(len(slid), 100)
        travel = math.dist(*((r["x_m"], r["y_m"], r["z_m"]) for r in (contact[0], contact[-1])))
        self.assertGreater(travel, self.data["key"]["tool_radius"])
        self.assertGreater(max(r["lateral_m"] for r in contact), 1e-4)
        used = float(said["at"]["used"].split("\u00a0")[0])
        self.assertGreater(used, 10)
        self.assertLess(used, 101)
        for r in rows:
            self.assertGreaterEqual(r["absorbed_J"] - r["energy_J"] - r["tank_J"], -1e-12)
        self.assertTrue(said["at"]["margin"].endswith("passive"))
        self.check_against_the_c_interface(rows)

    def test_a_second_finger_does_not_move_the_tool(self):
        said = self.act("""pointer('pointerdown', 0.5, 0.5); await rest(); pointer('pointerdown', 0.3, 0.5, 2);
            pointer('pointermove', 0.3, 0.5, 2); await rest(); said.at = read(); pointer('pointerup', 0.3, 0.5, 2); await rest();
            said.after = read(); pointer('pointerup', 0.5, 0.5); await rest(); said.lifted = read();""")
        self.assertEqual(said["at"]["state"], "in contact, sticking")
        self.assertEqual(said["at"], said["after"])
        self.assertEqual(said["lifted"]["state"], "no contact")

    def test_the_wheel_changes_the_depth_of_a_press_only(self):
        said = self.act("""const wheel = () => canvas().dispatchEvent(new WheelEvent('wheel', {deltaY: -100, cancelable: true}));
            said.free = wheel(); said.before = read().set;
            pointer('pointerdown', 0.5, 0.5); await wait(100); said.pressed = wheel(); said.after = read().set;""")
        self.assertTrue(said["free"])      # the page scrolls
        self.assertFalse(said["pressed"])
        self.assertGreater(float(said["after"].split("\u00a0")[0]), float(said["before"].split("\u00a0")[0]))

    def test_the_keyboard_does_all_that_the_pointer_does(self):
        said = self.act("""key(' '); await rest(); said.pressed = read();
            key('PageDown'); key('PageDown'); await rest(); said.deeper = read();
            for (let i = 0; i < 12; ++i) { key('ArrowRight'); await frames(2); }
            await rest(); said.slid = read(); said.csv = await steps(); key(' '); await rest(); said.lifted = read();""")
        self.assertEqual(said["pressed"]["state"], "in contact, sticking")
        self.assertGreater(newtons(said["deeper"]["normal"]), 1.05 * newtons(said["pressed"]["normal"]))
        self.assertGreater(newtons(said["slid"]["lateral"]), 0)
        self.assertTrue(any(int(r["status"]) & 8 for r in rows_of(said["csv"])))
        self.assertEqual(said["lifted"]["state"], "no contact")

    def test_a_drag_beside_the_body_turns_it(self):
        said = self.act("""pointer('pointerdown', 0.02, 0.02); await wait(300); said.state = read().state;
            const before = canvas().toDataURL(); pointer('pointermove', 0.3, 0.1); pointer('pointerup', 0.3, 0.1);
            said.turned = canvas().toDataURL() !== before; said.csv = await steps();""")
        self.assertEqual(said["state"], "no contact")
        self.assertTrue(said["turned"])
        self.assertEqual(rows_of(said["csv"]), [])

    def test_without_the_toolchain_the_page_says_so(self):
        data = dict(self.data, touch=None)
        text = re.sub(r'(id="data">).*?(</script>)', lambda m: m[1] + json.dumps(data) + m[2], self.text, flags=re.S)
        said = self.act("said.text = document.getElementById('touch').innerText;", text)
        self.assertIn("built without the WebAssembly toolchain", said["text"])
        self.assertIn("scripts/setup", said["text"])


class Skin(Acted):
    PRESS_AND_DRAG = """deep(0.6); said.rest = taken('touch-obj'); pointer('pointerdown', 0.5, 0.5); await rest();
            for (let i = 0; i <= 20; ++i) { pointer('pointermove', 0.5 + 0.009 * i, 0.5 - 0.0045 * i); await frames(3); }
            said.csv = taken('touch-csv'); said.skin = taken('touch-obj');
            pointer('pointerup', 0.68, 0.41); await rest(); said.lifted = taken('touch-obj');"""

    def page(self, name):
        return (self.path / name).read_text()

    def test_a_press_and_a_drag_deform_the_skin_as_the_c_interface_does(self):
        said = self.act(self.PRESS_AND_DRAG, self.page("skin.html"))
        rows = rows_of(said["csv"])
        self.assertTrue(any(int(r["status"]) & 8 for r in rows))
        lines = "".join(f"{r['x_m']!r} {r['y_m']!r} {r['z_m']!r}\n" for r in rows)
        forces, skin = by_the_c_interface([], lines)
        self.assertTrue([(r["force_x_N"], r["force_y_N"], r["force_z_N"]) for r in rows] == forces)
        shown, facets = read_obj(said["skin"])
        self.assertTrue(shown == skin)  # to the last bit
        rest = read_obj(said["rest"])[0]
        self.assertTrue(read_obj(said["lifted"])[0] == rest)
        depth = rows[-1]["depth_m"]
        self.assertGreater(max(math.dist(a, b) for a, b in zip(shown, rest)), 0.8 * depth)
        # The skin is watertight: each edge has a facet on either side.
        edges = [(f[i], f[(i + 1) % 3]) for f in facets for i in range(3)]
        self.assertTrue(set(edges) == {(b, a) for a, b in edges})
        self.assertEqual(len(edges), len(set(edges)))

    def test_the_picture_moves_where_the_skin_does(self):
        """A press moves the skin of the whole body a little; an imprint ends at the tool."""
        act = """deep(1); const shot = () => { const c = canvas(); return c.getContext('2d').getImageData(0, 0, c.width, c.height); };
            goTo(NODE); const before = shot(); press(); await rest(); await frames(2); const after = shot();
            const { width, height, data } = before; let moved = 0;
            for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
              if (Math.hypot(x - width / 2, y - height / 2) < 0.3 * width) continue;
              const i = 4 * (y * width + x); moved += Math.abs(data[i + 3] - after.data[i + 3]) > 100; }
            said.moved = moved;"""
        act = act.replace("NODE", str(self.data["chosen"]["stiffest"]))
        self.assertGreater(self.act(act, self.page("skin.html"))["moved"], 200)
        self.assertEqual(self.act(act)["moved"], 0)

    def test_a_session_shows_the_skin_in_time(self):
        """The contact is made anew from the recorded point and tip, which are of single precision."""
        said = self.act("""const at = (time) => { const s = get('scrub'); s.value = time; s.dispatchEvent(new Event('input'));
              return [get('scrub-text').textContent, taken('scrub-obj')]; };
            said.pressed = at(0.75); said.sliding = at(1.1); said.free = at(2.2);""", self.page("skin.html"), only="session")
        rest = read_obj(said["free"][1])[0]
        for name in ("pressed", "sliding"):
            text, skin = said[name]
            step = round(1000 * float(text.split("\u00a0")[0]))
            ours = by_the_c_interface(["session", str(step + 1)])[1]
            shown = read_obj(skin)[0]
            self.assertGreater(max(math.dist(a, b) for a, b in zip(shown, rest)), 0.002, name)
            self.assertLess(max(math.dist(a, b) for a, b in zip(shown, ours)), 2e-6, name)

    def test_without_its_skin_the_page_says_why(self):
        caption = "said.text = get('touch-caption').textContent; said.obj = get('touch-obj') !== null;"
        for page, words in (("full.html", "depths = 4 in [deformation]"), ("skin-other.html", "is of another library"),
                            ("skin.html", "of the solved states")):
            said = self.act(caption, self.page(page))
            self.assertIn(words, said["text"])
            self.assertEqual(said["obj"], page == "skin.html")

    def test_the_page_of_a_library_with_its_body_deforms_its_skin(self):
        said = self.act(self.PRESS_AND_DRAG, self.page("play-skin.html"), only=None)
        lines = "".join(f"{r['x_m']!r} {r['y_m']!r} {r['z_m']!r}\n" for r in rows_of(said["csv"]))
        self.assertTrue(read_obj(said["skin"])[0] == by_the_c_interface([], lines)[1])

    def test_the_page_of_a_library_with_its_surface_deforms_that(self):
        """The skin of the response vertices alone is the fine one at these vertices."""
        press = f"""goTo({self.data["chosen"]["median"]}); deep(0.6); said.rest = taken('touch-obj'); press(); await rest();
            said.csv = taken('touch-csv'); said.skin = taken('touch-obj'); said.text = get('touch-caption').textContent;"""
        said = self.act(press, self.page("play-surface.html"), only=None)
        self.assertIn("of the solved states", said["text"])
        rows = rows_of(said["csv"])
        fine = by_the_c_interface([], "".join(f"{r['x_m']!r} {r['y_m']!r} {r['z_m']!r}\n" for r in rows))[1]
        fine_rest = read_obj(self.act("said.rest = taken('touch-obj');", self.page("skin.html"))["rest"])[0]
        row = {x: w for w, x in enumerate(fine_rest)}
        depth, rest, skin = rows[-1]["depth_m"], read_obj(said["rest"])[0], read_obj(said["skin"])[0]
        self.assertEqual(len(rest), len(column(self.data["vertices"]["response_status"], "B")))
        self.assertGreater(max(math.dist(a, b) for a, b in zip(skin, rest)), 0.99 * depth)
        # Which side a vertex faces hangs on the facets around it: at the rim of the dimple that is not quite the same.
        self.assertLess(max(math.dist(x, fine[row[x_rest]]) for x, x_rest in zip(skin, rest)), 1e-3 * depth)

    def test_a_library_alone_is_pressed_with_the_same_forces(self):
        said = self.act(f"goTo({self.data['chosen']['median']}); deep(0.5); press(); await rest(); said.csv = taken('touch-csv');"
                        "said.text = get('touch-caption').textContent;", self.page("play.html"), only=None)
        rows = rows_of(said["csv"])
        self.assertTrue(int(rows[-1]["status"]) & 1)
        lines = "".join(f"{r['x_m']!r} {r['y_m']!r} {r['z_m']!r}\n" for r in rows)
        self.assertTrue([(r["force_x_N"], r["force_y_N"], r["force_z_N"]) for r in rows] == by_the_c_interface([], lines)[0])
        self.assertIn("imprint", said["text"])

    COUNT = """const made = {room: 0, layouts: 0};
            for (const name of ['Float32Array', 'Float64Array', 'Uint32Array', 'Int32Array', 'ImageData']) window[name] = new Proxy(window[name], {
              construct: (type, given) => { if (typeof given[0] === 'number') made.room += given[0] * (name === 'ImageData' ? given[1] : 1);
                return Reflect.construct(type, given); }});
            const counted = (owner, name) => { const asked = owner[name]; owner[name] = function (...given) { made.layouts += 1; return asked.apply(this, given); }; };
            counted(Element.prototype, 'getBoundingClientRect'); counted(window, 'getComputedStyle');
            const watch = async (n) => { const seen = []; for (let i = 0; i < n; ++i) { await frames(1); seen.push({...canvas().work, ...made}); } return seen; };"""

    def test_a_frame_does_only_what_the_picture_needs(self):
        """Points are placed once, facets that face away are not filled, and nothing is made or laid out anew."""
        page = self.page("skin.html")
        said = self.act(self.COUNT + "deep(1); press(); await frames(4); said.moving = await watch(12); await rest();"
                        "const before = canvas().work.draws; await frames(10); said.resting = canvas().work.draws - before;", page)
        surface = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])["surface"]
        points, facets = (len(column(surface[k], c)) // 3 for k, c in (("points", "f"), ("facets", "H")))
        first, last = said["moving"][0], said["moving"][-1]
        self.assertGreaterEqual(last["draws"] - first["draws"], 10)
        for frame in said["moving"]:
            self.assertEqual(frame["points"], points)
            self.assertGreater(frame["moved"], 0)
            self.assertLessEqual(frame["moved"], points)
            self.assertGreater(frame["facets"], 0.2 * facets)
            self.assertLess(frame["facets"], 0.6 * facets)
        self.assertEqual(last["resized"], first["resized"])
        self.assertEqual(last["layouts"], first["layouts"])
        self.assertLess(last["room"] - first["room"], 100 * len(said["moving"]))  # numbers
        self.assertEqual(said["resting"], 0)

    def test_a_held_tool_moves_no_skin(self):
        """While the tissue relaxes under it, the force changes and the shape does not."""
        said = self.act(self.COUNT + "deep(0.5); press(); await frames(40); said.before = read().normal; said.held = await watch(10); said.after = read().normal;",
                        self.page("skin-relaxing.html"))
        self.assertGreater(said["held"][-1]["draws"], said["held"][0]["draws"])
        self.assertEqual({frame["moved"] for frame in said["held"]}, {0})
        self.assertLess(newtons(said["after"]), newtons(said["before"]))

    def test_a_press_that_is_held_relaxes(self):
        hold = """goTo(NODE); deep(0.5); TOGGLE press(); await frames(40); said.early = await steps(); await frames(150);
            said.csv = await steps(); const shown = (k) => get(`touch-${k}`).textContent;
            said.relaxed = shown('relaxed'); said.elastic = shown('elastic'); said.normal = shown('normal'); said.dissipated = shown('dissipated');
            press(); await rest();"""
        hold = hold.replace("NODE", str(self.data["chosen"]["median"]))
        said = self.act(hold.replace("TOGGLE", ""), self.page("skin-relaxing.html"))
        rows = rows_of(said["csv"])
        last = rows[-1]
        # Half of the force is left after both relaxation times; the elastic twin keeps all of it.
        elastic = newtons(said["elastic"])
        self.assertAlmostEqual(elastic / curve_force(self.data, self.data["chosen"]["median"], last["depth_m"]), 1, delta=0.01)
        self.assertAlmostEqual(newtons(said["normal"]) / elastic, 1 - last["relaxed_fraction"], delta=0.01)
        self.assertGreater(last["relaxed_fraction"], 0.45)
        self.assertLess(last["relaxed_fraction"], 0.5)
        self.assertGreater(last["relaxed_fraction"], rows_of(said["early"])[-1]["relaxed_fraction"] + 0.05)
        self.assertGreater(last["dissipated_J"], 0)
        self.assertGreaterEqual(last["absorbed_J"] - last["energy_J"] - last["tank_J"], -1e-12)
        said = self.act(hold.replace("TOGGLE", "get('touch-switch').click();"), self.page("skin-relaxing.html"))
        self.assertLess(rows_of(said["csv"])[-1]["relaxed_fraction"], 1e-6)
        self.assertAlmostEqual(newtons(said["normal"]) / elastic, 1, delta=0.005)


PIXELS = """const context = canvas().getContext('2d');
    const { width, height, data } = context.getImageData(0, 0, canvas().width, canvas().height);"""


class Pictures(Acted):
    def test_the_scale_bar_measures_the_body(self):
        """The width of the silhouette by the bar is that of the points across the direction of view."""
        said = self.act(PIXELS + """let [low, high] = [width, 0];
            for (let i = 0; i < 0.85 * width * height; ++i) if (data[4 * i + 3] > 127) { low = Math.min(low, i % width); high = Math.max(high, i % width); }
            said.seen = (high + 1 - low) / devicePixelRatio; said.bar = canvas().dataset.bar.split(' ').map(Number);""")
        stiffest = self.data["chosen"]["stiffest"]
        x, y, _ = (-c for c in column(self.data["vertices"]["inward"], "f")[3 * stiffest:3 * stiffest + 3])
        azimuth = math.atan2(y, x) + 0.35
        points = column(self.data["surface"]["points"], "f")
        across = [-math.sin(azimuth) * a + math.cos(azimuth) * b for a, b in zip(points[0::3], points[1::3])]
        metres, pixels = said["bar"]
        self.assertAlmostEqual(said["seen"], (max(across) - min(across)) * pixels / metres, delta=2)
        self.assertIn(round(metres / 10 ** math.floor(math.log10(metres) + 1e-9), 6), (1, 2, 5))

    def test_supports_are_hatched(self):
        """From below, pixels three apart on the grey support differ by the stripes; the rest of the body has none."""
        said = self.act("for (let i = 0; i < 14; ++i) key('ArrowUp', {shiftKey: true});" + PIXELS + """
            const stripes = (grey) => { let count = 0; for (let i = 0; i + 3 < width * height; ++i) {
              const [p, q] = [4 * i, 4 * (i + 3)].map((k) => Array.from(data.subarray(k, k + 4)));
              const like = (c) => c[3] === 255 && (Math.max(...c.slice(0, 3)) - Math.min(...c.slice(0, 3)) < 20) === grey;
              if (like(p) && like(q) && q[1] < 0.8 * p[1] && q[1] > 0.6 * p[1]) count += 1; } return count; };
            said.grey = stripes(true); said.coloured = stripes(false); said.all = width * height;""")
        self.assertGreater(said["grey"], 0.02 * said["all"])
        self.assertLess(said["coloured"], 0.1 * said["grey"])

    def test_a_session_is_seen_in_time(self):
        said = self.act("""const at = (time) => { const s = get('scrub'); s.value = time; s.dispatchEvent(new Event('input'));
              const c = document.querySelector('.scrub canvas'), {data} = c.getContext('2d').getImageData(0, 0, c.width, c.height);
              let arrow = 0; for (let i = 0; i < data.length; i += 4) arrow += data[i] === 213 && data[i + 1] === 94 && data[i + 2] === 0;
              return {text: get('scrub-text').textContent, arrow}; };
            said.contact = at(0.75); said.free = at(2.2);
            said.all = []; for (let t = 0; t < 3; t += 0.02) { const s = get('scrub'); s.value = t; s.dispatchEvent(new Event('input')); said.all.push(get('scrub-text').textContent); } at(2.2);
            get('scrub-play').click(); await frames(30); get('scrub-play').click(); said.played = Number(get('scrub').value);
            said.label = get('scrub-play').textContent;""", only="session")
        drawn = self.data["session"]["drawn"]
        time, depth = column(drawn["time"], "f"), column(drawn["depth"], "f")
        i = max(k for k, t in enumerate(time) if t <= 0.75 + 1e-6)
        self.assertIn(f"{time[i]:.3f}\u00a0s: depth {1e3 * depth[i]:.2f}\u00a0mm", said["contact"]["text"])
        self.assertGreater(said["contact"]["arrow"], 30)
        self.assertIn("no contact, force 0", said["free"]["text"])
        for text in said["all"]:  # in the unit of its size; what is left of nothing is nothing
            self.assertNotRegex(text, "e\u2212|0[.]00[0-9]*\u00a0[np]")
        self.assertEqual(said["free"]["arrow"], 0)
        self.assertGreater(said["played"], 2.4)
        self.assertLess(said["played"], 3)
        self.assertEqual(said["label"], "Play")

    def with_data(self, change, page="full.html"):
        """The page with its data changed."""
        text = (self.path / page).read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.S)[1])
        change(data)
        return re.sub(r'(id="data">).*?(</script>)', lambda m: m[1] + json.dumps(data).replace("<", "\\u003c") + m[2], text, flags=re.S)

    def test_a_library_alone_draws_its_tool_from_its_case(self):
        """The edge of a disc and the length of a cylinder are in the case, whose text the library has."""
        def shown(shape, *sizes):
            def change(data):
                data["key"]["tool_shape"] = shape
                data["provenance"] = [{"stage": "precompute", "resolved_case": "\n".join(["[mesh]", 'length = "9 mm"', "[tool]", f'shape = "{shape}"', *sizes, "[fit]"])}]
            return self.act(f"deep(1); goTo({self.data['chosen']['stiffest']}); press(); await rest();" + PIXELS + """
                let tool = 0; for (let i = 0; i < data.length; i += 4) tool += data[i + 3] === 255 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) < 24;
                said.tool = tool; said.picture = canvas().toDataURL(); said.text = get('touch-caption').textContent;""", self.with_data(change, "play.html"))
        sharp, round_ = shown("disc"), shown("disc", 'edge_radius = "4 mm"')
        self.assertNotEqual(sharp["picture"], round_["picture"])
        short, long_ = (shown("cylinder", f'length = "{length} mm"', 'azimuth = "90 deg"') for length in (4, 24))
        self.assertGreater(long_["tool"], 1.2 * short["tool"])
        for said in (sharp, round_, short, long_):
            self.assertNotIn("drawn as a sphere", said["text"])
        self.assertIn("drawn as a sphere", shown("cylinder")["text"])

    def test_one_stiff_node_does_not_take_the_colours(self):
        node = self.data["chosen"]["median"]
        def stiffen(data):
            first, end = column(data["normal"]["offset"], "I")[node:node + 2]
            slope = [k * (40 if first <= i < end else 1) for i, k in enumerate(column(data["normal"]["slope"], "f"))]
            data["normal"]["slope"] = {"f4": base64.b64encode(struct.pack(f"<{len(slope)}f", *slope)).decode()}
        said = self.act("""const choose = (range) => { get('colour-range').value = range; get('colour-range').dispatchEvent(new Event('change')); };
            const look = () => ({range: get('colour-range').value, text: get('field-range').textContent,
              ticks: [...document.querySelectorAll('#body .tick')].map((t) => [Number(t.textContent.replace('\u202f', '')), parseFloat(t.style.bottom)])});
            said.first = look(); choose('log'); said.log = look(); choose('all'); said.all = look();""", self.with_data(stiffen), only="body")
        depth = self.data["key"]["depth"]
        count = len(column(self.data["vertices"]["response_status"], "B"))
        known = sorted(k for v in range(count) if v != node and (k := curve_force(self.data, v, depth) / depth) > 0)
        known.append(40 * curve_force(self.data, node, depth) / depth)
        low, high = (known[math.ceil(q * len(known)) - 1] for q in (0.02, 0.98))
        self.assertEqual(said["first"]["range"], "middle")
        numbers = [float(x.replace("\u202f", "")) for x in re.search(r"The colours end at (\S+) to (\S+) N/m", said["first"]["text"]).groups()]
        self.assertAlmostEqual(numbers[0] / low, 1, delta=0.006)
        self.assertAlmostEqual(numbers[1] / high, 1, delta=0.006)
        self.assertNotIn("colours end", said["all"]["text"])
        least, most = known[0], known[-1]
        for name, place in (("all", lambda k: (k - least) / (most - least)), ("log", lambda k: math.log(k / least) / math.log(most / least)),
                            ("first", lambda k: (k - low) / (high - low))):
            self.assertGreater(len(said[name]["ticks"]), 1)
            for value, at in said[name]["ticks"]:
                self.assertAlmostEqual(at / 100, place(value), delta=0.005, msg=name)
        # Without it the whole range is shown.
        self.assertEqual(self.act("said.range = get('colour-range').value;", only="body")["range"], "all")

    def test_units_follow_the_size_of_the_forces(self):
        """The lump a million times softer: the numbers of the curves are those in micronewtons."""
        def soften(data):
            for place, name in ((data["normal"], "slope"), (data["samples"], "force")):
                values = [1e-6 * x for x in column(place[name], "f")]
                place[name] = {"f4": base64.b64encode(struct.pack(f"<{len(values)}f", *values)).decode()}
            data["key"]["max_force"] *= 1e-6
        said = self.act("document.querySelector('#curves .take button').click(); said.csv = csv;", self.with_data(soften), only="body")
        names, *values = csv.reader(io.StringIO(said["csv"]))
        softest = self.data["chosen"]["softest"]
        at = names.index(f"node {softest}, fitted, Force (\u00b5N)")
        depth, force = max((float(v[0]), float(v[at])) for v in values if v[at])
        self.assertAlmostEqual(force / curve_force(self.data, softest, 1e-3 * depth), 1, delta=1e-4)

    def test_nodes_are_told_apart_without_colours(self):
        """Each has a marker of its own shape, which the table shows too."""
        said = self.act("""const drawn = new Set();
            window.Path2D = class extends Path2D {
              part(name, given) { (this.parts ??= []).push([name, ...given]); }
              moveTo(...at) { this.part('moveTo', at); super.moveTo(...at); }
              lineTo(...at) { this.part('lineTo', at); super.lineTo(...at); }
              arc(...at) { this.part('arc', at.slice(0, 2)); drawn.add(this); super.arc(...at); }
              closePath() { drawn.add(this); super.closePath(); }  // curves stay open
            };
            get('neighbours').click(); await wait(300);
            const shape = ({parts}) => { const [, x, y] = parts[0], end = parts.findIndex(([name], i) => i && name === 'moveTo');
              return JSON.stringify(parts.slice(0, end < 0 ? undefined : end).map(([name, a, b]) => [name, Math.round(3 * (a - x)), Math.round(3 * (b - y))])); };
            said.shapes = [...drawn].map(shape);
            said.table = [...document.querySelectorAll('#curves tbody .marker')].map((m) => m.textContent);""", only="body")
        self.assertGreater(len(said["table"]), 2)
        self.assertEqual(len(set(said["table"])), len(said["table"]))
        self.assertEqual(len(set(said["shapes"])), len(said["table"]))

    def test_lines_over_time_are_told_apart_without_colours(self):
        said = self.act("""said.lines = [...document.querySelectorAll('.u-legend')].map((legend) => [...legend.querySelectorAll('.u-marker')]
              .map((m) => getComputedStyle(m)).map((s) => s.borderTopStyle + s.borderTopWidth));""", only="session")
        self.assertGreater(len(said["lines"]), 2)
        for lines in said["lines"]:
            self.assertGreater(len(lines), 1)
            self.assertEqual(len(set(lines)), len(lines), lines)

    def test_neighbours_lie_beside_a_node(self):
        said = self.act("get('neighbours').click(); document.querySelector('#curves .take button').click(); said.csv = csv;"
                        "said.last = [...document.querySelectorAll('#curves tbody tr')].pop().children[1].textContent;", only="body")
        last = int(said["last"])
        triangles = column(self.data["surface"]["triangles"], "H")
        beside = {v for t in zip(*[iter(triangles)] * 3) if last in t for v in t} - {last}
        status = column(self.data["vertices"]["response_status"], "B")
        shown = {int(n) for n in re.findall(r"node (\d+), neighbour", said["csv"])}
        self.assertEqual(shown, {v for v in beside if status[v] != 2})
        self.assertGreater(len(shown), 3)

    def test_a_chosen_node_is_the_next_to_be_pressed(self):
        said = self.act("""const input = document.querySelector('#curves input[type=number]'); input.value = NODE;
            input.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter'})); said.node = get('touch-node').value;
            deep(0.5); press(); await rest(); said.csv = await steps();""".replace("NODE", "100"), only=None)
        self.assertEqual(said["node"], "100")
        place = column(self.data["vertices"]["position"], "f")[300:303]
        first = next(r for r in rows_of(said["csv"]) if int(r["status"]) & 1)
        self.assertLess(math.dist(place, (first["x_m"], first["y_m"], first["z_m"])), 1e-4)

    def test_parts_on_springs_have_level_lines(self):
        text = (self.path / "sprung.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.S)[1])
        sprung = column(data["surface"]["facet_sprung"], "B")
        points, facets = column(data["surface"]["points"], "f"), column(data["surface"]["facets"], "H")
        for f, on in enumerate(sprung):
            self.assertEqual(on, 1 if all(points[3 * v] > 0.01 for v in facets[3 * f:3 * f + 3]) else 0)
        self.assertGreater(sum(sprung), 100)
        lines = PIXELS + """let lines = 0; for (let x = 0; x < width; x += 5) for (let y = 1; y + 1 < height; ++y) {
              const green = (row) => data[4 * (row * width + x) + 1], seen = (row) => data[4 * (row * width + x) + 3] === 255;
              lines += seen(y - 1) && seen(y) && seen(y + 1) && green(y) < 0.85 * green(y - 1) && green(y) < 0.85 * green(y + 1); }
            said.lines = lines;"""
        self.assertGreater(self.act(lines, text)["lines"], 300)
        self.assertLess(self.act(lines)["lines"], 30)
        said = self.act("said.text = document.querySelector('header').innerText; said.keys = document.querySelector('#body .keys').innerText;", text, only=None)
        self.assertIn(f"{sum(sprung)} facets on springs".replace(",", ""), said["text"].replace("\u202f", ""))
        self.assertIn("rests on springs", said["keys"])

    def test_the_quality_of_the_mesh_is_on_the_page(self):
        """The volume is that inside the boundary."""
        quality = self.data["body"]["quality"]
        points, facets = column(self.data["surface"]["points"], "f"), column(self.data["surface"]["facets"], "H")
        at = lambda v: points[3 * v:3 * v + 3]
        volume = 0.0
        for a, b, c in ((at(f[0]), at(f[1]), at(f[2])) for f in zip(*[iter(facets)] * 3)):
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        self.assertAlmostEqual(quality["volume"] / volume, 1, delta=1e-5)
        said = self.act("said.text = document.querySelector('header').innerText;", only="header")
        self.assertIn(f"volume {1e6 * volume:.0f}\u00a0cm\u00b3", said["text"])
        self.assertIn(f"dihedral angles {quality['smallest_dihedral']:.1f}\u00b0", said["text"])

    def test_the_first_printed_page_shows_the_body(self):
        self.browser.fresh()
        self.browser.open((self.path / "full.html").as_uri())
        self.browser.wait("document.documentElement.dataset.ready === 'ok'")
        raw = self.browser.printed()
        objects = dict(re.findall(rb"\n(\d+) 0 obj(.*?)endobj", raw, re.S))
        page = next(text for text in objects.values() if re.search(rb"/Type\s*/Page\b", text))
        stream = objects[re.search(rb"/Contents (\d+) 0 R", page)[1]]
        content = zlib.decompress(re.search(rb"stream\r?\n(.*?)\r?\nendstream", stream, re.S)[1])
        self.assertRegex(content, rb"/X\d+ Do")  # a picture

    def test_curves_and_pictures_can_be_taken_along(self):
        said = self.act("""const take = document.querySelectorAll('#curves .take button'); take[0].click(); said.csv = csv;
            take[1].click(); await wait(50); said.plot = [csv.type, csv.size > 3000];
            [...document.querySelectorAll('#body .controls button')].find((b) => b.textContent === 'PNG').click(); await wait(50);
            said.body = [csv.type, csv.size > 10000];""", only="body")
        self.assertEqual([said["plot"], said["body"]], [["image/png", True]] * 2)
        names, *values = csv.reader(io.StringIO(said["csv"]))
        self.assertEqual(names[0], "Depth (mm)")
        softest = self.data["chosen"]["softest"]
        at = names.index(f"node {softest}, fitted, Force (N)")
        known = [(float(v[0]), float(v[at])) for v in values if v[at]]
        self.assertGreater(len(known), 20)
        for depth, force in known:
            self.assertAlmostEqual(force, curve_force(self.data, softest, 1e-3 * depth), delta=1e-5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
