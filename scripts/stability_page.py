#!/usr/bin/env python3
"""Plots and one page from a folder's stability.csv: stability_page.py DIR"""
import base64
import csv
import html
import io
import os
import platform
import re
import subprocess
import signal
import sys
from datetime import date

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a word: its caller has one

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOUR = {"stable": "#2a7f4f", "regularised": "#b8860b", "refused": "#5b6b8c", "failed": "#c02020"}


def read(folder):
    with open(os.path.join(folder, "stability.csv"), newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def stiffness(rows, parameter):
    """Largest stable stiffness and bound against one parameter, with and without the controller."""
    found = {}
    for row in rows:
        match = re.search(r"K_max=([-\d.e+]+) N/m(?: at least)?, bound=([-\d.e+]+)", row["note"])
        if not match or row["parameter"] != parameter:
            continue
        found.setdefault(row["case"], []).append((float(row["value"]), float(match[1]), float(match[2]), float(row["energy_growth"])))
    return {name: sorted(points) for name, points in found.items()}


def plot_stiffness(rows, parameter, log_x):
    series = stiffness(rows, parameter)
    if not series or max(len(p) for p in series.values()) < 2:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), constrained_layout=True)
    marks = {"loop controller": ("o-", "#2a7f4f", "with the controller"), "loop observer only": ("s--", "#b8503a", "observer only")}
    for name, points in series.items():
        style, colour, label = marks.get(name, ("x-", "grey", name))
        x = [p[0] for p in points]
        left.plot(x, [p[1] for p in points], style, color=colour, label=label)
        right.plot(x, [1e3 * max(p[3], 1e-9) for p in points], style, color=colour, label=label)
    points = next(iter(series.values()))
    left.plot([p[0] for p in points], [p[2] for p in points], ":", color="black", label="b / (T/2 + delay)")
    right.axhline(10, color="black", linestyle=":", label="reserve")
    left.set_ylabel("largest stable stiffness [N/m]\n(tried up to 1e6)")
    right.set_ylabel("energy given to the hand [mJ]\nat three times that stiffness, 1e6 N/m at most")
    for axes in (left, right):
        axes.set_yscale("log")
        axes.set_xscale("log" if log_x else ("symlog" if points[0][0] == 0 else "linear"))
        axes.set_xlim(left=points[0][0] * 0.9)
        axes.set_xlabel(parameter)
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
    return figure


def plot_growth(rows):
    """Energy given to the hand over delay, for fixed walls and tissue."""
    series = {}
    for row in rows:
        if row["parameter"] == "delay [ms]" and row["case"].split(",")[0] in ("wall of 2000 N/m", "moving tissue"):
            series.setdefault(row["case"], []).append((float(row["value"]), 1e3 * max(float(row["energy_growth"]), 1e-9)))
    if not series:
        return None
    figure, axes = plt.subplots(figsize=(6.5, 3.8), constrained_layout=True)
    for name, points in sorted(series.items()):
        points.sort()
        axes.plot(*zip(*points), "s--" if "observer" in name else "o-", color="#7a4fa0" if "tissue" in name else "#b8503a", label=name,
                  alpha=0.6 if "observer" in name else 1)
    axes.axhline(10, color="black", linestyle=":", label="reserve")
    axes.set_yscale("log")
    axes.set_xlabel("delay [ms]")
    axes.set_ylabel("most energy given to the hand [mJ]")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8)
    return figure


def plot_taps(rows):
    """Energy that the hand gains by taps on a duct, over stiffness."""
    points = sorted((float(r["value"]), 1e3 * float(r["energy_growth"])) for r in rows if r["case"] == "taps on a duct" and r["parameter"] == "E [Pa]")
    if len(points) < 2:
        return None
    figure, axes = plt.subplots(figsize=(6.5, 3.8), constrained_layout=True)
    axes.plot(*zip(*points), "o-", color="#b8503a")
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=1e-3)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("E of the duct [Pa]")
    axes.set_ylabel("energy given to the hand [mJ]")
    axes.grid(alpha=0.3)
    return figure


def plot_outcomes(rows):
    names = list(dict.fromkeys(row["case"] for row in rows))
    figure, axes = plt.subplots(figsize=(8, 0.24 * len(names) + 1), constrained_layout=True)
    for outcome, colour in COLOUR.items():
        counts = [sum(r["case"] == n and r["outcome"] == outcome for r in rows) for n in names]
        before = [sum(r["case"] == n and r["outcome"] in list(COLOUR)[: list(COLOUR).index(outcome)] for r in rows) for n in names]
        axes.barh(range(len(names)), counts, left=before, color=colour, label=outcome)
    axes.set_yticks(range(len(names)), names, fontsize=8)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel("points")
    axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure


def embed(figure, folder, name):
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=120)
    plt.close(figure)
    with open(os.path.join(folder, name + ".png"), "wb") as file:
        file.write(memory.getvalue())
    return f'<img alt="{name}" src="data:image/png;base64,{base64.b64encode(memory.getvalue()).decode()}">'


def machine():
    try:
        with open("/proc/cpuinfo") as file:
            cpu = next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        cpu = platform.processor()
    here = os.path.dirname(os.path.abspath(__file__))
    asked = subprocess.run(["git", "-C", here, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    commit = asked.stdout.strip() if asked.returncode == 0 else "unknown"
    return f"{cpu}, {os.cpu_count()} cores, commit {commit}, {date.today()}"


def table(rows):
    out = []
    for name in dict.fromkeys(row["case"] for row in rows):
        out.append(f"<h3>{html.escape(name)}</h3><table><tr><th>parameter<th>value<th>outcome<th>force [N]<th>energy gained [J]<th>note</tr>")
        for r in (row for row in rows if row["case"] == name):
            out.append(f"<tr><td>{html.escape(r['parameter'])}<td>{html.escape(r['value'])}<td style='color:{COLOUR[r['outcome']]}'>{r['outcome']}"
                       f"<td class=n>{float(r['max_force']):.3g}<td class=n>{float(r['energy_growth']):.3g}<td>{html.escape(r['note'])}</tr>")
        out.append("</table>")
    return "\n".join(out)


def main():
    folder = sys.argv[1]
    rows = read(folder)
    pictures = []
    for name, figure, words in (
            ("outcomes", plot_outcomes(rows), "Outcomes"),
            ("delay", plot_stiffness(rows, "delay [ms]", False), "Largest stable stiffness of a wall whose force comes late"),
            ("delay_local", plot_stiffness(rows, "delay [ms], with local stiffness", False), "The same, the answer carrying the wall's stiffness"),
            ("rate", plot_stiffness(rows, "rate [Hz]", True), "Over the haptic rate"),
            ("quantisation", plot_stiffness(rows, "quantisation [m]", True), "Over the device's quantisation"),
            ("growth", plot_growth(rows), "Energy given to the hand"),
            ("taps", plot_taps(rows), "Fifty taps on an undamped duct, without the controller")):
        if figure:
            pictures.append(f"<h2>{words}</h2>{embed(figure, folder, name)}")
    counts = ", ".join(f"{sum(r['outcome'] == o for r in rows)} {o}" for o in COLOUR)
    with open(os.path.join(folder, "index.html"), "w") as file:
        file.write(f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Stability at the edge</title>
<style>body{{font:15px/1.45 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}}table{{border-collapse:collapse;width:100%;font-size:13px}}
td,th{{border-bottom:1px solid #ddd;padding:2px 8px;text-align:left;vertical-align:top}}td.n{{text-align:right;white-space:nowrap}}img{{max-width:100%}}h3{{margin:1.4em 0 .3em}}</style>
<h1>Stability at the edge</h1><p>{html.escape(machine())}</p><p>{len(rows)} points: {counts}.</p>
{''.join(pictures)}<h2>All points</h2>{table(rows)}</html>""")


if __name__ == "__main__":
    main()
