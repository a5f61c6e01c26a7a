"""The part of docs/latency.md about what a delay does to the force: tables and a plot. Called by latency_page.py."""
import csv
import pathlib
import re
import subprocess
import tempfile

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def force_errors(programs):
    """{hand and stiffness: {delay [ms]: rms error of the force [% of its peak]}}, as the closed-loop test prints them."""
    said = subprocess.run([programs / "test_haptic", "--gtest_filter=LocalModelInTheLoop.ItsForceFollows*"], check=True, capture_output=True, text=True).stdout
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in said.splitlines() if re.match(r"\| \w+ hand", line)]
    errors = {}
    for name, delay, _, _, share, *_ in rows:
        errors.setdefault(name, {})[float(delay)] = float(share)
    return errors


def stiffest(programs):
    """{case: {delay [ms]: largest stable stiffness [N/m]}} and the bound of theory, as `palpate stability` finds them."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([programs / "palpate", "stability", "-o", folder, "--only", "loop"], capture_output=True)  # 1: loops that fail, as they must
        rows = list(csv.DictReader(open(pathlib.Path(folder) / "stability.csv")))
    names = {("loop observer only", "delay [ms]"): "observed only", ("loop observer only", "delay [ms], with local stiffness"): "with local stiffness",
             ("loop controller", "delay [ms]"): "passivity controller"}
    found, bound = {}, {}
    for row in rows:
        name = names.get((row["case"], row["parameter"]))
        if not name:
            continue
        delay = float(row["value"])
        found.setdefault(name, {})[delay] = float(re.search(r"K_max=([\d.e+]+)", row["note"]).group(1))
        bound[delay] = float(re.search(r"bound=([\d.e+]+)", row["note"]).group(1))
    return found, bound


def draw(errors, found, bound, file):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    for (name, points), marker in zip(errors.items(), "osdo^v"):
        left.plot(list(points), list(points.values()), marker + ("-" if "5 kPa" in name else "--"), label=name, markersize=4)
    left.set(xlabel="added delay of the local models [ms]", ylabel="rms error of the force [% of its peak]", ylim=(0, None))
    shift = 0.5  # where a logarithm puts no delay
    delays = sorted(bound)
    right.plot([d + shift for d in delays], [bound[d] for d in delays], "k:", label="bound b / (T/2 + delay)")
    for (name, points), marker in zip(found.items(), "osd"):
        right.plot([d + shift for d in points], list(points.values()), marker + "-", label=name)
    right.set(xscale="log", yscale="log", xlabel="delay of the wall's answer [ms]", ylabel="largest stable stiffness [N/m]", xticks=[d + shift for d in delays],
              xticklabels=[f"{d:g}" for d in delays])
    right.minorticks_off()
    for axis in (left, right):
        axis.grid(True, color="0.92")
        axis.legend(frameon=False, fontsize=8)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
    figure.tight_layout()
    small_png.save(figure, file, dpi=110)


def section(programs, pictures):
    errors = force_errors(programs)
    found, bound = stiffest(programs)
    draw(errors, found, bound, pictures / "latency_force.png")
    delays = sorted(next(iter(errors.values())))
    lines = ["## What a delay does to the force", "",
             "The force of quasi-static organs, ducts and catheters is worked out in the haptic node: the network's delay does not touch it. That of moving tissue",
             "comes from local models of the deformation node ([local_contact.md](local_contact.md)). Its root mean square error against a hand in lock step with",
             "the full model, in % of the peak force, over the delay added to the models:", "",
             "| hand, Young's modulus | " + " | ".join(f"{d:g} ms" for d in delays) + " |", "| --- |" + " --- |" * len(delays)]
    lines += [f"| {name} | " + " | ".join(f"{points[d]:.2f}" for d in delays) + " |" for name, points in errors.items()]
    delays = sorted(bound)
    cell = lambda value: "" if value is None else ("1e6 at least" if value >= 1e6 else f"{value:.0f}")
    lines += ["", "The largest stiffness [N/m] of a wall at which a simulated hand comes to rest, over the delay of the wall's answer, by bisection up to 1e6 N/m",
              "([stability.md](stability.md) says whose hand and what the controller does):", "",
              "| | " + " | ".join(f"{d:g} ms" for d in delays) + " |", "| --- |" + " --- |" * len(delays),
              "| bound b / (T/2 + delay) | " + " | ".join(cell(bound[d]) for d in delays) + " |"]
    lines += [f"| {name} | " + " | ".join(cell(points.get(d)) for d in delays) + " |" for name, points in found.items()]
    return lines + ["", "![Error of the force and largest stable stiffness over delay](pictures/latency_force.png)", ""]
