#!/usr/bin/env python3
"""Plots and pages of `palpate study`: study_page.py DIR.

DIR holds the figures of one scene (study.csv, depth.csv, course.csv, slide.csv, touch.csv, notes.csv, machine.txt), or folders
that do, of which an index is made; a growth.csv in DIR gets its plots too. Plots are written as PNG, and DIR/index.html holds all."""
import base64
import csv
import html
import math
import pathlib
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a word: its caller has one

import matplotlib
import matplotlib.ticker

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False,
                     "figure.dpi": 100})
COLOURS = ["#1b6ca8", "#c8553d", "#2a9d8f", "#8d6a9f", "#e09f3e", "#5c677d", "#6a994e", "#b5179e"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
KNOB_MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", ">", "h"]
MAIN = ["fine_linear", "all_modes_in_time", "finest_chain", "finest_insertion"]  # references of the first plot
MEANING = {
    "fine_linear": "the same frictionless contact, linear elasticity, on a mesh of the same shape that is much finer under the ball",
    "neo_hookean": "the same contact with large strain and rotation: compressible neo-Hookean tissue of the same E and ν, Newton's method",
    "same_mesh": "the same press of the same mesh without inertia: the static limit",
    "small_step": "the same model in double precision with RK4 and a sixteenth of the stable step: the time course of force and displacement",
    "cut_mesh": "a fresh solve of what the cut has left, under the same load",
    "all_modes": "the same shell with all of its modes, at rest",
    "all_modes_in_time": "the same shell with all of its modes: the time course of force and displacement",
    "finest_chain_in_time": "the same in its motion: force at the tip and displacement of the middle over time",
    "refined_all_modes": "a shell of four times as many triangles, with so many modes that more change nothing",
    "finest_insertion": "the same catheter led into the same duct, with several times the particles in ticks smaller by twice as much: length in the lumen "
                        "(as displacement) and force on the wall over time; the step is the catheter's in the duct",
    "finest_chain": "the same catheter with many more particles and a smaller step",
}
STYLE = """body{font:15px/1.45 system-ui,sans-serif;max-width:1060px;margin:24px auto;padding:0 16px;color:#222}
h1{font-size:22px;margin-bottom:2px}h2{font-size:17px;margin-top:28px}p.small,td,th{font-size:13px}.small{color:#555}
table{border-collapse:collapse;margin:8px 0}td,th{padding:2px 9px;border-bottom:1px solid #ddd;text-align:right;white-space:nowrap}
td.l,th.l{text-align:left}tr.front td{background:#eef5ea}img{max-width:100%}.wide{overflow-x:auto}"""


def read(path):
    if not path.exists():
        return []
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


def number(text):
    return float(text) if text not in ("", None) else math.nan


def known(row, *names):
    return all(math.isfinite(number(row[n])) for n in names)


def percent(text):
    value = number(text)
    if not math.isfinite(value):
        return ""
    return "%.3g %%" % (100 * value) if value >= 1e-4 else "%.0e" % value


def figures(text, digits=3):
    value = number(text)
    return "" if not math.isfinite(value) else f"%.{digits}g" % value


def size(text):
    value = number(text)
    if not math.isfinite(value):
        return ""
    return f"{value / 1e6:.3g} MB" if value >= 1e6 else f"{value / 1e3:.3g} kB"


def label(row):
    if row["knob"] == "model":
        return row["value"]
    return "as it is" if row["knob"] == "scene" else f'{row["knob"]}: {row["value"]}'


def front(points):
    """Indices of the points (x, y) that no other beats in both."""
    best, chosen = math.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            best = points[i][1]
            chosen.append(i)
    return chosen


def main_references(rows):
    there = {r["reference"] for r in rows if known(r, "step_us_p99", "err_u_rel")}
    return [m for m in MAIN if m in there]


def method_styles(rows):
    methods = list(dict.fromkeys(r["method"] for r in rows))
    return {m: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, m in enumerate(methods)}


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)
    return folder / f"{name}.png"


def knob_markers(rows):
    """"as it is" is a star; every other knob has its own marker."""
    knobs = [k for k in dict.fromkeys(kind(r) for r in rows) if k != "as it is"]
    return {"as it is": "*"} | {k: KNOB_MARKERS[i % len(KNOB_MARKERS)] for i, k in enumerate(knobs)}


def kind(row):
    return "as it is" if row["knob"] in ("scene", "model") else row["knob"]


def stairs(axis, points):
    """The front as the boundary of what is reached: nothing measured lies below and left of it. Leaves room for labels."""
    low_x, high_x = axis.get_xlim()
    low_y, high_y = axis.get_ylim()
    axis.set_xlim(low_x / 1.3, high_x * 2.5)
    more = max(1, math.sqrt(10 * low_y / high_y))  # at least a decade
    axis.set_ylim(low_y / 1.6 / more, high_y * 1.5 * more)
    x = [points[0][0]] + [p[0] for p in points] + [axis.get_xlim()[1]]
    y = [axis.get_ylim()[1]] + [p[1] for p in points] + [points[-1][1]]
    axis.step(x, y, where="post", color="#444", lw=1, zorder=0, label="Pareto front")
    for line in (axis.xaxis, axis.yaxis):
        line.set_major_formatter(plain)
        low, high = line.get_view_interval()
        line.set_minor_formatter(plain_minor if high < 100 * low else matplotlib.ticker.NullFormatter())


def plain(value, _):
    return f"{value:g}"


def plain_minor(value, _):
    """Of the values between the decades 2 and 5 are written."""
    return f"{value:g}" if round(value / 10 ** math.floor(math.log10(value) + 1e-9)) in (2, 5) else ""


def plot_pareto(all_rows, folder):
    references = main_references(all_rows)
    if not references:
        return None
    lines = 1 + max(len({kind(r) for r in all_rows}), len({r["method"] for r in all_rows})) // 5
    figure, grid = plt.subplots(len(references), 2, figsize=(10, 4.3 * len(references) + 0.5 + 0.2 * lines), squeeze=False)
    for axes, reference in zip(grid, references):
        rows = [r for r in all_rows if r["reference"] == reference and known(r, "step_us_p99", "err_u_rel")]
        for axis, key, title in [(axes[0], "err_u_rel", "displacement"), (axes[1], "err_f_rel", "force")]:
            pareto_panel(axis, [r for r in rows if known(r, key) and number(r[key]) > 0], key, all_rows)
            axis.set_title(f"{title}, against {reference}", fontsize=10)
    shown = [r for r in all_rows if r["reference"] in references and known(r, "step_us_p99", "err_u_rel")]
    styles, markers = method_styles(all_rows), knob_markers(all_rows)
    handles = [plt.Line2D([], [], marker="s", ls="none", color=styles[m][0], label=m) for m in dict.fromkeys(r["method"] for r in shown)]
    handles += [plt.Line2D([], [], marker=markers[k], ls="none", color="#777", label=k) for k in dict.fromkeys(kind(r) for r in shown)]
    handles += [plt.Line2D([], [], color="#444", lw=1, label="Pareto front of the medians"), plt.Line2D([], [], color="#999", lw=0.8, label="up to the 99th percentile")]
    rows_of_legend = (len(handles) + 4) // 5
    share = (0.22 * rows_of_legend + 0.1) / figure.get_figheight()
    figure.legend(handles=handles, loc="lower center", ncol=5, frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, share, 1, 1))
    figure.savefig(folder / "pareto.png")
    plt.close(figure)
    return folder / "pareto.png"


def pareto_panel(axis, rows, key, all_rows):
    points = [(number(r["step_us_median"]), 100 * number(r[key])) for r in rows]
    styles, markers = method_styles(all_rows), knob_markers(all_rows)
    for (x, y), r in zip(points, rows):
        colour = styles[r["method"]][0]
        axis.plot([x, max(x, number(r["step_us_p99"]))], [y, y], "-", color=colour, lw=0.8, alpha=0.35, zorder=1)
        star = kind(r) == "as it is"
        axis.plot([x], [y], markers[kind(r)], color=colour, ms=11 if star else 6, alpha=0.8, ls="none", zorder=3 if star else 2)
    axis.set(xscale="log", yscale="log", xlabel="time of a step [µs]: median, line to the 99th percentile", ylabel="relative error [%]")
    if not points:
        return
    chosen = front(points)
    stairs(axis, [points[i] for i in chosen])
    place_labels(axis, [(points[i], label(rows[i])) for i in chosen], points)


def place_labels(axis, labels, points):
    """Each where it covers neither a point nor another label, if there is such a place among a few."""
    boxes = [(x - 4, y - 4, x + 4, y + 4) for x, y in (axis.transData.transform(p) for p in points)]
    area = axis.get_window_extent()
    for point, text in labels:
        x, y = axis.transData.transform(point)
        wide, best = 4.3 * len(text), None
        for dx, dy in [(6, 7), (6, -15), (-wide - 6, -15), (-wide - 6, 7), (6, 19), (6, -27), (-wide - 6, -27), (6, 31), (6, -39), (16, 45)]:
            box = (x + dx, y + dy, x + dx + wide, y + dy + 13)
            hit = sum(box[0] < o[2] and o[0] < box[2] and box[1] < o[3] and o[1] < box[3] for o in boxes)
            hit += 3 * (box[0] < area.x0 or box[2] > area.x1 or box[1] < area.y0 or box[3] > area.y1)
            if best is None or hit < best[0]:
                best = (hit, dx, dy, box)
        boxes.append(best[3])
        lead = {"arrowstyle": "-", "lw": 0.5, "color": "#999"} if abs(best[2]) > 16 else None
        axis.annotate(text, point, textcoords="offset pixels", xytext=best[1:3], fontsize=7.5, color="#222", zorder=4, arrowprops=lead)


def mean_range(rows, key):
    by_depth = {}
    for r in rows:
        by_depth.setdefault(number(r["depth_per_radius"]), []).append(100 * abs(number(r[key])))
    depths = sorted(by_depth)
    return depths, [sum(by_depth[d]) / len(by_depth[d]) for d in depths], [min(by_depth[d]) for d in depths], [max(by_depth[d]) for d in depths]


def depth_curves(rows):
    """What is drawn over depth: title, rows, style."""
    def of(reference, test):
        return [r for r in rows if r["reference"] == reference and test(r)]
    as_is = lambda r: r["knob"] == "scene"
    curves = [("being linear at all (same mesh, same contact)", of("neo_hookean", lambda r: r["method"].endswith("reference")), "#c8553d", "-")]
    for i, method in enumerate(dict.fromkeys(r["method"] for r in rows if as_is(r))):
        colour = ["#1b6ca8", "#2a9d8f", "#8d6a9f", "#e09f3e"][i % 4]
        mine = lambda r, m=method: r["method"] == m and as_is(r)
        curves.append((f"{method}, against fine linear", of("fine_linear", mine), colour, "--"))
        curves.append((f"{method}, against neo-Hookean", of("neo_hookean", mine), colour, ":"))
        for other, dash in [("all_modes", "--"), ("refined_all_modes", ":")]:
            curves.append((f"{method}, against {other.replace('_', ' ')}", of(other, mine), colour, dash))
    return [c for c in curves if c[1]]


def plot_depth(rows, folder):
    curves = depth_curves(rows)
    if not curves:
        return None
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.8))
    for axis, key, title in [(axes[0], "err_u_rel", "displacement"), (axes[1], "err_f_rel", "contact force")]:
        for text, mine, colour, dash in curves:
            depths, mean, low, high = mean_range(mine, key)
            axis.plot(depths, mean, dash, color=colour, marker="o", ms=3.5, lw=2.2 if dash == "-" else 1.4, label=text)
            if dash == "-":
                axis.fill_between(depths, low, high, color=colour, alpha=0.15, lw=0)
        axis.set(xlabel="indentation depth / radius of the ball [1]", ylabel="relative error [%]", title=title)
        axis.set_ylim(bottom=0)
    handles = axes[0].get_legend_handles_labels()
    rows_of_legend = (len(curves) + 2) // 3
    figure.legend(*handles, loc="lower center", ncol=3, frameon=False, fontsize=8)
    figure.suptitle("Error over depth: mean over the patches" + ("; the band spans them" if any(c[3] == "-" for c in curves) else ""), fontsize=10)
    figure.tight_layout(rect=(0, 0.045 * rows_of_legend + 0.01, 1, 1))
    figure.savefig(folder / "depth.png")
    plt.close(figure)
    return folder / "depth.png"


def plot_force(rows, folder):
    """Force over depth at the first patch."""
    first = [r for r in rows if r["patch"] == "0"]
    law = [r for r in first if r["method"].endswith("reference") and r["reference"] == "neo_hookean"]
    if not law:
        return None
    figure, axis = plt.subplots(figsize=(5.6, 4.2))
    x = lambda mine: [1e3 * number(r["depth_m"]) for r in mine]
    axis.plot(x(law), [number(r["reference_force_N"]) for r in law], "-", color="#222", lw=2, label="neo-Hookean")
    axis.plot(x(law), [number(r["force_N"]) for r in law], "-", color="#c8553d", label="linear, same mesh")
    fine = [r for r in first if r["reference"] == "fine_linear"]
    mine = [r for r in fine if r["method"] == fine[0]["method"] and label(r) == label(fine[0])] if fine else []
    axis.plot(x(mine), [number(r["reference_force_N"]) for r in mine], "--", color="#c8553d", label="linear, fine mesh")
    for i, method in enumerate(dict.fromkeys(r["method"] for r in fine if r["knob"] in ("scene", "model"))):
        at = [r for r in fine if r["method"] == method and r["knob"] in ("scene", "model")]
        axis.plot(x(at), [number(r["force_N"]) for r in at], MARKERS[i], color=COLOURS[i], ms=5 + 2.5 * i, mfc="none", mew=1.4, label=f"{method}, as run")
    axis.set(xlabel="indentation depth [mm]", ylabel="force on the ball [N]", title="Force of one press (first patch)")
    axis.legend(frameon=False, fontsize=8)
    return save(figure, folder, "force")


def plot_course(rows, folder):
    """Presses and pulls in motion in one picture, insertions in another."""
    led = [r for r in rows if r["method"].endswith(" insertion")]
    others = [r for r in rows if not r["method"].endswith(" insertion")]
    return [draw_course(others, folder, "course", "displacement of the pressed place", "contact force"),
            draw_course(led, folder, "insertion", "length in the lumen", "force on the wall")]


def draw_course(rows, folder, name, of_displacement, of_force):
    keys = list(dict.fromkeys((r["method"], r["knob"], r["value"]) for r in rows))
    keys = [k for k in keys if k[1] in ("scene", "model", "integrator", "step", "element", "modes", "particles")]
    if not keys:
        return None
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.6))
    for i, (method, knob, value) in enumerate(keys[:8]):
        mine = [r for r in rows if (r["method"], r["knob"], r["value"]) == (method, knob, value)]
        time = [1e3 * number(r["time_s"]) for r in mine]
        text = method if knob in ("scene", "model") else f"{method}, {knob} {value}"
        for axis, key in [(axes[0], "displacement_m"), (axes[1], "force_N")]:
            scale = 1e3 if key == "displacement_m" else 1
            axis.plot(time, [scale * number(r[key]) for r in mine], color=COLOURS[i % 8], lw=1.2, label=text)
            if i == 0:
                axis.plot(time, [scale * number(r["reference_" + key]) for r in mine], "--", color="#222", lw=1.2, label="reference of the first", zorder=9)
    axes[0].set(xlabel="time [ms]", ylabel=f"{of_displacement.split()[0]} [mm]", title=of_displacement)
    axes[1].set(xlabel="time [ms]", ylabel="force [N]", title=of_force)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncol=3, frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0.05 * ((min(len(keys), 8) + 3) // 3) + 0.01, 1, 1))
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)
    return folder / f"{name}.png"


def plot_slide(rows, folder):
    """Force over path without friction and with it, and what holds the tool back."""
    settings = list(dict.fromkeys((r["method"], r["knob"], r["value"]) for r in rows))
    if not settings:
        return None
    figure, axes = plt.subplots(3, 1, figsize=(10, 9.6), sharex=True)
    panels = [(0, "force_N", "force without friction [N]"), (0.3, "force_N", "force with friction 0.3 [N]"),
              (0.3, "tangential_N", "along the motion, on the tool [N]")]
    for axis, (friction, key, title) in zip(axes, panels):
        for i, setting in enumerate(settings):
            mine = [r for r in rows if (r["method"], r["knob"], r["value"]) == setting and number(r["friction"]) == friction]
            as_is = setting[1] in ("scene", "model")
            text = setting[0] if as_is else f"{setting[0]}, {setting[1]} {setting[2]}"
            axis.plot([1e3 * number(r["path_m"]) for r in mine], [number(r[key]) for r in mine], color=COLOURS[i % 8], lw=1.8 if as_is else 0.9,
                      zorder=3 if as_is else 2, label=text)
        if friction == 0:
            axis.plot([1e3 * number(r["path_m"]) for r in mine], [number(r["reference_force_N"]) for r in mine], "--", color="#222", lw=1.2, zorder=4, label="fine linear")
        axis.axvspan(min(1e3 * number(r["path_m"]) for r in rows), 0, color="#888", alpha=0.12, lw=0)
        axis.set(ylabel=title)
    axes[0].set_title("Force over the path of a ball that is led over the surface at half its radius deep, 50 mm/s (shaded: run-up)", fontsize=10)
    axes[0].set_ylim(bottom=0)
    axes[1].set_ylim(bottom=0)
    axes[2].set(xlabel="path [mm]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncol=3, frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0.022 * ((len(settings) + 3) // 3) + 0.01, 1, 1))
    figure.savefig(folder / "slide.png")
    plt.close(figure)
    return folder / "slide.png"


def plot_growth(rows, folder):
    groups = list(dict.fromkeys(r["what"] for r in rows))
    if not groups:
        return None
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.6))
    for axis, what in zip(axes.flat, groups):
        mine = [r for r in rows if r["what"] == what]
        x, median, p99 = ([number(r[k]) for r in mine] for k in ("size", "step_us_median", "step_us_p99"))
        axis.plot(x, median, "o-", color=COLOURS[0], label="median")
        axis.plot(x, p99, "s:", color=COLOURS[1], label="99th percentile")
        power = exponent(x, median)
        axis.set(xscale="log", yscale="log")
        low, high = min(median), max(p99)
        if high < 10 * low:  # a flat line shall look flat
            axis.set_ylim(low / math.sqrt(20 * low / high), high * math.sqrt(20 * low / high))
        axis.set(xscale="log", yscale="log", xlabel=mine[0]["unit"], ylabel="step [µs]",
                 title=f"{what}: exponent {power:.2f}")
        axis.title.set_size(9)
        for line in (axis.xaxis, axis.yaxis):
            line.set_major_formatter(plain)
            low, high = line.get_view_interval()
            line.set_minor_formatter(plain_minor if high < 100 * low else matplotlib.ticker.NullFormatter())
        axis.legend(frameon=False, fontsize=8)
    for axis in list(axes.flat)[len(groups):]:
        axis.axis("off")
    return save(figure, folder, "growth")


def exponent(x, y):
    """Slope of the upper half of the points in the logarithms, by least squares."""
    pairs = [(math.log(a), math.log(b)) for a, b in zip(x, y)][len(x) // 2 - 1:]
    mx, my = (sum(p[k] for p in pairs) / len(pairs) for k in (0, 1))
    return sum((a - mx) * (b - my) for a, b in pairs) / sum((a - mx) ** 2 for a, _ in pairs)


def picture(path, text):
    data = base64.b64encode(path.read_bytes()).decode()
    return f'<img alt="{html.escape(text)}" src="data:image/png;base64,{data}">'


def table(head, rows, classes=None):
    cell = lambda tag, text, left: f'<{tag}{" class=l" if left else ""}>{html.escape(text)}</{tag}>'
    lines = ["<div class=wide><table><tr>" + "".join(cell("th", h, i < 3) for i, h in enumerate(head)) + "</tr>"]
    for n, r in enumerate(rows):
        lines.append(f'<tr{" class=front" if classes and classes[n] else ""}>' + "".join(cell("td", c, i < 3) for i, c in enumerate(r)) + "</tr>")
    return "\n".join(lines) + "</table></div>"


def figure_table(rows, reference):
    mine = [r for r in rows if r["reference"] == reference]
    timed = [i for i, r in enumerate(mine) if known(r, "step_us_p99", "err_u_rel", "err_f_rel")]
    points = [(number(mine[i]["step_us_median"]), max(number(mine[i]["err_u_rel"]), number(mine[i]["err_f_rel"]))) for i in timed]
    best = {timed[i] for i in front(points)}
    head = ["method", "knob", "value", "step median [µs]", "p99 [µs]", "offline [s]", "memory", "error of displacement", "error of force"]
    cells = [[r["method"], r["knob"], r["value"], figures(r["step_us_median"]), figures(r["step_us_p99"]), figures(r["offline_s"]), size(r["memory_bytes"]),
              percent(r["err_u_rel"]), percent(r["err_f_rel"])] for r in mine]
    return table(head, cells, [i in best for i in range(len(mine))])


def touch_table(rows):
    head = ["method", "knob", "value", "friction", "mean force [N]", "ripple", "jump", "turn", "buzz", "spread"]
    cells = [[r["method"], r["knob"], r["value"], r["friction"], figures(r["mean_force_N"])] + [percent(r[m]) for m in ("ripple", "jump", "turn", "buzz", "spread")]
             for r in rows]
    return table(head, cells)


def place_table(depth):
    """Each place once."""
    places = {r["patch"]: r for r in depth}
    head = ["place", "x [m]", "y [m]", "z [m]", "normal", "nearest node"]
    return table(head, [[p, figures(r["x_m"], 5), figures(r["y_m"], 5), figures(r["z_m"], 5), " ".join(figures(r[n]) for n in ("nx", "ny", "nz")), r["node"]]
                        for p, r in sorted(places.items())])


def linearity_sentence(rows):
    """Where the error of being linear is assessed and where it is not."""
    sentences = []
    if any(r["reference"] == "neo_hookean" for r in rows):
        sentences.append("The error of being linear at all is assessed for solid bodies, by presses at rest up to half the ball's radius; "
                         "large motion of whole organs, viscosity and the tissue's own law beyond neo-Hookean are not.")
    if any(r["knob"] == "correction" for r in rows):
        sentences.append("The quasi non-linear correction follows measured curves, which are not the references' tissue of the scene's E and ν: the difference "
                         "from them is mostly that between two tissues, and the row <i>correction: off</i> is the one that the references judge.")
    if any("modal_shell" in r["method"] for r in rows):
        sentences.append("For the thin wall the error of being linear (large rotations, ovalling, buckling) is <b>not assessed</b>: its references are linear shells.")
    if any("catheter" in r["method"] for r in rows):
        led = any(r["reference"] == "finest_insertion" for r in rows)
        sentences.append("The catheter turns and bends without limit, but its material is linear; that error, the wall's own errors under it and the law of friction are "
                         "<b>not assessed</b>." + (" How far it goes in and how it leans on the wall is, against more particles in smaller ticks." if led else
                                                   " Nor is wall contact: it is led into no duct here."))
    apart = [r["method"] for r in rows if r["knob"] == "connection"]
    if apart:
        sentences.append(f"<b>Not assessed</b> is the body of {', '.join(apart)}: its two meshes meet at some nodes only, and such a body has no converged solution "
                         "to compare with (points that hold a continuum give way without end as its mesh gets finer).")
    if any(r["reference"] == "small_step" for r in rows):
        sentences.append("The time courses of moving tissue are compared with the same spatial model in small steps: they say nothing about the mesh or about being linear.")
    return " ".join(sentences)


def scene_page(folder, rows):
    depth, course, notes = read(folder / "depth.csv"), read(folder / "course.csv"), read(folder / "notes.csv")
    slides, touches = read(folder / "slide.csv"), read(folder / "touch.csv")
    name = rows[0]["scene"]
    pictures = [(plot_pareto(rows, folder), "error against run time"),
                (plot_depth(depth, folder), "error over depth"), (plot_force(depth, folder), "force over depth"), (plot_slide(slides, folder), "force over path"),
                *((path, "time course") for path in plot_course(course, folder))]
    machine = "<br>".join(map(html.escape, (folder / "machine.txt").read_text().splitlines())) if (folder / "machine.txt").exists() else ""
    parts = [f"<h1>{html.escape(name)}</h1><p class=small>{machine}</p><p>{linearity_sentence(rows)}</p>"]
    budget = folder / "budget.txt"
    if budget.exists():
        parts.append(f"<p><b>{html.escape(budget.read_text().strip())}</b></p>")
    parts += [f"<p>{picture(path, text)}</p>" for path, text in pictures if path]
    if depth:
        parts.append("<h2>Where it was pressed</h2><p class=small>Against the normal at that point of the surface; the node is the mesh's nearest one.</p>" + place_table(depth))
    if touches:
        parts.append("<h2>How a slide feels</h2><p class=small>Of the force after the run-up, as shares of its mean: <i>ripple</i>, root mean square about the curve of "
                     "<i>fine linear</i>, scaled to it; <i>jump</i>, largest change from one tick to the next; <i>turn</i>, ticks in which the tool is pushed along its motion "
                     "by more than 0.002 of the force; <i>buzz</i>, root mean square between 100 and 500 Hz. <i>Spread</i>, of presses at places all over the triangles of the "
                     "pressed places, against the reference: largest less least over mean.</p>" + touch_table(touches))
    for ref in dict.fromkeys(r["reference"] for r in rows if r["reference"]):
        parts.append(f"<h2>Against {ref}</h2><p class=small>{MEANING.get(ref, '')}. Errors are root mean squares of relative errors; rows on the Pareto front "
                     "of the median time and the larger of both errors are shaded.</p>" + figure_table(rows, ref))
    if notes:
        parts.append("<h2>Notes</h2>" + table(["method", "knob", "value", "note"], [[n["method"], n["knob"], n["value"], n["text"]] for n in notes])
                     .replace("<td>", "<td class=l>"))
    (folder / "index.html").write_text(page(f"{name}: error against run time", "\n".join(parts)))


def page(title, body):
    return f"<!doctype html><meta charset=utf-8><title>{html.escape(title)}</title><style>{STYLE}</style>\n{body}\n"


def index_page(folder, scenes):
    head = ["scene", "method", "as run", "step median [µs]", "p99 [µs]", "memory", "error of displacement", "error of force", "reference", "being linear (displacement, force)"]
    cells, parts = [], ["<h1>Error against run time</h1>"]
    for sub, rows in scenes:
        law = next((r for r in rows if r["knob"] == "law" and known(r, "err_u_rel")), None)
        linear = f'{percent(law["err_u_rel"])}, {percent(law["err_f_rel"])}' if law else "not assessed"
        for r in rows:
            if r["knob"] == "scene" and r["reference"] in ("fine_linear", "all_modes_in_time", "refined_all_modes", "finest_chain", "finest_insertion"):
                cells.append([sub.name, r["method"], label(r), figures(r["step_us_median"]), figures(r["step_us_p99"]), size(r["memory_bytes"]), percent(r["err_u_rel"]), percent(r["err_f_rel"]),
                              r["reference"], linear if r["reference"] == "fine_linear" else "not assessed"])
        if not any(known(r, "err_u_rel") for r in rows):
            cells.append([sub.name, rows[0]["method"], "not assessed, see its page"] + [""] * (len(head) - 3))
    text = table(head, cells)
    for sub, _ in scenes:
        text = text.replace(f"<td class=l>{html.escape(sub.name)}</td>", f'<td class=l><a href="{sub.name}/index.html">{html.escape(sub.name)}</a></td>')
    if scenes:
        parts.append("<p class=small>Each scene as it is written; its page has all other settings.</p>" + text)
    growth = plot_growth(read(folder / "growth.csv"), folder)
    if growth:
        parts.append("<h2>How a step's cost grows</h2><p class=small>Slopes are fitted to the larger half of the sizes.</p>" + picture(growth, "growth"))
    for sub, _ in scenes:
        parts += [f'<h2><a href="{sub.name}/index.html">{html.escape(sub.name)}</a></h2>']
        parts += [picture(sub / f"{name}.png", name) for name in ("pareto", "depth") if (sub / f"{name}.png").exists()]
    (folder / "index.html").write_text(page("Error against run time", "\n".join(parts)))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    rows = read(folder / "study.csv")
    if rows:
        return scene_page(folder, rows)
    scenes = [(f.parent, read(f)) for f in sorted(folder.glob("*/study.csv"))]
    index_page(folder, [(sub, r) for sub, r in scenes if r])


if __name__ == "__main__":
    main()
