"""Writes the tables and the picture of the shell elements: shell_plots.py CASES.csv [docs/shell.md].

CASES.csv is what bench_shell_cases writes to the path that it is given. The tables stand between the two marker lines of the
document and are replaced as a whole; the picture goes to pictures/shell_convergence.png beside the document."""
import csv
import math
import pathlib
import sys

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

BEGIN, END = "<!-- shell_plots.py begins -->", "<!-- shell_plots.py ends -->"
TITLES = {
    "scordelis_lo": "Scordelis-Lo roof",
    "pinched_cylinder": "pinched cylinder, end diaphragms",
    "hemisphere": "pinched hemisphere, closed",
    "twisted_in_plane": "twisted beam, t = 0.32, in plane",
    "twisted_out_of_plane": "twisted beam, t = 0.32, out of plane",
    "thin_twisted_in_plane": "twisted beam, t = 0.0032, in plane",
    "thin_twisted_out_of_plane": "twisted beam, t = 0.0032, out of plane",
    "clamped_hypar": "clamped hypar, t = 0.01",
    "square_plate_pressure": "square plate, pressure",
    "square_plate_force": "square plate, force",
    "long_plate_pressure": "plate 2 × 10, pressure",
    "long_plate_force": "plate 2 × 10, force",
}
SHOWN_MESHES = (4, 8, 16, 32, 64)


def read_cases(path):
    """{(element, case): {"target": t, mesh: (value, error, dofs)}} in the order of the file."""
    cases = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            case = cases.setdefault((row["element"], row["case"]), {"target": float(row["target"])})
            case[int(row["mesh"])] = (float(row["value"]), float(row["error"]), int(row["dofs"]))
    if not cases:
        sys.exit(f"shell_plots.py: {path} has no rows")
    return cases


def meshes(case):
    return sorted(n for n in case if n != "target")


def order(case, at):
    """By how many powers of two the step of the value shrinks when the cells are halved, at the mesh `at`."""
    if not {at, at // 2, at // 4} <= case.keys():
        return None
    steps = [abs(case[n][0] - case[n // 2][0]) for n in (at // 2, at)]
    return math.log2(steps[0] / steps[1]) if min(steps) > 0 else None


def orders(case):
    values = [order(case, n) for n in meshes(case)[-2:]]
    return ", ".join("–" if v is None else f"{v:.1f}".replace("-", "−") for v in values)


def percent(error):
    return f"{'+' if error > 0 else '−'}{abs(100 * error):.2f} %"


def table(cases, element):
    sizes = [n for n in SHOWN_MESHES if any(n in c for c in cases.values())]
    head = ["case", "target"] + [f"n = {n}" for n in sizes] + [f"value, n = {sizes[-1]}", "orders"]
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    for (kind, name), case in cases.items():
        if kind != element:
            continue
        errors = [percent(case[n][1]) if n in case else "–" for n in sizes]
        last = case[meshes(case)[-1]]
        lines.append("| " + " | ".join([TITLES[name], f"{case['target']:.6g}", *errors, f"{last[0]:.5g}", orders(case)]) + " |")
    return lines


def picture(cases, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True)
    for axis, element, title in zip(axes, ("discrete_kirchhoff", "polynomial"), ("discrete Kirchhoff", "polynomial (BHS01)")):
        for (kind, name), case in cases.items():
            if kind != element or name.startswith("long"):
                continue
            sizes = meshes(case)
            axis.loglog(sizes, [abs(case[n][1]) for n in sizes], marker="o", markersize=3, linewidth=1,
                        color=f"C{list(TITLES).index(name) % 10}", label=TITLES[name])
        axis.axhline(0.01, color="black", linewidth=0.8, linestyle=":")
        axis.set_xticks(sizes, [str(n) for n in sizes])
        axis.minorticks_off()
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("cells along a side n", fontsize=8)
        axis.tick_params(labelsize=8)
        axis.grid(linewidth=0.3)
    axes[0].set_ylim(1e-5, 2)
    axes[0].set_ylabel("|value / target − 1|", fontsize=8)
    axes[0].legend(fontsize=5.5, loc="lower left")
    figure.tight_layout()
    small_png.save(figure, path, dpi=90)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    document = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/shell.md")
    cases = read_cases(sys.argv[1])
    lines = ["Discrete-Kirchhoff bending:", "", *table(cases, "discrete_kirchhoff"), "",
             "The polynomial element, diagonals all alike:", "", *table(cases, "polynomial")]
    text = document.read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    document.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n" + END + after)
    picture(cases, document.parent / "pictures" / "shell_convergence.png")


if __name__ == "__main__":
    main()
