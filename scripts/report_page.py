#!/usr/bin/env python3
"""The page of `palpate report`: report_page.py DIR.

DIR holds report.json, course_N.csv and the pictures that it names. DIR/index.html holds all of it."""
import base64
import csv
import html
import io
import json
import pathlib
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a word: its caller has one

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False})
COLOURS = ["#1b6ca8", "#c8553d", "#2a9d8f", "#8d6a9f", "#e09f3e", "#5c677d"]
ROWS = [  # key, words, unit, factor, digits
    ("seconds", "time", "s", 1, 2),
    ("path_m", "path of the tip", "mm", 1e3, 0),
    ("economy", "economy: straight lines from touch to touch over the way taken in free air", "%", 100, 0),
    ("jerk_m_s3", "jerk of the tip, rms", "m/s³", 1, 2),
    ("touches", "touches", "", 1, 0),
    ("touching_s", "touching", "s", 1, 2),
    ("force_max_n", "largest force", "N", 1, 3),
    ("force_mean_n", "mean force while touching", "N", 1, 3),
    ("impulse_n_s", "impulse of the force", "N s", 1, 3),
    ("force_change_max_n", "largest change of force in a step", "N", 1, 4),
]
FLAGS = {
    "force_limited": "with the force at its limit",
    "slew_limited": "with the force's rise limited",
    "fault": "with a fault, the force off",
    "stale_model": "without news of moving tissue, the force fading",
    "passivity_limited": "damped by the passivity controller",
    "silent_device": "without news of the device, the force fading",
    "late_tissue": "with moving tissue felt whose time was late",
    "implausible_force": "with a force refused that the tissue cannot give",
}
STYLE = """body{font:15px/1.45 system-ui,sans-serif;max-width:1060px;margin:24px auto;padding:0 16px;color:#222}
h1{font-size:22px}h2{font-size:17px;margin-top:28px}table{border-collapse:collapse}td,th{padding:3px 10px;border-bottom:1px solid #ddd;
text-align:left;font-size:13px;vertical-align:top}td.n{text-align:right;white-space:nowrap}img{max-width:100%}
.strip{display:grid;grid-template-columns:repeat(auto-fill,minmax(230px,1fr));gap:8px}.strip figure{margin:0}figcaption{font-size:12px;color:#555}
.small{font-size:13px;color:#555}"""


def read_course(file):
    """By tool: times [s], places [mm], forces [N]."""
    tools = {}
    with open(file, newline="") as lines:
        for row in csv.DictReader(lines):
            time, place, force = tools.setdefault(row["tool"], ([], [], []))
            time.append(float(row["time"]))
            place.append([1e3 * float(row[axis]) for axis in "xyz"])
            force.append(float(row["force"]))
    return tools


def embed(data, words):
    return f'<img alt="{html.escape(words)}" src="data:image/png;base64,{base64.b64encode(data).decode()}">'


def picture_of(figure, words):
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=110)
    plt.close(figure)
    return embed(memory.getvalue(), words)


def session_name(sessions, i):
    name = pathlib.Path(sessions[i]["log"]).stem
    names = [pathlib.Path(s["log"]).stem for s in sessions]
    return name if names.count(name) == 1 else sessions[i]["log"]


def force_plot(sessions, courses, tool):
    figure, axes = plt.subplots(figsize=(9.5, 2.8), constrained_layout=True)
    for i, course in enumerate(courses):
        if tool in course:
            axes.plot(course[tool][0], course[tool][2], color=COLOURS[i % len(COLOURS)], linewidth=1, alpha=0.85, label=session_name(sessions, i))
    axes.set_xlabel("time [s]")
    axes.set_ylabel("force on the hand [N]")
    axes.set_ylim(bottom=0)
    if len(sessions) > 1:
        axes.legend(frameon=False, fontsize=8)
    return picture_of(figure, f"force over time of {tool}")


def path_plot(sessions, courses, tool):
    """The tip's way from above and from the front; where it pressed, dots as large as the force."""
    figure, both = plt.subplots(1, 2, figsize=(9.5, 3.8), constrained_layout=True)
    strongest = max((max(c[tool][2], default=0) for c in courses if tool in c), default=0)
    for axes, (a, b) in zip(both, ((0, 1), (0, 2))):
        for i, course in enumerate(courses):
            if tool not in course:
                continue
            _, place, force = course[tool]
            colour = COLOURS[i % len(COLOURS)]
            axes.plot([p[a] for p in place], [p[b] for p in place], color=colour, linewidth=0.9, alpha=0.6, label=session_name(sessions, i))
            pressed = [k for k in range(0, len(place), max(1, len(place) // 3000)) if force[k] > 0]
            if strongest > 0:
                axes.scatter([place[k][a] for k in pressed], [place[k][b] for k in pressed], [40 * force[k] / strongest for k in pressed], color=colour,
                             alpha=0.25, linewidths=0)
        axes.set_xlabel("xyz"[a] + " [mm]")
        axes.set_ylabel("xyz"[b] + " [mm]")
        axes.set_aspect("equal", adjustable="datalim")
    if len(sessions) > 1:
        both[0].legend(frameon=False, fontsize=8)
    return picture_of(figure, f"path of {tool}")


def thinned(sessions, tool):
    """What a log that keeps enough does not tell of the force."""
    said = []
    for i, session in enumerate(sessions):
        steps = next((t.get("steps_per_force") for t in session["tools"] if t["name"] == tool), None)
        if steps:
            said.append(f"The log of {session_name(sessions, i)} has one force in {steps} steps: largest and mean force are those of these steps, and a peak "
                        "between two is not in them.")
    return "".join(f"<p class=small>{html.escape(s)}</p>" for s in said)


def figures_table(sessions, tool):
    found = [next((t for t in s["tools"] if t["name"] == tool), None) for s in sessions]
    head = "".join(f"<th>{html.escape(session_name(sessions, i))}" for i in range(len(sessions)))
    lines = [f"<table><tr><th>{head}</tr>"]
    for key, words, unit, factor, digits in ROWS:
        cells = "".join(f"<td class=n>{factor * t[key]:.{digits}f} {unit}" if t and key in t else "<td class=n>–" for t in found)
        lines.append(f"<tr><td>{words}{cells}</tr>")
    for flag, words in FLAGS.items():
        counts = [t.get("flags", {}).get(flag, 0) if t else 0 for t in found]
        if any(counts):
            lines.append(f"<tr><td>steps {words}" + "".join(f"<td class=n>{n}" for n in counts) + "</tr>")
    return "\n".join(lines) + "</table>"


def outcome(session):
    """Sentences on tissue and tasks."""
    said = []
    for lost in session.get("tissue", []):
        parts = [f"{lost[k]} {words}" for k, words in (("cut", "cut"), ("torn", "torn"), ("fallen", "fallen off")) if lost[k]]
        said.append(f"{lost['body']} lost tetrahedra: {', '.join(parts)}.")
    for cut in session.get("resections", []):
        said.append(f"Of what was to be cut off of {cut['body']}, {cut['cut_inside']} tetrahedra were cut ({1e6 * cut['cut_inside_m3']:.2f} ml); "
                    f"outside of it {cut['cut_outside']} ({1e6 * cut['cut_outside_m3']:.2f} ml).")
    for task in session.get("tasks", []):
        said.append(f"{task['body']} is {1e3 * task['inserted_m']:.0f} mm in, was {1e3 * task['deepest_m']:.0f} mm in after {task['inserting_s']:.1f} s; "
                    f"{task['wall_contacts']} touches of the wall, taken {task['grasps']} times, lost {task['drops']} times, largest force "
                    f"{task['force_max_n']:.2f} N.")
    if session["damage"]:
        said.append(session["damage"])
    return "".join(f"<p>{html.escape(s)}</p>" for s in said)


def strip(folder, session):
    pictures = "".join(f"<figure>{embed((folder / p['file']).read_bytes(), session['title'])}<figcaption>{p['time']:.1f} s</figcaption></figure>"
                       for p in session["pictures"])
    return f'<div class="strip">{pictures}</div>' if pictures else ""


def main():
    folder = pathlib.Path(sys.argv[1])
    sessions = json.loads((folder / "report.json").read_text())["sessions"]
    courses = [read_course(folder / s["course"]) for s in sessions]
    tools = list(dict.fromkeys(t["name"] for s in sessions for t in s["tools"]))
    body = [f"<h1>{html.escape(' / '.join(dict.fromkeys(s['title'] for s in sessions)))}</h1>"]
    for i, session in enumerate(sessions):
        body.append(f"<h2>{html.escape(session_name(sessions, i))}</h2>{outcome(session)}{strip(folder, session)}")
    for tool in tools:
        body.append(f"<h2>{html.escape(tool)}</h2>{figures_table(sessions, tool)}{thinned(sessions, tool)}{force_plot(sessions, courses, tool)}{path_plot(sessions, courses, tool)}")
    body.append("<p class=small>The force is the one that the hand got. Paths are those of the tip in the world, from above and from the front; dots mark "
                "where it pressed, larger ones harder.</p>")
    (folder / "index.html").write_text(f"<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
                                       f"<title>Report</title><style>{STYLE}</style>{''.join(body)}</html>")
    print(folder / "index.html")


if __name__ == "__main__":
    main()
