"""Draws what `palpate latency -o DIR` measured: latency_plot.py DIR reads DIR/latency.json, writes DIR/latency.png."""
import json
import pathlib
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a word: its caller has one

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt

folder = pathlib.Path(sys.argv[1])
data = json.loads((folder / "latency.json").read_text())
titles = {"round_trip": "palpate's bus", "bare_dds": "bare Cyclone DDS",
          "bare_dds_listener": "bare Cyclone DDS, by listener", "bare_udp": "bare UDP", "tool_to_force": "tool to force",
          "tool_to_surface": "tool to surface", "tool_to_picture": "tool to picture"}


def draw(axes, curves, what):
    """Share of the samples that take longer than t: a straight look at the tail."""
    for name, bins in curves.items():
        total = sum(count for _, count in bins)
        if total == 0:
            continue
        left, times, shares = total, [], []
        for start, count in bins:
            times.append(max(start, 1e-1))
            shares.append(left / total)
            left -= count
        axes.step(times, shares, where="post", label=f"{titles[name]} ({total} samples)")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(f"{what} [µs]")
    axes.set_ylabel("share that takes longer")
    axes.grid(True, which="both", color="0.92")
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


hops = data.get("hop_histograms_us")
figure, axes = plt.subplots(1, 2 if hops else 1, figsize=(11 if hops else 6, 4), squeeze=False)
draw(axes[0][0], {name: way["histogram_us"] for name, way in data["ways"].items()}, "there and back")
if hops:
    draw(axes[0][1], hops, "one way")
figure.tight_layout()
small_png.save(figure, folder / "latency.png", dpi=110)
