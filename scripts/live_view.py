#!/usr/bin/env python3
"""live_view.py [--domain N] [--rounds N] [--picture FILE]: figures of the live view on this machine.

Rows on standard output, as the benchmarks print them: from a pointer's move to the first picture whose state carries
its sample (event_to_picture), to that picture's completion (event_to_made) and to that state in the page
(event_to_state), bytes per second to one page, when its first picture is complete, and what sixteen viewers cost the
haptic step. Needs chromium, chromium-driver and python3-selenium; run it with Debian's python3."""
import argparse
import json
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/web"))
from live_page import Nodes, need_browser, open_browser, open_page  # noqa: E402
from watcher import Watcher  # noqa: E402

STATE_TIMES = """
globalThis.stateDelays = [];
globalThis.madeDelays = [];
const own = palpate.binary.bind(palpate), waiting = [];
palpate.binary = (buffer) => {
  own(buffer);
  const shown = palpate.next?.tools[0].sample ?? 0;
  while (waiting.length && waiting[0].number <= shown) stateDelays.push(performance.now() - waiting.shift().event);
};
const go = palpate.hand.go.bind(palpate.hand);
palpate.hand.go = (frame) => { go(frame); waiting.push(palpate.hand.pending.at(-1)); };
const made = palpate.made.bind(palpate), drawn = palpate.hand.drawn.bind(palpate.hand), making = [];
palpate.made = (what) => {
  for (const event of making.splice(0)) madeDelays.push(performance.now() - event);
  made(what);
};
palpate.hand.drawn = (frame, me) => {
  const before = [...palpate.hand.pending];
  drawn(frame, me);
  making.push(...before.slice(0, before.length - palpate.hand.pending.length).map(({ event }) => event));
};
"""


COUNTS = """
globalThis.bytes = globalThis.pictures = 0;
const on = palpate.binary, draw = palpate.drawn.bind(palpate);
palpate.binary = (buffer) => { bytes += buffer.byteLength; on(buffer); };
palpate.drawn = (what) => { ++pictures; draw(what); };
"""


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(int(share * len(ordered)), len(ordered) - 1)]


def row(name, unit, *values):
    print(f"{name},{unit},{','.join(f'{v:.4g}' for v in values)}", flush=True)


def slide(page, moves):
    for step in range(moves):
        page.drag(0.45 + 0.1 * (step % 40) / 40, 0.6 - 0.05 * (step % 40) / 40)
        time.sleep(0.02)


def one_page(options):
    with Nodes(options, "liver.toml") as nodes, open_page(nodes, open_browser) as page:
        row("web,liver,first_drawn", "ms", page.get("palpate.firstDrawn"))
        page.browser.execute_script(STATE_TIMES)
        page.browser.execute_script(COUNTS)
        page.press(0.45, 0.6)
        page.wait("palpate.hand.drag?.down", 10)
        slide(page, 100)  # meanwhile the page finds how many pixels the machine draws in time
        page.get("[palpate.hand.delays, madeDelays, stateDelays].map((of) => { of.length = 0; })")
        begin, counted = time.monotonic(), page.get("[bytes, pictures]")
        slide(page, options.moves)
        seconds = time.monotonic() - begin
        grown = [now - before for now, before in zip(page.get("[bytes, pictures]"), counted)]
        row("web,liver,bytes_per_s", "B/s", grown[0] / seconds)
        row("web,liver,pictures", "Hz", grown[1] / seconds)
        for name, list_of in (("event_to_picture", "palpate.hand.delays"), ("event_to_made", "madeDelays"),
                              ("event_to_state", "stateDelays")):
            values = page.get(list_of)
            row(f"web,liver,{name}", "ms p50 p99 max n", percentile(values, 0.5), percentile(values, 0.99),
                max(values), len(values))


# From the side, so that the arrow has its length.
FROM_THE_SIDE = "palpate.camera.now.eye = [-0.06, -0.26, 0.055]; palpate.setDepth(10);"
# In the end finer than can be drawn in time without a graphics card; the panel stays as it was before.
FINE = """palpate.panel.status = () => {};
palpate.adapt = () => {};
palpate.scale = 2;"""


def portrait(options):
    """A picture of the page while the organ is pressed."""
    with Nodes(options, "liver.toml") as nodes, open_page(nodes, open_browser) as page:
        page.wait("palpate.frame.tools[0].seen", 20)
        page.browser.execute_script(FROM_THE_SIDE)
        time.sleep(5)  # meanwhile the page finds how many pixels the machine draws in time
        page.press(0.45, 0.45)
        page.wait("palpate.hand.drag?.down", 10)
        for step in range(30):
            page.drag(0.45 + 0.001 * step, 0.45)
            time.sleep(0.02)
        time.sleep(1)
        page.browser.execute_script(FINE)
        time.sleep(3)
        page.browser.save_screenshot(options.picture)


def haptic_p99(options, viewers):
    """[us] of the haptic step in a run of the scripted press, and frames per second to a viewer."""
    with tempfile.TemporaryDirectory() as folder:
        summary = pathlib.Path(folder) / "summary.json"
        with Nodes(options, "liver.toml", 0, ["--seconds", "8", "--summary", str(summary)]) as nodes:
            watchers = [Watcher(nodes.port) for _ in range(viewers)]
            for watcher in watchers:
                watcher.start()
            begin = time.monotonic()
            nodes.process.wait(timeout=40)
            rate = sum(w.frames for w in watchers) / max(viewers, 1) / (time.monotonic() - begin)
        said = json.loads(summary.read_text())["haptic_node"]
    return said["step_us_p99"], rate


def viewers(options):
    alone, watched, rates = [], [], []
    for _ in range(options.rounds):
        alone.append(haptic_p99(options, 0)[0])
        p99, rate = haptic_p99(options, 16)
        watched.append(p99)
        rates.append(rate)
    row("web,viewers0,haptic_step_p99", "us", *alone)
    row("web,viewers16,haptic_step_p99", "us", *watched)
    row("web,viewers16,frames_per_s_each", "Hz", *rates)
    row("web,viewers16,haptic_p99_ratio", "1", percentile(watched, 0.5) / percentile(alone, 0.5))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", default=str(ROOT / "build/release/bin"))
    parser.add_argument("--domain", default="99")
    parser.add_argument("--cache", default=str(ROOT / "scenes/meshes/.palpate"))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--picture", help="only this: PNG of the page while the organ is pressed")
    parser.add_argument("--moves", type=int, default=300)
    options = parser.parse_args()
    options.source = str(ROOT)
    need_browser()
    if options.picture:
        return portrait(options)
    one_page(options)
    if options.rounds:
        viewers(options)


if __name__ == "__main__":
    main()
