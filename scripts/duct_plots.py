#!/usr/bin/env python3
"""Writes the measured part of docs/duct.md and its picture: duct_plots.py ROWS.csv [docs/duct.md].

ROWS.csv holds what bench_duct_step prints, alone or among the rows of out/bench.csv. The text stands between two marker lines of
the document and is replaced as a whole; the picture goes to pictures/ beside it."""
import pathlib
import sys

import matplotlib
import small_png
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

BEGIN, END = "<!-- duct_plots.py begins -->", "<!-- duct_plots.py ends -->"


def read_rows(path):
    values, origin = {}, ""
    for line in open(path):
        cells = line.rstrip("\n").split(",")
        if cells[0] in ("duct_step", "run") and len(cells) >= 5 and cells[1] != "case":
            values[cells[0], cells[1], cells[2]] = float(cells[3])
            if len(cells) > 6:
                origin = f" ({cells[5]}, commit {cells[6]})"
    if ("duct_step", "insertion", "p50") not in values:
        sys.exit(f"duct_plots.py: {path} has no rows of bench_duct_step")
    return values, origin


def series(values, prefix):
    found = sorted((int(case[len(prefix):].rstrip("m")), v) for (bench, case, metric), v in values.items()
                   if bench == "duct_step" and metric == "p50" and case.startswith(prefix))
    return np.array(found).reshape(-1, 2).T


def line_through(x, y):
    slope, at_zero = np.polyfit(x, y, 1)
    worst = np.max(np.abs(slope * x + at_zero - y) / y)
    return slope, at_zero, worst


def draw(values, file):
    figure, axes = plt.subplots(1, 3, figsize=(9, 2.9), dpi=90, sharey=True)
    titles = [("modes", "modes kept"), ("particles", "particles"), ("depth", "inserted [mm]")]
    for axis, (prefix, label) in zip(axes, titles):
        x, y = series(values, prefix)
        axis.plot(x, y, "o", ms=4)
        if prefix != "depth" and len(x) > 1:
            slope, at_zero, _ = line_through(x, y)
            axis.plot(x, slope * x + at_zero, lw=1)
        axis.set_xlabel(label)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("haptic step, median [µs]")
    axes[0].set_ylim(0, 1.08 * max(series(values, prefix)[1].max() for prefix, _ in titles if len(series(values, prefix)[1])))
    figure.tight_layout()
    small_png.save(figure, file)


def words(values, origin):
    one = lambda metric: values["duct_step", "insertion", metric]
    text = [f"The scripted insertion, 50 modes, 60 particles, two forceps, steps with more than 5 mm inserted{origin}: median "
            f"{one('p50'):.0f} µs, p99 {one('p99'):.0f} µs, p99.9 {one('p999'):.0f} µs."]
    if ("run", "catheter_insertion", "haptic_hz") in values:
        text.append(f"Running with its picture (`palpate run --processes 2`): {values['run', 'catheter_insertion', 'haptic_hz']:.1f} Hz haptic, "
                    f"{values['run', 'catheter_insertion', 'visual_hz']:.1f} Hz visual.")
    for prefix, name in (("modes", "a mode"), ("particles", "a particle")):
        x, y = series(values, prefix)
        if len(x) > 2:
            slope, at_zero, worst = line_through(x, y)
            text.append(f"The step grows by {slope:.2f} µs {name} from {at_zero:.0f} µs; the points keep within {100 * worst:.0f} % of that line.")
    return "\n".join(text) + "\n\n![Cost of a step over modes, particles and depth](pictures/duct_step.png)"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    document = pathlib.Path(sys.argv[2] if len(sys.argv) == 3 else "docs/duct.md")
    values, origin = read_rows(sys.argv[1])
    text = document.read_text()
    begin, end = text.find(BEGIN), text.find(END)
    if begin < 0 or end < begin:
        sys.exit(f"duct_plots.py: {document} lacks its two marker lines")
    draw(values, document.parent / "pictures" / "duct_step.png")
    document.write_text(text[:begin] + BEGIN + "\n" + words(values, origin) + "\n" + text[end:])


main()
