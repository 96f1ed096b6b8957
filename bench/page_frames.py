#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""How long the page of the report takes for a frame, in headless Chromium without a graphics processor.

Usage: page_frames.py WRITE_SAMPLE_REPORT [CHROMIUM]

The body is the lump of the tests of the page, with ever more response nodes and points of the skin, and a skin that
deforms. Three things move, one step a frame: the picture of the body turns, the tool slides over the body that it
presses, and the slider of the session runs. Prints one row a page and movement: the mean processor time of the page's
thread for a frame; by the clock, the median and the 95th percentile of the page's own callbacks in a frame; and the
part of the frames that come within a sixtieth of a second of the last. Other work of the machine counts in all but the
first: run it alone.
"""
import argparse
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/pipeline"))
from chromium import Chromium  # noqa: E402

SIZES = ((4, 1), (5, 0), (5, 1))  # halvings of the response surface, and of its facets to those of the skin
FRAMES = 180
LATE = 1.2 / 60  # s between frames; a browser rounds to its own beat

MEASURE = """
(() => {
  const ask = window.requestAnimationFrame.bind(window);
  window.taken = [];
  window.requestAnimationFrame = (f) => ask((now) => {
    const start = performance.now();
    f(now);
    const time = performance.now() - start, last = window.taken[window.taken.length - 1];
    if (last?.now === now) last.time += time;
    else window.taken.push({now, time});
  });
})();
"""
MOVE = """
(async () => {
  const canvas = document.querySelector('%(canvas)s'), box = () => canvas.getBoundingClientRect();
  canvas.scrollIntoView({block: 'center'});
  canvas.setPointerCapture = () => {};
  const pointer = (type, right, down) => canvas.dispatchEvent(new PointerEvent(type, {clientX: box().left + right * box().width,
    clientY: box().top + down * box().height, pointerId: 1, button: 0, bubbles: true}));
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  for (let i = 0; i < 20; ++i) await frame();
  %(begin)s
  for (let i = 0; i < 20; ++i) await frame();
  window.taken.length = 0;
  for (let i = 0; i < %(frames)d; ++i) { const turn = 2 * Math.PI * i / 60; %(step)s await frame(); }
  const taken = window.taken.slice();
  %(end)s
  return taken;
})()
"""
MOVEMENTS = {
    "turning": {"canvas": "#body canvas", "begin": "pointer('pointerdown', 0.5, 0.5);",
                "step": "pointer('pointermove', 0.5 + 0.1 * Math.cos(turn), 0.5 + 0.1 * Math.sin(turn));",
                "end": "pointer('pointerup', 0.6, 0.5);"},
    "pressing": {"canvas": "#touch canvas", "begin": "pointer('pointerdown', 0.5, 0.5);",
                 "step": "pointer('pointermove', 0.5 + 0.05 * Math.cos(turn), 0.5 + 0.05 * Math.sin(turn));",
                 "end": "pointer('pointerup', 0.55, 0.5);"},
    "session": {"canvas": "#session canvas", "begin": "const slider = document.getElementById('scrub');",
                "step": "slider.value = i / %d; slider.dispatchEvent(new Event('input'));" % FRAMES, "end": ""},
}


def nearest_rank(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def processor_seconds(tab):
    metrics = tab.call("Performance.getMetrics")["metrics"]
    return next(metric["value"] for metric in metrics if metric["name"] == "TaskDuration")


def timed(tab, movement):
    """(processor seconds a frame, frames); the frames before and after those of the movement count alike."""
    before = processor_seconds(tab)
    frames = tab.value(movement)
    return (processor_seconds(tab) - before) / len(frames), frames


def measure(browser, page):
    """(response nodes, seconds until the page is drawn, {movement: (processor seconds a frame, frames)})."""
    with Chromium(browser) as tab:
        tab.call("Page.enable")
        tab.call("Page.addScriptToEvaluateOnNewDocument", source=MEASURE)
        tab.open(page.as_uri())
        tab.wait("document.documentElement.dataset.ready === 'ok'")
        drawn = tab.value("performance.now()") / 1000
        nodes = tab.value("JSON.parse(document.getElementById('data').textContent).body.vertices")
        tab.call("Performance.setTimeDomain", timeDomain="threadTicks")
        tab.call("Performance.enable")
        return nodes, drawn, {name: timed(tab, MOVE % {**movement, "frames": FRAMES}) for name, movement in MOVEMENTS.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("writer", help="write_sample_report of a build")
    parser.add_argument("browser", nargs="?", default=shutil.which("chromium"))
    arguments = parser.parse_args()
    print("| nodes | skin points | page, MB | drawn after, s | movement | frame, processor ms | by the clock: median | 95 % | within 1/60 s |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for size in SIZES:
            subprocess.run([arguments.writer, folder, *map(str, size)], check=True)
            page = pathlib.Path(folder) / "lump.html"
            nodes, drawn, movements = measure(arguments.browser, page)
            points = 10 * 4 ** sum(size) + 2
            for name, (processor, frames) in movements.items():
                times = [frame["time"] for frame in frames]
                late = [b["now"] - a["now"] > 1000 * LATE for a, b in zip(frames, frames[1:])]
                print(f"| {nodes} | {points} | {page.stat().st_size / 1e6:.1f} | {drawn:.1f} | {name} | {1000 * processor:.1f} | {statistics.median(times):.1f} | "
                      f"{nearest_rank(times, 0.95):.1f} | {1 - sum(late) / len(late):.0%} |", flush=True)


if __name__ == "__main__":
    main()
