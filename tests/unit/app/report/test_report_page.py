#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""test_report_page.py <write_sample_report> <chromium>

Writes the sample reports, opens them in a browser without a network or a GPU, and compares what the
page shows with the same figures computed here from the embedded data.
"""
import base64
import html.parser
import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "support"))
from chromium import Chromium  # noqa: E402

WRITER, BROWSER = sys.argv[1:3]


class Page(html.parser.HTMLParser):
    """Attributes of the root, text by id, and the tags that were seen."""

    def __init__(self, text):
        super().__init__()
        self.root, self.by_id, self.tags, self.open, self.title = {}, {}, [], [], ""
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append((tag, attributes))
        if tag == "html":
            self.root = attributes
        if tag not in ("meta", "br", "input", "img"):
            self.open.append((tag, attributes.get("id")))

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        tags = [tag for tag, _ in self.open]
        if "title" in tags:
            self.title += data
        if "script" in tags or "style" in tags:
            if self.open[-1][1] == "data":
                self.by_id["data"] = data
            return
        self.text += data
        for _, name in self.open:
            if name:
                self.by_id[name] = self.by_id.get(name, "") + data


def with_other_data(page, target, change):
    """The same page with its data as `change` leaves them."""
    text = page.read_text(encoding="utf-8")
    start = text.index(">", text.index('id="data"')) + 1
    end = text.index("</script>", start)
    data = json.loads(text[start:end])
    change(data)
    target.write_text(text[:start] + json.dumps(data).replace("<", "\\u003c") + text[end:], encoding="utf-8")
    return target


def to_micrometres(data):
    """The comparison of a sphere of some micrometres: 4 um and 10 uN."""
    for curve in data["comparison"]["curves"]:
        for p in curve["points"]:
            p["displacement_m"] *= 1e-3
            for key in ("reference_N", "model_N"):
                p[key] *= 1e-5


def to_measured(data):
    """Every press measured three times, its forces known to 3 %; every lateral path made of it."""
    s = data["samples"]
    kind, offset, force = (column(s[k]) for k in ("kind", "offset", "force"))
    pack = lambda code, values: base64.b64encode(struct.pack(f"<{len(values)}{code}", *values)).decode()  # noqa: E731
    path_of = [p for p in range(len(kind)) for _ in range(offset[p], offset[p + 1])]
    known = [math.nan if kind[p] else 0.03 * f for p, f in zip(path_of, force)]
    s["measurement"] = {"origin": {"u1": pack("B", [2 if k else 1 for k in kind])},
                        "repeats": {"i4": pack("i", [0 if k else 3 for k in kind])},
                        "uncertainty": {"f4": pack("f", known)}, "scatter": {"f4": pack("f", [f / 2 for f in known])}}


def to_measured_exactly(data):
    to_measured(data)
    u = column(data["samples"]["measurement"]["uncertainty"])
    zeros = struct.pack(f"<{len(u)}f", *(math.nan if math.isnan(f) else 0 for f in u))
    data["samples"]["measurement"]["uncertainty"] = {"f4": base64.b64encode(zeros).decode()}


def to_many_sites(data):
    """A calibration of a slab: two shared constants and a modulus of each of twenty sites."""
    c = data["calibration"]
    c["slab"] = {"law": "demiray-fung", "poisson": 0.49, "stiffening_name": "b", "median_shear_modulus_Pa": 5930,
                 "thickness_m": {"identified": "upper bound", "value": 8e-3, "low": None, "high": 10.4e-3},
                 "stiffening": {"identified": "interval", "value": 2.33, "low": 1.77, "high": 4.48},
                 "thickness_range_m": [7.5e-3, 60e-3], "stiffening_range": [0.01, 5], "case_material": "mu = \"5.93 kPa\""}
    c["constants"] += [{**c["constants"][0], "name": f"shear modulus of site {i}", "value": 1000 + 100 * i, "profile": []}
                       for i in range(20)]
    size = len(c["constants"])
    c["correlation"] = [[1 if i == j else round(-0.02 * min(i, j) - 0.001 * max(i, j), 3) for j in range(size)] for i in range(size)]
    c["correlation"][1][0] = c["correlation"][0][1] = None


def column(value):
    (kind, text), = value.items()
    raw = base64.b64decode(text)
    code = {"f4": "f", "u4": "I", "i4": "i", "u1": "B"}[kind]
    return struct.unpack(f"<{len(raw) // struct.calcsize(code)}{code}", raw)


def secant_stiffness(data, d):
    """f(d)/d of each node by the trapezoid of its slopes; None without a response."""
    offset, knot, slope = (column(data["normal"][k]) for k in ("offset", "knot", "slope"))
    result = []
    for a, b in zip(offset, offset[1:]):
        x, s = list(knot[a:b]), list(slope[a:b])
        if not x:
            result.append(None)
            continue
        i = max(k for k in range(len(x)) if x[k] < d)
        end = s[-1] if i == len(x) - 1 else s[i] + (s[i + 1] - s[i]) * (d - x[i]) / (x[i + 1] - x[i])
        x, s = x[:i + 1] + [d], s[:i + 1] + [end]
        result.append(sum((q - p) * (u + v) / 2 for p, q, u, v in zip(x, x[1:], s, s[1:])) / d)
    return result


def ball(radius, rings=24, sectors=48):
    """An inclusion of the page: a sphere, its facets counter-clockwise from outside."""
    points, facets = [], []
    for i in range(rings + 1):
        for j in range(sectors):
            polar, azimuth = math.pi * i / rings, 2 * math.pi * j / sectors
            points += [radius * math.sin(polar) * math.cos(azimuth), radius * math.sin(polar) * math.sin(azimuth),
                       radius * math.cos(polar)]
    for i in range(rings):
        for j in range(sectors):
            a, b = sectors * i + j, sectors * i + (j + 1) % sectors
            facets += [a, a + sectors, b + sectors, a, b + sectors, b]
    pack = lambda code, values: base64.b64encode(struct.pack(f"<{len(values)}{code}", *values)).decode()  # noqa: E731
    return {"region": "<lump>", "points": {"f4": pack("f", points)}, "facets": {"i4": pack("i", facets)}}


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = pathlib.Path(cls.folder.name)
        subprocess.run([WRITER, path], check=True)
        cls.path = path
        cls.browser = Chromium(BROWSER, "--hide-scrollbars", width=1300, height=1200)
        cls.full = cls.drawn(path / "full.html")
        cls.unbounded = cls.drawn(path / "unbounded.html")
        cls.bare = cls.drawn(path / "bare.html")
        cls.compared = cls.drawn(path / "compared.html")
        cls.micro = cls.drawn(with_other_data(path / "compared.html", path / "micro.html", to_micrometres))
        cls.calibration = cls.drawn(path / "calibration.html")
        cls.many = cls.drawn(with_other_data(path / "calibration.html", path / "many.html", to_many_sites))
        cls.calibrated = cls.drawn(path / "calibrated.html")
        cls.sparse = cls.drawn(path / "sparse.html")
        cls.judged = cls.drawn(path / "judged.html")
        cls.judged_other = cls.drawn(path / "judged-other.html")

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    @classmethod
    def drawn(cls, path, query="", size=(None, None)):
        """The page when it is drawn."""
        cls.browser.fresh(*size)
        cls.browser.open(path.as_uri() + query)
        cls.browser.wait("document.documentElement.dataset.ready !== 'loading'")
        return Page(cls.browser.document())

    def acted(self, text, act):
        """The page with this text after the act, and what that said."""
        cut = text.rindex("</body>")
        path = self.path / "acted.html"
        path.write_text(f"{text[:cut]}<script>{act}</script>{text[cut:]}")
        self.drawn(path)
        said = self.browser.said()
        page = Page(self.browser.document())
        self.assertEqual(page.root.get("data-errors"), "0")
        return page, said

    def test_a_calibration_has_data_intervals_correlations_and_profiles(self):
        for page in (self.calibration, self.calibrated):
            self.assertEqual(page.root["data-ready"], "ok")
            text = page.by_id["calibration"].replace("\u00a0", " ").replace("\u202f", "")
            for words in ("C104.20 kPa3.78 kPa to 4.62 kPa3.82 kPa to no end", "Data and fit", "Residuals",
                          "Correlations", "\u22120.912", "Profile of C10", "Profile of C01",
                          "pull.csv, uniaxial", "twist.csv, simple shear", "0.9999", "1.70 times as wide",
                          "C01 <i>warned</i>"):
                self.assertIn(words, text)
            self.assertFalse([tag for tag, _ in page.tags if tag == "i" and not _])
        self.assertIn("gel <b>bold</b>", self.calibration.text)
        self.assertNotIn("calibration", self.full.by_id)

    def test_constants_of_many_sites_are_summarised(self):
        text = self.many.by_id["calibration"].replace("\u00a0", " ").replace("\u202f", "")
        self.assertEqual(self.many.root["data-ready"], "ok")
        for words in ("shear modulus of 20 sitesmedian 2.00 kPa, from 1.00 kPa to 2.90 kPa", "All 22 constants",
                      "Largest with one of a site", "correlations.csv", "Thickness8.00 mm, at most 10.4 mm",
                      "Stiffening b2.33, 1.77 to 4.48", "Shear modulus5.93 kPa", "mu = \"5.93 kPa\"",
                      # C01 with the sites 0 to 19: -0.02 - 0.001 j
                      "\u22120.031 (\u22120.041 to \u22120.022)",
                      "\u22120.421, shear modulus of site 18 and shear modulus of site 19"):
            self.assertIn(words, text)

    def test_both_pages_are_drawn_without_an_error(self):
        for page in (self.full, self.unbounded, self.bare, self.compared, self.sparse, self.judged,
                     self.judged_other):
            self.assertEqual(page.root.get("data-errors"), "0", page.text[-500:])
            self.assertEqual(page.root.get("data-ready"), "ok")

    def test_stiffest_and_softest_node_are_those_of_the_data(self):
        data = json.loads(self.full.by_id["data"])
        stiffness = secant_stiffness(data, data["key"]["depth"])
        known = [(k, v) for v, k in enumerate(stiffness) if k is not None]
        self.assertEqual(self.full.by_id["stiffest-node"], str(max(known)[1]))
        self.assertEqual(self.full.by_id["softest-node"], str(min(known)[1]))
        shown = self.full.by_id["stiffness-range"].replace("\u2009", "").split("\u2013")
        self.assertAlmostEqual(float(shown[0]) / min(known)[0], 1, delta=0.005)
        self.assertAlmostEqual(float(shown[1].split("\u00a0")[0]) / max(known)[0], 1, delta=0.005)

    def test_every_figure_is_on_the_page(self):
        canvases = [a for t, a in self.full.tags if t == "canvas"]
        # the body, two curve panels, two fit histograms, the tool in time and three plots of the session, one of timings
        touch = json.loads(self.full.by_id["data"])["touch"] is not None
        self.assertEqual(len(canvases), 10 + touch)
        for name in ("body", "curves", "fit", "session", "certificate", "record"):
            self.assertIn(name, self.full.by_id)
        self.assertIn("The session was passive", self.full.by_id["account"])
        self.assertIn("omega.3", self.full.by_id["certificate"])
        self.assertIn("young 60 kPa", self.full.text)
        self.assertIn('file = "lump.off"', self.full.by_id["record"])
        for slip in ("[object", "undefined", "NaN", "Infinity", "null"):
            for page in (self.full, self.unbounded, self.bare):
                self.assertNotIn(slip, page.text)

    def test_a_comparison_is_shown_where_there_is_one(self):
        self.assertNotIn("comparison", self.full.by_id)
        said = self.compared.by_id["comparison"]
        # an overlay and two Bland-Altman plots more
        canvases = [sum(t == "canvas" for t, _ in page.tags) for page in (self.compared, self.full)]
        self.assertEqual(canvases[0] - canvases[1], 3)
        for words in ("62.0\u00a0mN", "55.0\u00a0mN", "1.43", "40\u00a0%", "scatter of the reference: 30.0\u00a0mN",
                      "scatter of the reference: unknown", "site 3 of measured has no partner", "<b>curves</b>.h5"):
            self.assertIn(words, said)
        for slip in ("[object", "undefined", "NaN", "Infinity", "null"):
            self.assertNotIn(slip, self.compared.text)
        self.assertIn("Error against the reference", self.compared.text)
        self.assertNotIn("Error against the reference", self.full.text)

    def test_measured_curves_show_their_uncertainty_and_what_is_assumed(self):
        act = """addEventListener('load', () => setTimeout(async () => {
          const said = {csv: {}};
          for (const button of document.querySelectorAll('#curves button[aria-label$="as CSV"]')) {
            const create = URL.createObjectURL;
            let blob;
            URL.createObjectURL = (b) => { blob = b; return create.call(URL, b); };
            button.click();
            URL.createObjectURL = create;
            said.csv[button.getAttribute('aria-label')] = await blob.text();
          }
          said.picture = document.querySelector('#curves canvas').toDataURL();
          said.text = document.getElementById('curves').innerText;
          document.body.append(Object.assign(document.createElement('p'), {id: 'said', textContent: JSON.stringify(said)}));
        }, 300));"""
        full = self.path / "full.html"
        page, said = self.acted(with_other_data(full, self.path / "measured.html", to_measured).read_text(), act)
        _, exact = self.acted(with_other_data(full, self.path / "exact.html", to_measured_exactly).read_text(), act)
        _, computed = self.acted(full.read_text(), act)
        self.assertIn("twice the standard uncertainty", said["text"])
        self.assertIn("assumed, not measured", said["text"])
        self.assertIn("lateral responses are assumed", page.by_id["certificate"])
        self.assertIn("assumed where no drag was measured", page.text)
        self.assertNotEqual(said["picture"], exact["picture"])  # the bars
        normal, lateral = (next(v for k, v in said["csv"].items() if k.startswith(kind)) for kind in ("Normal", "Lateral"))
        rows = [line.split(",") for line in re.sub(r'"([^"]*)"', lambda m: m[1].replace(",", ";"), normal).splitlines()]
        names = rows[0]
        node = page.by_id["stiffest-node"]
        at = {what: names.index(next(n for n in names if n.startswith(f"node {node}; measured{what}")))
              for what in ("; lower end", "; upper end", "; Force")}
        ends = [[float(row[at[what]]) for what in at] for row in rows[1:] if row[at["; Force"]]]
        self.assertGreater(len(ends), 3)
        for low, high, force in ends:
            self.assertAlmostEqual(high - force, 0.06 * force, delta=1e-5 * max(1, force))
            self.assertAlmostEqual(force - low, 0.06 * force, delta=1e-5 * max(1, force))
        self.assertRegex(lateral.splitlines()[0], r"node \d+, assumed")
        self.assertNotRegex(lateral, "measured|computed|end of the bar")
        for text in (computed["text"], *computed["csv"].values()):
            self.assertNotRegex(text, "measured|assumed|standard uncertainty")

    def test_a_comparison_has_the_units_of_its_size(self):
        def axes(page):
            return {a["aria-label"] for _, a in page.tags if a.get("role") == "group" and "aria-label" in a}
        self.assertIn("Force (N) over Displacement (mm)", axes(self.compared))
        self.assertIn("Force (\u00b5N) over Displacement (\u00b5m)", axes(self.micro))
        self.assertIn("Model less reference (\u00b5N) over Mean force (\u00b5N)", axes(self.micro))

    def test_the_fidelity_is_shown_where_it_is_known(self):
        self.assertNotIn("fidelity", self.full.by_id)
        said = self.judged.by_id["fidelity"]
        for words in ("87 of 1340 sites were computed in 4 rounds", "95th percentile 4.6\u00a0%, worst 31\u00a0%",
                      "2 random points and 1 nodes", "20.0\u00a0mN", "normal press, off node", "4.9\u00a0%"):
            self.assertIn(words, said)
        other = self.judged_other.by_id["fidelity"]
        self.assertIn("87 of 1340", other)
        self.assertIn("of another library", other)
        self.assertNotIn("4.9\u00a0%", other)

    def test_each_device_gets_a_verdict(self):
        data = json.loads(self.full.by_id["data"])
        worst = max(data["certificate"][name] for name in ("stick", "slip"))
        said = self.full.by_id["certificate"]
        rates = [float(r) for r in re.findall(r"passive from ([\d.]+) Hz on, by the curves themselves", said)]
        self.assertEqual(len(rates), 2)
        for rate, damping in zip(rates, (1.9, 0.6)):  # omega.3, Touch X
            self.assertGreaterEqual(rate, 1.5 * worst / damping * (1 - 1e-12))
            self.assertAlmostEqual(rate / (1.5 * worst / damping), 1, delta=1e-3)
        self.assertEqual(said.count("no guarantee: its damping is unknown"), 1)
        self.assertIn("omega.3; the force changes by at most", self.full.text)
        self.assertTrue(self.full.by_id["guarantee"].startswith("Guaranteed by the curves themselves"))
        shown = self.full.by_id["guaranteed"].replace("\u202f", "")  # the lowest rate of all devices
        self.assertAlmostEqual(float(re.search(r"from ([\d.]+)", shown)[1]) / (1.5 * worst / 1.9), 1, delta=1e-3)

    def test_a_slide_without_bound_is_no_guarantee(self):
        said = self.unbounded.by_id["certificate"]
        self.assertIn("no bound; while sliding", said)
        self.assertEqual(said.count("no guarantee at any rate: slides have no bound"), 2)
        self.assertEqual(said.count("no guarantee: its damping is unknown"), 1)
        self.assertNotIn("passive from", said)
        self.assertEqual(self.unbounded.by_id["guaranteed"], "nothing")
        self.assertTrue(self.unbounded.by_id["guarantee"].startswith("Nothing is guaranteed"))
        self.assertNotIn("ertified", self.unbounded.text)  # no such word where nothing is

    def test_the_page_answers_the_reader(self):
        """Turn, colour by L_slip, click the middle of the body, drag the depth to 3 mm, as a reader would."""
        act = """addEventListener('load', () => setTimeout(() => {
          const canvas = document.querySelector('.stage canvas'), box = canvas.getBoundingClientRect();
          const at = {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, pointerId: 1, bubbles: true};
          canvas.setPointerCapture = () => {};
          const pointer = (type, more) => canvas.dispatchEvent(new PointerEvent(type, {...at, ...more}));
          const choose = (name) => {
            const field = document.getElementById('field');
            field.value = name;
            field.dispatchEvent(new Event('change'));
            return document.getElementById('field-range').textContent;
          };
          const said = {slip: choose('slip'), fit: choose('fit'), stiffness: choose('stiffness')};
          pointer('pointerdown'); pointer('pointermove', {clientX: at.clientX + 60}); pointer('pointerup');
          canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}));
          pointer('pointermove');
          said.tip = document.querySelector('.tip').innerText;
          pointer('pointerdown'); pointer('pointerup');
          const depth = document.querySelector('input[type=range]');
          depth.value = 0.5;
          depth.dispatchEvent(new Event('input'));
          said.half = document.getElementById('field-range').textContent;
          said.table = document.querySelector('#curves table').innerText;
          document.body.append(Object.assign(document.createElement('p'), {id: 'said', textContent: JSON.stringify(said)}));
        }, 300));"""
        page, said = self.acted((self.path / "full.html").read_text(), act)
        data = json.loads(page.by_id["data"])
        slip = max(column(data["certificate"]["triangle_slip"]))
        self.assertIn(f"to {slip:.0f} N/m", said["slip"])
        self.assertIn("% of peak force", said["fit"])
        # The click adds the node that the tip named.
        self.assertEqual(page.by_id["chosen-node"], said["tip"].split()[1])
        half = [k for k in secant_stiffness(data, data["key"]["depth"] / 2) if k is not None]
        self.assertIn("at d = 3.00\u00a0mm", said["half"])
        self.assertIn(f"{min(half):.1f} to {max(half):.0f} N/m", said["half"])
        # The volume changes like the square of the depth, by 36 mm^3 at the end.
        self.assertIn("\u22129.00\u00a0mm\u00b3", said["table"])
        volume = 1e6 * data["body"]["quality"]["volume"]
        self.assertIn(f"nowhere below 0.500; the volume of the body changes by \u221236.0\u00a0mm\u00b3 at most, {3.6 / volume:.2g}\u00a0%", page.text)

    def test_the_map_of_the_error_marks_single_sites(self):
        """Four sites were compared, three of them around one triangle: that triangle and one disc have a
        colour, the rest of the body is grey, and the figures of the disc are under the pointer."""
        act = """addEventListener('load', () => setTimeout(() => {
          const canvas = document.querySelector('.stage canvas'), box = canvas.getBoundingClientRect();
          const look = () => {
            const { width, height, data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
            const seen = {body: 0, coloured: 0, worst: 0, x: 0, y: 0, high: width};
            for (let i = 0; i < data.length; i += 4) {
              if (data[i + 3] < 255) continue;
              const [r, g, b] = data.subarray(i, i + 3);
              seen.body += 1;
              seen.coloured += Math.max(r, g, b) - Math.min(r, g, b) > 40;
              if (r < 240 || g < 215 || b > 60) continue;  // the top of the colours, unshaded
              seen.worst += 1;
              seen.x += ((i / 4) % width) * box.width / width;
              seen.y += Math.floor(i / 4 / width) * box.height / height;
            }
            return seen;
          };
          const said = {opened: document.getElementById('field').value};
          for (const name of ['stiffness', 'error_lateral', 'error_normal']) {
            const field = document.getElementById('field');
            field.value = name;
            field.dispatchEvent(new Event('change'));
            said[name] = {...look(), range: document.getElementById('field-range').textContent};
          }
          const {x, y, worst} = said.error_normal;
          const now = canvas.getBoundingClientRect();  // the controls above are others
          canvas.dispatchEvent(new PointerEvent('pointermove',
            {clientX: now.left + x / worst, clientY: now.top + y / worst, bubbles: true}));
          said.tip = document.querySelector('.tip').innerText;
          document.body.append(Object.assign(document.createElement('p'), {id: 'said', textContent: JSON.stringify(said)}));
        }, 300));"""
        page, said = self.acted((self.path / "sparse.html").read_text(), act)
        data = json.loads(page.by_id["data"])
        compared = {c["vertex"]: c for c in data["comparison"]["curves"] if c["kind"] == "normal"}
        worst = max(compared, key=lambda v: compared[v]["rms_jnd"])
        self.assertEqual(said["opened"], "error_normal")
        for kind in ("error_normal", "error_lateral"):
            self.assertIn("1.29 to 2.86 JND", said[kind]["range"])
            self.assertIn(f"4 of {len(column(data['vertices']['is_site']))} nodes were compared. Discs: 1 node without",
                          said[kind]["range"])
            # A disc of eight pixels radius, less its rim, and a triangle of some hundred: the rest is grey.
            self.assertGreater(said[kind]["worst"], 60)
            self.assertLess(said[kind]["worst"], 220)
            self.assertGreater(said[kind]["coloured"], 2 * said[kind]["worst"])
            self.assertLess(said[kind]["coloured"], 0.05 * said[kind]["body"])
        self.assertGreater(said["stiffness"]["coloured"], 0.5 * said["stiffness"]["body"])
        self.assertIn(f"node {worst}", said["tip"], said)
        self.assertIn("normal: root mean square error 124\u00a0mN (2.86\u00a0JND), scatter 30.0\u00a0mN", said["tip"])

    def test_an_inclusion_is_outlined(self):
        """The outline of a sphere is a circle of its radius, however the body is turned."""
        text = (self.path / "full.html").read_text()
        self.assertEqual(text.count('"inclusions":[]'), 1)
        act = """addEventListener('load', () => setTimeout(() => {
          const canvas = document.querySelector('.stage canvas');
          const pixels = () => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
          const shown = [...document.querySelectorAll('label')].find((l) => l.textContent === 'inclusions').firstChild;
          const said = [];
          for (const key of ['ArrowUp', 'ArrowLeft', 'ArrowLeft']) {
            canvas.dispatchEvent(new KeyboardEvent('keydown', {key}));
            const after = pixels();
            shown.click();
            const before = pixels();
            shown.click();
            const box = [canvas.width, canvas.height, 0, 0];
            for (let i = 0; i < after.length; i += 4) {
              if ([0, 1, 2].every((k) => after[i + k] === before[i + k])) continue;
              const x = (i / 4) % canvas.width, y = Math.floor(i / 4 / canvas.width);
              [box[0], box[1], box[2], box[3]] = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
            }
            said.push([box[2] - box[0] + 1, box[3] - box[1] + 1]);
          }
          document.body.append(Object.assign(document.createElement('p'), {id: 'said', textContent: JSON.stringify(said)}));
        }, 300));"""
        width = {}
        for radius in (0.006, 0.012):
            changed = text.replace('"inclusions":[]', f'"inclusions":[{json.dumps(ball(radius))}]')
            page, said = self.acted(changed, act)
            self.assertIn("outline of <lump>, inside", page.text)
            for across, down in said:
                self.assertAlmostEqual(across, down, delta=4)
                width[radius] = across
        line = 3.4  # pixels, the width of the stroke
        self.assertAlmostEqual((width[0.012] - line) / (width[0.006] - line), 2, delta=0.1)

    def test_a_section_alone_is_a_figure(self):
        page = self.drawn(self.path / "full.html", query="?only=body")
        self.assertEqual(page.root.get("data-errors"), "0")
        self.assertIn("body", page.by_id)
        for name in ("fit", "session", "certificate", "record"):
            self.assertNotIn(name, page.by_id)

    def test_what_is_missing_is_said(self):
        self.assertIn("No recording was given", self.bare.by_id["session"])
        self.assertIn("has not been certified", self.bare.by_id["certificate"])
        self.assertIn("have no computing times", self.bare.by_id["record"])

    def test_hostile_names_are_shown_as_text(self):
        hostile = "</script><script>document.title='owned'</script><img src=x onerror=boom()> & \"'"
        self.assertEqual(self.bare.title, hostile)
        self.assertIn(hostile, self.bare.text)
        self.assertNotIn("img", [tag for tag, _ in self.bare.tags])

    def test_previews_show_supports_press_zones_and_what_repair_moved(self):
        data = {}
        for name in ("preview", "preview-repaired"):
            page = self.drawn(self.path / f"{name}.html", size=(900, 1150))
            self.browser.picture(self.path / f"{name}.png")
            self.assertEqual((page.root["data-ready"], page.root["data-errors"]), ("ok", "0"), name)
            data[name] = json.loads(page.by_id["data"])
        plain = data["preview"]
        self.assertIsNone(plain["distance"])
        sites = sum(s == 0 for s in column(plain["vertices"]["response_status"]))
        self.assertEqual(sites, plain["body"]["sites"])
        repaired = data["preview-repaired"]
        for z, moved in zip(column(repaired["surface"]["points"])[2::3], column(repaired["distance"])):
            self.assertAlmostEqual(moved, 0.002 * min(max(z / 0.04, 0), 1), delta=1e-6)
        # Press zones are green; what repair moved is in the colours of the scale, up to yellow.
        green, yellow = {}, {}
        for name in data:
            pixels = list(png_pixels((self.path / f"{name}.png").read_bytes()))
            green[name] = sum(r < 60 and 110 < g < 180 and 80 < b < 150 for r, g, b in pixels)
            yellow[name] = sum(r > 150 and g > 170 and b < 80 for r, g, b in pixels)
        self.assertGreater(green["preview"], 1000)
        self.assertEqual(yellow["preview"], 0)
        self.assertGreater(yellow["preview-repaired"], 50)

    def test_the_hot_spot_is_seen(self):
        """The top of the colour map must cover some of the body, its bottom much more."""
        picture = self.path / "view.png"
        self.drawn(self.path / "full.html", size=(900, 1150))
        self.browser.picture(picture)
        pixels = list(png_pixels(picture.read_bytes()))
        hot = sum(r > 90 and g > 170 and b < 110 for r, g, b in pixels)
        cold = sum(45 < r < 80 and g < 75 and 60 < b < 140 for r, g, b in pixels)
        self.assertGreater(hot, 100)
        self.assertGreater(cold, 4 * hot)


def png_pixels(raw):
    """Every third pixel of an 8-bit RGB or RGBA file."""
    import zlib
    width, height, depth, kind = struct.unpack(">IIBB", raw[16:26])
    assert depth == 8 and kind in (2, 6)
    channels = 3 if kind == 2 else 4
    packed, i = b"", 8
    while i < len(raw):
        size, name = struct.unpack(">I4s", raw[i:i + 8])
        if name == b"IDAT":
            packed += raw[i + 8:i + 8 + size]
        i += 12 + size
    stream, stride = zlib.decompress(packed), width * channels
    above = bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = unfiltered(stream[start], bytearray(stream[start + 1:start + 1 + stride]), above, channels)
        above = row
        if y % 3 == 0:
            for x in range(0, stride, 3 * channels):
                yield tuple(row[x:x + 3])


def unfiltered(kind, row, above, channels):
    for i in range(len(row)) if kind else ():
        left = row[i - channels] if i >= channels else 0
        corner = above[i - channels] if i >= channels else 0
        guess = left + above[i] - corner
        paeth = min((left, above[i], corner), key=lambda v: abs(guess - v))
        row[i] = (row[i] + (0, left, above[i], (left + above[i]) // 2, paeth)[kind]) & 255
    return row


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
