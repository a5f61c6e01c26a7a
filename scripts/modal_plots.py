#!/usr/bin/env python3
"""Writes the measured tables of docs/modes.md and its two pictures: modal_plots.py ROWS.csv [docs/modes.md].

ROWS.csv holds what bench_modal_accuracy and bench_modal_frequencies print, alone or among the rows of out/bench.csv. Each table stands between two
marker lines of the document and is replaced as a whole; the pictures go to pictures/ beside it."""
import pathlib
import sys

import matplotlib
import small_png
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

MODES = ["r5", "r10", "r20", "r50", "r100", "all"]
SIZE, DPI = (6.4, 3.6), 90


def read_rows(path):
    values, origin = {}, ""
    for line in open(path):
        cells = line.rstrip("\n").split(",")
        if cells[0] not in ("modal_accuracy", "modal_frequencies"):
            continue
        values[cells[1], cells[2]] = float(cells[3])
        if len(cells) > 6:
            origin = f"Measured on {cells[5]}, commit {cells[6]}."
    for case, bench in [("plate_free", "modal_frequencies"), ("condensed", "modal_accuracy")]:
        if not any(name == case for name, _ in values):
            sys.exit(f"modal_plots.py: {path} has no rows of {bench}")
    return values, origin


def percent(value):
    if value < 1e-6:
        return f"{value:.0e}"
    return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def number(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " --- |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows])


def frequencies(values):
    titles = {"plate_supported": "square plate, simply supported", "plate_free": "square plate, free",
              "cylinder": "cylinder between diaphragms", "tapered_membrane": "NAFEMS FV32, tapered membrane",
              "cantilever_strip": "cantilever strip, bending"}
    rows = []
    for case, title in titles.items():
        count = sum(1 for name, metric in values if name == case and metric.startswith("expected"))
        found = [values[case, f"mode{i + 1}"] for i in range(count)]
        known = [values[case, f"expected{i + 1}"] for i in range(count)]
        rows.append([title, ", ".join(f"{f:.3f}" for f in known), ", ".join(f"{f:.3f}" for f in found),
                     percent(values[case, "worst_error"]), f"{values[case, 'orthonormality']:.0e}",
                     f"{values[case, 'time']:.2g}"])
    return table(["", "known [Hz]", "found [Hz]", "worst", "orthonormality", "time [s]"], rows)


def accuracy(values):
    head = ["modes", "at rest: point, field", "tap: point, field", "with residual", "sudden push: point, field",
            "with residual", "share of M Φ f (r/n)", "step [µs]", "and field [µs]"]
    rows = []
    for name in MODES:
        pair = lambda what: f"{percent(values[name, what + '_point'])}, {percent(values[name, what + '_field'])}"
        rows.append([name.lstrip("r") if name != "all" else f"all {values['all', 'translations']:.0f}", pair("static"), pair("tap"),
                     pair("tap_residual"), pair("sudden"), pair("sudden_residual"),
                     f"{percent(values[name, 'force_share'])} ({percent(values[name, 'mode_share'])})",
                     number(values[name, "step"]), number(values[name, "step_field"])])
    return table(head, rows)


SCHEMES = [("dnios_dense", "DNIOS, dense as in the paper", "o-"), ("dnios_sparse", "DNIOS, sparse", "s-"),
           ("nirms_field", "NIRMS, 50 modes, with the whole field", "^-"), ("nirms", "NIRMS, 50 modes", "v-")]


def curve(values, metric):
    points = sorted((int(name[1:]), v) for (name, m), v in values.items() if m == metric and name[0] == "n")
    return np.array([n for n, _ in points]), np.array([v for _, v in points])


def exponent(n, time):
    return np.polyfit(np.log(n), np.log(time), 1)[0]


def cost(values):
    sizes = sorted(int(name[1:]) for name, m in values if m == "nirms")
    rows = [[f"{n}"] + [number(values[f"n{n}", m]) if (f"n{n}", m) in values else "–" for m, _, _ in SCHEMES]
            + [f"{values[f'n{n}', 'modes_time']:.2g}"] for n in sizes]
    rows.append(["grows as n to the power"] + [f"{exponent(*curve(values, m)):.2f}" for m, _, _ in SCHEMES] + [""])
    return table(["translations n"] + [f"{title} [µs]" for _, title, _ in SCHEMES] + ["50 modes offline [s]"], rows)


def condensed(values):
    v = {metric: value for (name, metric), value in values.items() if name == "condensed"}
    rows = [["all dofs, dense", number(v["factor_full"]), number(v["solve_full"])],
            ["condensed, dense", f"{number(v['condensing'])} + {number(v['factor_condensed'])}", number(v["solve_condensed"])],
            ["all dofs, sparse", number(v["factor_sparse"]), number(v["solve_sparse"])]]
    text = table([f"{v['translations']:.0f} translations, as many rotations", "condensing + factor [ms]", "solution [µs]"], rows)
    return text + (f"\n\nThe condensed solution differs from that of all dofs by {v['difference_full']:.0e} (dense) and "
                   f"{v['difference']:.0e} (sparse). Condensed, a dense solution takes "
                   f"{v['solve_full'] / v['solve_condensed']:.1f} times less time and a dense factorisation "
                   f"{v['factor_full'] / v['factor_condensed']:.1f} times less.")


def plot_errors(values, file):
    figure, axes = plt.subplots(figsize=SIZE)
    count = [int(name[1:]) for name in MODES[:-1]]
    for what, title, style in [("static_point", "at rest", "k^-"), ("tap_point", "tap", "C3o-"),
                               ("tap_residual_point", "tap, with residual flexibility", "C3o--"),
                               ("sudden_point", "sudden push", "C0s-"),
                               ("sudden_residual_point", "sudden push, with residual flexibility", "C0s--")]:
        axes.loglog(count, [values[name, what] for name in MODES[:-1]], style, label=title, markersize=4)
    axes.set(xlabel="modes", ylabel="error at the pushed point", title="")
    axes.set_xticks(count, [str(c) for c in count])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    save(figure, file)


def plot_cost(values, file):
    figure, axes = plt.subplots(figsize=SIZE)
    for metric, title, style in SCHEMES:
        n, time = curve(values, metric)
        axes.loglog(n, time, style, label=f"{title}: n^{exponent(n, time):.2f}", markersize=4)
    axes.set(xlabel="translations n", ylabel="time of a step [µs]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    save(figure, file)


def save(figure, file):
    file.parent.mkdir(exist_ok=True)
    figure.tight_layout()
    small_png.save(figure, file, dpi=DPI)
    print(f"{file}: {file.stat().st_size} bytes")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    values, origin = read_rows(sys.argv[1])
    document = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/modes.md")
    text = document.read_text()
    for name, make in [("frequencies", frequencies), ("accuracy", accuracy), ("cost", cost), ("condensed", condensed)]:
        begin, end = f"<!-- modal_plots.py: {name} begins -->", f"<!-- modal_plots.py: {name} ends -->"
        before, rest = text.split(begin)
        body = make(values) + (f"\n\n{origin}" if origin else "")
        text = before + begin + "\n" + body + "\n" + end + rest.split(end)[1]
    document.write_text(text)
    plot_errors(values, document.parent / "pictures" / "modal_errors.png")
    plot_cost(values, document.parent / "pictures" / "modal_cost.png")


if __name__ == "__main__":
    main()
