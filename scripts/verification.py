"""Writes docs/verification.md and its pictures: verification.py BIN_DIR [DOCS_DIR [TABLES_DIR]] [--quick].

BIN_DIR is the folder of the built programs; bench_verification (solids), bench_shell_cases (shells) and
bench_modal_frequencies (free vibration) are run, and their tables stand on the page as they come. With TABLES_DIR they are kept there, and those that it has already are
not computed again."""
import collections
import csv
import math
import pathlib
import platform
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

NAMES = {"p1": "p1", "p1_refine1_locking_free": "p1 refine 1, locking-free", "p2": "p2", "p2_locking_free": "p2, locking-free"}
STYLE = {"p1": ("tab:red", "o"), "p1_refine1_locking_free": ("tab:orange", "s"), "p2": ("tab:blue", "^"),
         "p2_locking_free": ("tab:green", "D")}
TITLES = {"straight_beam_extension": "straight beam, extension", "straight_beam_in_plane": "straight beam, in plane",
          "straight_beam_out_of_plane": "straight beam, out of plane", "curved_beam_in_plane": "curved beam, in plane",
          "curved_beam_out_of_plane": "curved beam, out of plane", "cooks_membrane": "Cook's membrane", "nafems_le10": "NAFEMS LE10",
          "thick_cylinder_049": "thick cylinder, ν = 0.49", "thick_cylinder_0499": "thick cylinder, ν = 0.499",
          "thick_cylinder_04999": "thick cylinder, ν = 0.4999"}
SHELLS = {"scordelis_lo": "Scordelis-Lo roof", "pinched_cylinder": "pinched cylinder, diaphragms", "hemisphere": "pinched hemisphere, closed",
          "twisted_in_plane": "twisted beam, in plane", "twisted_out_of_plane": "twisted beam, out of plane",
          "thin_twisted_in_plane": "thin twisted beam, in plane", "thin_twisted_out_of_plane": "thin twisted beam, out of plane",
          "clamped_hypar": "clamped hypar", "square_plate_pressure": "square plate, pressure", "square_plate_force": "square plate, force",
          "long_plate_pressure": "plate 2 × 10, pressure", "long_plate_force": "plate 2 × 10, force"}
VIBRATIONS = {"plate_supported": "plate, simply supported", "plate_free": "plate, free", "cylinder": "cylinder",
              "tapered_membrane": "NAFEMS FV32, tapered membrane", "cantilever_strip": "cantilever strip, bending"}

INTRODUCTION = """# Verification

Written by `scripts/verification.py`; do not edit. Published and closed-form values beside ours, with the error and the mesh. The same cases run on coarse
meshes in the tests (`tests/reference`, `tests/shell`). Machine: {machine}.

"""
SOLIDS = """## Solids

p1 and p2 are linear and quadratic tetrahedra with straight edges, *locking-free* as in [offline.md](offline.md). n is the number of cells across the body: over width
and height of the beams, with 15 n along them; over each side of Cook's membrane (1 thick, half modelled, one layer); along the radius of
LE10 with 2 n around and n through the thickness; along radius and quarter of the cylinder. An order is log2 of the ratio of the last two errors; in brackets where the published value itself, being that of beam theory or of another mesh, is too coarse to tell.

- *Straight and curved beam*: MacNeal and Harder, "A proposed standard set of problems to test finite element accuracy", 1985. Values are the mean displacement of the loaded end. For the curved
  beam in plane, beam theory says π R³ / (4 E I) = 0.08854, 1.4 % more than the published 0.08734.
- *Cook's membrane*: E = 1, ν = 1/3, deflection of the middle of the free edge.
- *NAFEMS LE10*: σ_yy at (2, 0, 0.6) on the surface, where the stress is highest: the mean over the elements that meet there.
- *Thick cylinder*: mean radial displacement of the inner face. The mesh's chords are the circle's only error at second order, so that quadratic elements with straight edges are of second order here too.
  On this mirrored mesh p1 does not lock; on irregular ones it does, by several times ([offline.md](offline.md)).

"""
PATCH = """
### Patch tests and manufactured solutions

| test | outcome |
| --- | --- |
| constant stress of MacNeal and Harder (σ = 2000, τ = 400) on a cube of irregular tetrahedra, ν = 0.25, 0.4999, 0.4999999: p2, p1 refine 1, locking-free ones | exact to rounding, 1e-9 / (1 − 2 ν) (`FinePatch`) |
| the same, p1 on the mesh itself | exact to rounding (`Patch`) |
| harmonic cubic displacement under its exact tractions, energy norm, irregular cubes of 4 and 8 cells | order 1.0 (p1), 2.0 (p2) (`FineConvergence`) |
| disc near incompressibility, irregular mesh | [offline.md](offline.md) (`Disc`) |
| Timoshenko cantilever, bar, thick cylinder | `Cantilever`, `Bar`, `ThickCylinder` |
| Hertz | [contact.md](contact.md), [offline.md](offline.md) (`Hertz`) |

NAFEMS LE11 needs a thermal load, which nothing else here does: left out.

"""
WRONG = """## Where the method is simply not right

- **Linear tetrahedra** are too stiff in bending and near incompressibility, by several times: see p1 above. What moves with inertia (tensor-mass, hybrid) has no other element; `palpate check` warns from ν = 0.48.
- **Mean dilatation in bending** with one element across is too soft at moderate ν (12 % in the straight beam): take plain `p2` there.
- **Point forces**: the displacement under one grows without limit as the mesh is refined. Only patches of at least two elements mean anything.
- **The polynomial bending element** (BHS01 app. A) is singular for right isosceles triangles with the right angle at their first node, and refused there: [shell.md](shell.md).
- **Flat shell triangles** on double curvature converge slowly where membrane and bending are coupled (thin hypar, hemisphere): table above.
- **Stress at a corner node** is first order at best with straight edges (LE10).
- **Linear elasticity at depth**: strains beyond some 10 % are not assessed on this page; `palpate study` shows the error of being linear over the depth of a press.
- **Contact** is collocated at nodes: where a tip covers fewer than about a dozen, its force depends on its place between them by 10 % and more.
"""


def read(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def run(binary, *arguments):
    return subprocess.run([binary, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def percent(error):
    return f"{100 * error:+.2f} %".replace("-", "−")


def order(coarse, fine):
    return math.log2(abs(coarse / fine)) if coarse and fine else float("nan")


def solid_cases(rows):
    """{case: (target, {element: [(n, unknowns, value, error)]})} in the order of the file."""
    cases = collections.OrderedDict()
    for row in rows:
        target, value = float(row["target"]), float(row["value"])
        elements = cases.setdefault(row["case"], (target, collections.OrderedDict()))[1]
        elements.setdefault(row["element"], []).append((int(row["n"]), int(row["unknowns"]), value, value / target - 1))
    return cases


def solid_table(cases):
    lines = ["| case | published | element | n | unknowns | ours | error | errors on coarser meshes | order |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for name, (target, elements) in cases.items():
        for element, points in elements.items():
            n, unknowns, value, error = points[-1]
            rate = f"{order(points[-2][3], error):.1f}".replace("-", "−")
            if abs(error) < 0.015 and "cylinder" not in name:
                rate = f"({rate})"
            coarser = ", ".join(f"{percent(p[3])} (n = {p[0]})" for p in points[:-1])
            lines.append(f"| {TITLES[name]} | {target:.6g} | {NAMES[element]} | {n} | {unknowns} | {value:.5g} | {percent(error)} | {coarser} | {rate} |")
    return "\n".join(lines).replace("-5.38e+06", "−5.38e6").replace("| -4", "| −4").replace("| -5", "| −5") + "\n"


def plot(cases, path):
    shown = [name for name in cases if "extension" not in name]
    figure, axes = plt.subplots(3, 3, figsize=(11, 9.5), sharey=True)
    for axis, name in zip(axes.flat, shown):
        for element, points in cases[name][1].items():
            colour, marker = STYLE[element]
            axis.loglog([1 / p[0] for p in points], [100 * abs(p[3]) for p in points], color=colour, marker=marker, label=NAMES[element])
        finest = min(1 / p[0] for p in points)
        coarsest = max(1 / p[0] for p in points)
        axis.loglog([finest, coarsest], [0.05, 0.05 * (coarsest / finest) ** 2], color="0.6", linestyle="--", linewidth=1, label="order 2")
        axis.set_xticks([1 / p[0] for p in points], [f"1/{p[0]}" for p in points])
        axis.minorticks_off()
        axis.set_title(TITLES[name], fontsize=10)
        axis.grid(True, color="0.9")
    for axis in axes[-1]:
        axis.set_xlabel("1 / n")
    for axis in axes[:, 0]:
        axis.set_ylabel("|error| [%]")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=5, frameon=False)
    figure.tight_layout(rect=(0, 0.04, 1, 1))
    figure.savefig(path, dpi=110)
    plt.close(figure)


def shell_section(rows):
    cases = collections.OrderedDict()
    for row in rows:
        if row["element"] == "discrete_kirchhoff":
            cases.setdefault(row["case"], []).append((int(row["mesh"]), int(row["dofs"]), float(row["value"]), float(row["target"]), float(row["error"])))
    lines = ["## Shells\n", "The discrete-Kirchhoff triangle, n × n cells; more in [shell.md](shell.md).\n",
             "| case | published | ours | error | n | dofs | error at n / 2 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for name, points in cases.items():
        n, dofs, value, target, error = points[-1]
        lines.append(f"| {SHELLS.get(name, name)} | {target:.6g} | {value:.6g} | {percent(error)} | {n} | {dofs} | {percent(points[-2][4])} |")
    return "\n".join(lines) + "\n\n"


def vibration_section(output):
    values = collections.OrderedDict()
    for line in output.splitlines():
        _, case, metric, value, unit = line.split(",")
        if unit == "Hz" and metric.startswith(("mode", "expected")):
            values.setdefault(case, {})[metric] = float(value)
    lines = ["## Free vibration\n", "Frequencies of shells [Hz] against closed forms and published values; more in [modes.md](modes.md).\n",
             "| case | published | ours | worst error |", "| --- | --- | --- | --- |"]
    for case, found in values.items():
        count = sum(1 for key in found if key.startswith("mode"))
        expected = [found[f"expected{i + 1}"] for i in range(count) if f"expected{i + 1}" in found]
        ours = [found[f"mode{i + 1}"] for i in range(len(expected))]
        worst = max((o / e - 1 for o, e in zip(ours, expected)), key=abs)
        lines.append(f"| {VIBRATIONS.get(case, case.replace('_', ' '))} | {', '.join(f'{e:.4g}' for e in expected)} | "
                     f"{', '.join(f'{o:.4g}' for o in ours)} | {percent(worst)} |")
    return "\n".join(lines) + "\n\n"


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def tables_of(binaries, folder, quick):
    """Runs what the folder has no table of."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = {name: folder / f"{name}.csv" for name in ("solids", "shells", "vibrations")}
    for name, program in (("solids", "bench_verification"), ("shells", "bench_shell_cases")):
        if not paths[name].exists():
            unfinished = paths[name].with_suffix(".part")
            run(binaries / program, *quick, unfinished)
            unfinished.rename(paths[name])
    if not paths["vibrations"].exists():
        paths["vibrations"].write_text(run(binaries / "bench_modal_frequencies", *quick))
    return solid_cases(read(paths["solids"])), read(paths["shells"]), paths["vibrations"].read_text()


def main():
    arguments = [a for a in sys.argv[1:] if not a.startswith("-")]
    if not arguments:
        sys.exit(__doc__)
    quick = ["--quick"] if "--quick" in sys.argv else []
    docs = pathlib.Path(arguments[1] if len(arguments) > 1 else pathlib.Path(__file__).parent.parent / "docs")
    with tempfile.TemporaryDirectory() as folder:
        tables = pathlib.Path(arguments[2] if len(arguments) > 2 else folder)
        cases, shells, vibrations = tables_of(pathlib.Path(arguments[0]).resolve(), tables, quick)
    (docs / "pictures").mkdir(parents=True, exist_ok=True)
    plot(cases, docs / "pictures" / "verification_solids.png")
    page = INTRODUCTION.format(machine=machine()) + SOLIDS + solid_table(cases)
    page += "\n![Errors of the solids over the mesh size](pictures/verification_solids.png)\n" + PATCH
    page += "\n" + shell_section(shells) + vibration_section(vibrations) + WRONG
    (docs / "verification.md").write_text(page)


if __name__ == "__main__":
    main()
