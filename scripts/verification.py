"""Writes docs/verification.md and its pictures: verification.py BIN_DIR [DOCS_DIR [TABLES_DIR]] [--quick].

BIN_DIR is the folder of the built programs. bench_verification (solids), bench_shell_cases (shells) and
bench_modal_frequencies (free vibration) are run, and their tables stand on the page as they come; Hertz, the shells' patches
and the coarser meshes of the frequencies are what test_reference records of its tests. With TABLES_DIR all of these are
kept there, and those that it has already are not computed again."""
import collections
import csv
import itertools
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

NAMES = {"p1": "p1", "p1_refine1_locking_free": "p1 refine 1, locking-free", "p2": "p2", "p2_locking_free": "p2, locking-free"}
STYLE = {"p1": ("tab:red", "o"), "p1_refine1_locking_free": ("tab:orange", "s"), "p2": ("tab:blue", "^"),
         "p2_locking_free": ("tab:green", "D")}
TITLES = {"straight_beam_extension": "straight beam, extension", "straight_beam_in_plane": "straight beam, in plane",
          "straight_beam_out_of_plane": "straight beam, out of plane", "straight_beam_twist": "straight beam, twist",
          "curved_beam_in_plane": "curved beam, in plane",
          "curved_beam_out_of_plane": "curved beam, out of plane", "cooks_membrane": "Cook's membrane", "nafems_le10": "NAFEMS LE10",
          "thick_cylinder_049": "thick cylinder, ν = 0.49", "thick_cylinder_0499": "thick cylinder, ν = 0.499",
          "thick_cylinder_04999": "thick cylinder, ν = 0.4999", "kelvin_ahead": "Kelvin, ahead of the force",
          "kelvin_beside": "Kelvin, beside the force", "boussinesq_ahead": "Boussinesq, under the force",
          "boussinesq_beside": "Boussinesq, on the surface", "disc_03": "disc, ν = 0.3", "disc_04999": "disc, ν = 0.4999"}
CLOSED = ("kelvin", "boussinesq", "disc", "thick_cylinder")  # the same problem, solved exactly
BODIES = ["straight_beam_in_plane", "straight_beam_out_of_plane", "straight_beam_twist", "curved_beam_in_plane", "curved_beam_out_of_plane",
          "cooks_membrane", "nafems_le10", "thick_cylinder_049", "thick_cylinder_04999"]
FORCES = ["kelvin_ahead", "boussinesq_ahead", "disc_03", "kelvin_beside", "boussinesq_beside", "disc_04999"]
SHELLS = {"scordelis_lo": "Scordelis-Lo roof", "pinched_cylinder": "pinched cylinder, diaphragms", "hemisphere": "pinched hemisphere, closed",
          "pierced_hemisphere": "pinched hemisphere, 18° hole",
          "twisted_in_plane": "twisted beam, in plane", "twisted_out_of_plane": "twisted beam, out of plane",
          "thin_twisted_in_plane": "thin twisted beam, in plane", "thin_twisted_out_of_plane": "thin twisted beam, out of plane",
          "clamped_hypar": "clamped hypar", "square_plate_pressure": "square plate, pressure", "square_plate_force": "square plate, force",
          "long_plate_pressure": "plate 2 × 10, pressure", "long_plate_force": "plate 2 × 10, force"}
FV52 = (45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19)  # Hz
SOLID_VIBRATION = """A solid of the tetrahedra with lumped masses that moving tissue is made of, as `palpate modes` has it: NAFEMS FV52, a square plate 10 × 10 × 1 m of that steel,
held along z at the four edges of its bottom; published 45.897 (mode 4, after three motions of a rigid body), 109.44 twice, 167.89, 193.59 and 206.19 twice. The
published values are of a plate's theory; solids of published codes come to 44.6 to 44.8 Hz in mode 4, 3 % lower, so that the true errors in bending are some 3 % larger than these. Modes are
compared in their order. Linear elements need 32 cells a side and four through the thickness for bending within some 3 % of the published values, those with averaged strain
(`element = "nodal_strain"`) two layers for mode 4 and neither does with one. The plate hangs on lines, which hold a solid the less the finer its mesh is: so it goes on falling.

"""
VIBRATIONS = {"plate_supported": ("plate, simply supported", "28 × 28", "n14"), "plate_free": ("plate, free", "28 × 28", "n14"),
              "cylinder": ("cylinder between diaphragms", "64 × 40", "n32"),
              "tapered_membrane": ("NAFEMS FV32, tapered membrane", "28 × 28", "n14"),
              "cantilever_strip": ("cantilever strip, bending", "28 × 28", "n14")}

INTRODUCTION = """# Verification

Written by `scripts/verification.py`; do not edit. Published and closed-form values beside ours, with the error, the mesh and the measured order. The same cases
run on coarse meshes in the tests (`tests/reference`, `tests/shell`). Machine: {machine}. NAFEMS LE11 needs a thermal load, which nothing else here does: left out.
Stability, and the Colgate bound beside what a simulated hand bears, are [another page's matter](stability.md).

An order is log(e₁/e₂) / log(n₂/n₁) of the errors on the two finest meshes where the value is a closed form of the same problem or the error is above 2 %; else the
published value, being that of beam theory or of another mesh, is too coarse to tell, and e are the steps between the last three meshes. A dash: error or step
grows or changes its sign, so that there is no order to be measured.

"""
SOLIDS = """## Solids

p1 and p2 are linear and quadratic tetrahedra with straight edges, *locking-free* as in [offline.md](offline.md). n is the number of cells across the body: over width
and height of the beams, with 15 n along them; over each side of Cook's membrane (1 thick, half modelled, one layer); along the radius of
LE10 with 2 n around and n through the thickness; along radius and quarter of the cylinder; along each side of the cube of the last three. "Unknowns" are those of the
finest mesh.

- *Straight beam* (6 × 0.2 × 0.1, E = 1e7, ν = 0.3) and *curved beam* (radii 4.12 and 4.32, a quarter circle, 0.1 thick, ν = 0.25), unit loads: MacNeal and Harder,
  "A proposed standard set of problems to test finite element accuracy", 1985. Values are the mean displacement of the loaded end along the load. For the curved
  beam in plane, beam theory says π R³ / (4 E I) = 0.08854, 1.4 % more than the published 0.08734. The twist's target is Saint-Venant's L / (G J); the
  source prints 0.03208, other copies 0.03408. He lets the root's section warp, which the clamp does not.
- *Cook's membrane*: E = 1, ν = 1/3, unit shear, deflection of the middle of the free edge.
- *NAFEMS LE10*: thick elliptic plate under pressure, E = 210 GPa, ν = 0.3; σ_yy at (2, 0, 0.6) on the surface, where the stress is highest: the mean over the elements that
  meet there.
- *Thick cylinder*: radii 3 and 9, plane strain, E = 1000, unit pressure inside; mean radial displacement of the inner face. The mesh's chords are the circle's only
  error at second order, so that quadratic elements with straight edges are of second order here too.
  On this mirrored mesh p1 does not lock; on irregular ones it does, by several times ([offline.md](offline.md)).
- *Kelvin*: unit force inside an infinite body, E = 1, ν = 0.3; displacement along the force at 1/2 m, n / 2 elements away, ahead of it and beside it. An eighth of
  the surroundings is meshed out to 1 m, where the body is moved as the closed form says. *Boussinesq*: the same on the plane surface of half a body, a quarter of it.
- *Disc*: radius 1/4 m under uniform pressure on that surface, its mean displacement, 16 (1 − ν²) P / (3 π² E a). Inner nodes are moved by up to 0.2 h; the radius is
  n / 4 elements.

"""
NEAR = """
How far from a point force the answer may be trusted: elements between the force and the place from which on the error stays below 5 % (and below 2 %), on the finest
mesh. Nearer than that the answer is the mesh's. Under the force itself there is none: the displacement grows like 1/h. The far faces, 16 elements away, are held and hold
the error down with them; p1 sways from node to node with the mirrored pattern of its mesh, and a single dip is a change of sign.

"""
PATCH = """
### Patch tests

A unit cube of 4 × 4 × 4 cells, inner nodes moved by up to 0.2 h, whose faces move by a linear field of stress σ = 2000, τ = 400 (MacNeal and Harder; E = 1e6), the worst of three:
largest error over the largest value in units of rounding, 2.2e-16. Zero is exact.

"""
PATCH_NOTE = """
Near incompressibility rounding is felt with the factor 1 / (1 − 2ν), here 5000. Driven by tractions instead, all formulations
are exact to 1e-9 / (1 − 2ν) up to ν = 0.4999999 (`FinePatch`). A harmonic cubic displacement under its exact tractions, on irregular cubes of 4 and 8 cells, gives orders of the
energy norm 1.0 (p1) and 2.0 (p2) (`FineConvergence`).

"""
HERTZ = """
### Hertz

A frictionless tip of radius R is pressed by δ into a block of half-width and height 8 R (ν = 0.3) by the haptic step itself: F over (4/3) E/(1 − ν²) √R δ^(3/2). The tip's axis stands at four
places between the nodes, in steps of h at R = 2 h: (0, 0), (0.25, 0.1), (0.5, 0.25), (0.5, 0.5).

"""
HERTZ_NOTE = """
- At δ = R/2 the force on the mesh itself is within {worst:.1f} % of Hertz at every place from R = 2 h on; halving h to R / 4 moves the mean by {halved} %.
- The rest is not the mesh's alone. A sphere is not Hertz' paraboloid: its exact force (Sneddon) is {half:.3f} of Hertz at δ = R/2 and {quarter:.3f} at R/4. The block is not infinite:
  one of twice the size changes the force by {larger} % (p1, R = 2 h). And p1 is too stiff: see the disc above.
- **Not cured offline:** at R = 2 h nine nodes or fewer carry the contact, and which ones depends on the place. With p1 on the mesh itself the elements' stiffness happens to offset the
  lack of nodes; refined offline it shows, and the places spread from {low:.3f} to {high:.3f}. More nodes under the tip cure it, R = 4 h.
- Shallow presses hold fewer nodes still: at R/4 and R = 2 h four or five, and single places are off by {shallow:.0f} %.

"""
WRONG = """## Where the method is simply not right

### Elements

- **Linear tetrahedra** are too stiff in bending, in torsion and near incompressibility, by several times: see p1 above ({p1_beam} in the out-of-plane beam with four elements across,
  {p1_disc} under the disc at ν = 0.4999 with R = 4 h). What moves with inertia has `element = "nodal_strain"` beside them ([tissue.md](tissue.md#elements-that-do-not-lock)), but not where it is corotational; `palpate check` warns from ν = 0.48.
- **Mean dilatation in bending** with one element across is too soft at moderate ν (12 % in the straight beam): take plain `p2` there. Near point forces at ν = 0.3 it converges more slowly than
  plain `p2` too.
- **Curved shapes** are polygons. Offline refinement and quadratic elements keep the straight edges of the run-time mesh: errors of shape stay, at second order at best.
- **Stress** at a corner node is of first order (LE10). Displacement and force are what the elements are for.
- **Near incompressibility rounding grows** like 1 / (1 − 2ν): at ν = 0.4999 nine to eleven digits are left of a stress (patch tests), and by the same rule three fewer at 0.4999999.
- **One mesh is not the answer**: with p1 the same solid meshed otherwise differs by tenths to several per cent in stiffness ([models.md](models.md)).

### Forces and contact

- **Point forces**: the displacement under one grows without limit as the mesh is refined, and p1 is right to 5 % only from {near} elements on (table above). One held node's stiffness is
  proportional to E h and says nothing about the tissue. Only patches of at least two elements mean anything.
- **Contact is collocated at nodes**: where a tip covers fewer than about a dozen, its force depends on its place between them by 10 % and more, and better tensors do not cure it (Hertz above). A tip with R < h
  feels the mesh: `palpate check` says so, and the example liver's probe is several times off in force ([study.md](study.md)).
- **The α rule** of TVCG99 holds three nodes where one point is held: too stiff, kept for comparison.
- **Nearly dependent contacts** are softened by up to 2 % of their own compliance (flag `regularised`); many wedged rubbing contacts are relaxed, not solved to the end.
- **No body touches itself**, and none another but a catheter its duct; tools and catheter meet the duct's wall one after the other within a step.

### Law of the tissue

- **Linear elasticity at depth**: strain and rotation are taken as small. Volume grows under rotation, deep presses fold the surface. On the example scenes being linear costs 1 to 10 % of the force up to half the tip's radius
  against neo-Hookean tissue ([study.md](study.md)); for shells and catheters it is not assessed. Corotational elements cure rotations, not large strain, and only in tissue that moves.
- **The quasi non-linear correction** scales a linear field along measured curves of one specimen: it is neither in equilibrium nor conservative, and says nothing about directions and shapes that were not measured.
- **No viscosity, no anisotropy, no temperature, no prestress**: damping is proportional to mass or to modes, and is no property of tissue.
- **Springs are no discretisation of a material**: they answer every ν as 1/4, and differ by 11 to 22 % in the field from the solid that they stand for ([models.md](models.md)).

### Motion

- **Quasi-static bodies have no inertia**, so that a hybrid's quasi-static part follows at once; its connection nodes carry its lumped mass alone.
- **Lumped masses and p1** make short waves too slow and bodies that lock too fast. A thick plate's first frequency is {fv52_coarse} off on eight cells a side and {fv52_fine} on 32 (free vibration, above): a solid that bends needs some four elements through its thickness.
- **Kept modes alone** are too stiff where they are touched and return only a small share of a point load ([modes.md](modes.md)): residual flexibility mends rest, and in motion what is left out follows without swinging. The paper's force M Φ f is not what the hand gets.
- **Removed tetrahedra** leave steps of the mesh's size as the cut's faces.

### Shells and catheters

- **No shear through the thickness**: the discrete-Kirchhoff triangle is for thin walls. A thick one (t/R above some 0.1) comes out too stiff, and nothing here measures by how much.
- **Flat triangles** on double curvature converge slowly where membrane and bending are coupled: the thin twisted beam, the hemispheres and the hypar need 32 to 64 cells a side for 1 %.
- **The polynomial bending element** (BHS01 app. A) converges to another plate, 38 % too soft, and is singular for right isosceles triangles with the right angle at their first node, where it is refused: [shell.md](shell.md).
- **Linear shells neither buckle nor fold**; a pinched duct does not touch itself ([duct.md](duct.md)).
- **The catheter** is a chain of springs without torsion; at a touch it feels the wall's residual flexibility at that point alone.
"""


def read(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def run(binary, *arguments, **environment):
    return subprocess.run([binary, *map(str, arguments)], check=True, capture_output=True, text=True, env=os.environ | environment).stdout


def minus(text):
    return text.replace("-", "−")


def percent(error):
    return minus(f"{100 * error:+.2f} %")


def number(value, digits):
    """Significant digits, with a true minus sign in front."""
    text = f"{value:.{digits}g}".replace("e+0", "e")
    return "−" + text[1:] if text.startswith("-") else text


def two_digits(value):
    """12000 as 12,000."""
    place = 10 ** max(0, math.floor(math.log10(value)) - 1) if value > 0 else 1
    return f"{round(value / place) * place:,}" if value >= 10 else f"{value:.1f}"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def order(coarse, fine, ratio):
    """Order from two signed errors or steps; None where they grow or change their sign."""
    return math.log(coarse / fine) / math.log(ratio) if coarse * fine > 0 and abs(fine) < abs(coarse) else None


def shown(rate):
    return "–" if rate is None else minus(f"{rate:.1f}")


def order_of_steps(points):
    """From the values [(n, value)] of the last three meshes, each twice as fine as the one before."""
    if len(points) < 3:
        return None
    (_, a), (_, b), (_, c) = points[-3:]
    return order(a - b, b - c, 2)


def order_of_case(name, points):
    """Of [(n, unknowns, value, error)]."""
    if name.startswith(CLOSED) or abs(points[-1][3]) > 0.02:
        return order(points[-2][3], points[-1][3], points[-1][0] / points[-2][0])
    return order_of_steps([(p[0], p[2]) for p in points])


def solid_cases(rows):
    """{case: (target, {element: [(n, unknowns, value, error)]})} in the order of the file; patches have no error but their value."""
    cases = collections.OrderedDict()
    for row in rows:
        target, value = float(row["target"]), float(row["value"])
        elements = cases.setdefault(row["case"], (target, collections.OrderedDict()))[1]
        elements.setdefault(row["element"], []).append((int(row["n"]), int(row["unknowns"]), value, value / target - 1 if target else value))
    return cases


def solid_table(cases):
    rows = []
    for name in (name for name in cases if name in TITLES):
        target, elements = cases[name]
        for element, points in elements.items():
            n, unknowns, value, error = points[-1]
            coarser = ", ".join(f"{percent(p[3])} (n = {p[0]})" for p in points[:-1])
            rows.append([TITLES[name], number(target, 6), NAMES[element], str(n), str(unknowns), number(value, 5), percent(error), coarser,
                         shown(order_of_case(name, points))])
    return table(["case", "target", "element", "n", "unknowns", "ours", "error", "errors on coarser meshes", "order"], rows)


def trusted_from(points, bound):
    """The least distance in elements from which on all errors are below a bound."""
    wrong = [p[0] for p in points if abs(p[3]) >= bound]
    return max(wrong, default=0) + 1


def near_table(profiles):
    rows = [[NAMES[element], *(f"{trusted_from(elements[element], 0.05)} ({trusted_from(elements[element], 0.02)})" for elements in profiles.values())]
            for element in NAMES]
    return table(["element", *(TITLES[name] for name in profiles)], rows)


def patch_table(cases, records):
    rows = []
    for poisson, digits in (("0.25", "025"), ("0.4999", "04999")):
        for what in ("displacement", "stress"):
            elements = cases[f"patch_{digits}_{what}"][1]
            rows.append([f"{what}, ν = {poisson}", *(two_digits(elements[element][-1][2]) for element in NAMES)])
    text = table(["solids", *NAMES.values()], rows)
    return text + "\nThe discrete-Kirchhoff shell on irregular patches of 4 × 4 cells: constant strain " + \
        f"{float(records['patch_membrane']):.1f}, constant curvature {float(records['patch_bending']):.1f} units of rounding. The polynomial element fails: [shell.md](shell.md).\n"


def sphere_over_hertz(depth):
    """Sneddon's rigid sphere on a half space over Hertz' paraboloid; depth over radius."""
    low, high = 0.0, 0.999
    for _ in range(60):
        a = (low + high) / 2
        low, high = (a, high) if a / 2 * math.log((1 + a) / (1 - a)) < depth else (low, a)
    return ((1 + a * a) / 2 * math.log((1 + a) / (1 - a)) - a) / (4 / 3 * depth ** 1.5)


HERTZ_ROWS = [(f"{kind}_h{k}", title, depth, k) for kind, title, depth in
              (("p1", "p1", "R/2"), ("refined", "p1 refine 1", "R/2"), ("p1_shallow", "p1", "R/4")) for k in (2, 4, 8)]


def hertz_section(records):
    found = {key: [float(r) for r in records[key].split()] for key, *_ in HERTZ_ROWS + [("usual_block",), ("large_block",)] if key in records}
    mean = {key: sum(ratios) / len(ratios) for key, ratios in found.items()}
    rows = [[title, depth, str(k), ", ".join(f"{r:.3f}" for r in found[key]), f"{mean[key]:.3f}", percent(max((r - 1 for r in found[key]), key=abs))]
            for key, title, depth, k in HERTZ_ROWS if key in found]
    halved, larger = mean["p1_h4"] / mean["p1_h2"] - 1, mean["large_block"] / mean["usual_block"] - 1
    note = HERTZ_NOTE.format(half=sphere_over_hertz(0.5), quarter=sphere_over_hertz(0.25), halved=minus(f"{100 * halved:+.1f}"), larger=minus(f"{100 * larger:+.1f}"),
                             worst=100 * max(abs(r - 1) for key, ratios in found.items() if key.startswith("p1_h") for r in ratios),
                             low=min(found["refined_h2"]), high=max(found["refined_h2"]), shallow=100 * max(abs(r - 1) for r in found["p1_shallow_h2"]))
    return HERTZ + table(["tensors", "δ", "R / h", "F / Hertz at the places", "mean", "largest error"], rows) + \
        "\n![F over Hertz at the places](pictures/verification_hertz.png)\n" + note


def convergence(axis, elements, name, floor):
    """Errors of one case over the mesh size, with the measured orders in the elements' colours."""
    ns = sorted({p[0] for points in elements.values() for p in points})
    for i, (element, points) in enumerate(elements.items()):
        colour, marker = STYLE[element]
        axis.loglog([1 / p[0] for p in points], [100 * abs(p[3]) for p in points], color=colour, marker=marker, label=NAMES[element])
        axis.text(0.62 + 0.11 * i, 0.05, shown(order_of_case(name, points)), color=colour, transform=axis.transAxes, ha="center")
    axis.text(0.53, 0.05, "orders", color="0.3", transform=axis.transAxes, ha="right")
    axis.loglog([1 / ns[-1], 1 / ns[0]], [floor, floor * (ns[-1] / ns[0]) ** 2], color="0.6", linestyle="--", linewidth=1, label="slope of order 2")
    axis.set_xticks([1 / n for n in ns], [f"1/{n}" for n in ns])
    axis.minorticks_off()
    axis.set_title(TITLES[name], fontsize=10)
    axis.grid(True, color="0.9")


def finish(figure, axes, path, xlabel, ylabel, columns=5, foot=0.4):
    for axis in axes[-1]:
        axis.set_xlabel(xlabel)
    for axis in axes[:, 0]:
        axis.set_ylabel(ylabel)
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=columns, frameon=False)
    figure.tight_layout(rect=(0, foot / figure.get_figheight(), 1, 1))
    small_png.save(figure, path, dpi=110)
    plt.close(figure)


def plot_cases(cases, names, path, floor):
    rows = len(names) // 3
    figure, axes = plt.subplots(rows, 3, figsize=(11, 3.1 * rows + 0.4), sharey=True, squeeze=False)
    for axis, name in zip(axes.flat, names):
        convergence(axis, cases[name][1], name, floor)
    finish(figure, axes, path, "1 / n", "|error| [%]")


def plot_distance(profiles, path):
    figure, axes = plt.subplots(1, 4, figsize=(11, 3.5), sharey=True, squeeze=False)
    for axis, (name, elements) in zip(axes.flat, profiles.items()):
        for element, points in elements.items():
            colour, marker = STYLE[element]
            axis.semilogy([p[0] for p in points], [100 * abs(p[3]) for p in points], color=colour, marker=marker, markersize=4, linewidth=1, label=NAMES[element])
        axis.axhline(5, color="0.6", linestyle="--", linewidth=1, label="5 %")
        axis.set_xticks(range(2, points[-1][0] + 1, 2))
        axis.set_ylim(1e-3, 2e2)
        axis.set_title(TITLES[name], fontsize=10)
        axis.grid(True, color="0.9")
    finish(figure, axes, path, "elements from the force", "|error| [%]")


def plot_hertz(records, path):
    figure, axes = plt.subplots(1, 2, figsize=(8, 3.9), sharey=True, squeeze=False)
    for axis, depth in zip(axes.flat, ("R/2", "R/4")):
        axis.axhspan(0.9, 1.1, color="0.93", label="within 10 %")
        axis.axhline(1, color="0.6", linewidth=1)
        for kind, colour, marker, shift in (("p1", "tab:red", "o", 1), ("p1_shallow", "tab:red", "o", 1), ("refined", "tab:purple", "v", 1.05)):
            here = [(k, [float(r) for r in records[key].split()]) for key, _, d, k in HERTZ_ROWS if d == depth and key in records and key.rsplit("_", 1)[0] == kind]
            if not here:
                continue
            title = "p1 refine 1" if kind == "refined" else "p1"
            axis.plot([k * shift for k, ratios in here for _ in ratios], [r for _, ratios in here for r in ratios], color=colour, marker=marker, linestyle="", alpha=0.7,
                      label=f"{title}, each place")
            axis.plot([k * shift for k, _ in here], [sum(ratios) / len(ratios) for _, ratios in here], color=colour, label=f"{title}, mean")
        axis.set_xscale("log")
        axis.set_xticks([2, 4, 8], ["2", "4", "8"])
        axis.minorticks_off()
        axis.set_title(f"δ = {depth}", fontsize=10)
    finish(figure, axes, path, "elements to the tip's radius, R / h", "F / Hertz", 3, 0.6)


def shell_section(rows, records):
    cases = collections.OrderedDict()
    for row in rows:
        if row["element"] == "discrete_kirchhoff":
            cases.setdefault(row["case"], []).append((int(row["mesh"]), int(row["dofs"]), float(row["value"]), float(row["target"])))
    pierced = [(int(key.rsplit("n", 1)[1]), *reversed(value.split())) for key, value in records.items() if key.startswith("pierced_hemisphere")]
    cases["pierced_hemisphere"] = [(n, int(dofs), float(value), 0.0940) for n, dofs, value in sorted(pierced)]
    lines = []
    for name in SHELLS:
        points = cases[name]
        n, dofs, value, target = points[-1]
        lines.append([SHELLS[name], f"{target:.6g}", f"{value:.6g}", percent(value / target - 1), str(n), str(dofs), percent(points[-2][2] / target - 1),
                      shown(order_of_steps([(p[0], p[2]) for p in points]))])
    text = "## Shells\n\nThe discrete-Kirchhoff triangle, n × n cells (twisted beam: 3n × n); definitions and all meshes are in [shell.md](shell.md). Orders are those of the steps between the last\n" \
        "three meshes. Scordelis and Lo's roof comes to 0.3005 however it is meshed; some codes quote 0.3020. Where the order is a dash or near zero, the last steps are far smaller than what is said of the error.\n\n"
    return text + table(["case", "published", "ours", "error", "n", "dofs", "error at n / 2", "order"], lines) + "\n![Errors of the shells over the mesh size](pictures/shell_convergence.png)\n\n"


def vibration_section(output, records):
    values = collections.OrderedDict()
    for line in output.splitlines():
        _, case, metric, value, unit = line.split(",")
        if unit == "Hz" and metric.startswith(("mode", "expected")):
            values.setdefault(case, {})[metric] = float(value)
    rows = []
    for case, found in values.items():
        title, mesh, coarser = VIBRATIONS[case]
        expected = [found[f"expected{i + 1}"] for i in range(len(found) // 2)]
        ours = [found[f"mode{i + 1}"] for i in range(len(expected))]
        coarse = [float(f) for f in records[f"{case}_{coarser}"].split()]
        errors = [(o / e - 1, c / e - 1) for o, c, e in zip(ours, coarse, expected)]
        worst, worst_coarse = max((e[0] for e in errors), key=abs), max((e[1] for e in errors), key=abs)
        rows.append([title, ", ".join(f"{e:.4g}" for e in expected), ", ".join(f"{o:.4g}" for o in ours), mesh, percent(worst), percent(worst_coarse),
                     shown(order(worst_coarse, worst, 2))])
    text = "## Free vibration\n\nFrequencies of shells [Hz] against closed forms and published values (steel, E = 200 GPa, ν = 0.3, ρ = 8000; the strip is Euler and Bernoulli's with βL = 1.87510, 4.69409,\n" \
        "7.85476 and ν = 0); more in [modes.md](modes.md). The order is that of the worst error; FV32's is its fifth mode's, which comes down the slowest.\n\n"
    return text + table(["case", "published", "ours", "cells", "worst error", "on half the cells a side", "order"], rows) + "\n"


def fv52(records, cells, element="linear"):
    return [float(f) for f in records[f"fv52_{element}_n{cells}"].split()]


def solid_vibration_section(records):
    rows = []
    for element, cells in itertools.product(("linear", "nodal_strain"), (8, 16, 32)):
        ours = fv52(records, cells, element)
        errors = [o / e - 1 for o, e in zip(ours, FV52)]
        rows.append([f"`{element}`", f"{cells} × {cells} × {cells // 8}", ", ".join(f"{f:.4g}" for f in ours), percent(errors[0]), percent(max(errors, key=abs))])
    return SOLID_VIBRATION + table(["element", "cells", "modes 4 to 10 [Hz]", "error of mode 4", "worst error"], rows) + "\n"


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def recorded(test, path, long_form):
    """Runs the tests of test_reference that record figures of this page."""
    tests = "HertzReference.*:PublishedShells.*:Frequencies.*:SolidFrequencies.*"
    run(test, f"--gtest_filter={tests}", f"--gtest_output=json:{path}", **({"PALPATE_LONG_TESTS": "1"} if long_form else {}))


def tables_of(binaries, folder, quick):
    """Runs what the folder has no table of."""
    folder.mkdir(parents=True, exist_ok=True)
    makers = {"solids.csv": lambda path: run(binaries / "bench_verification", *quick, path),
              "shells.csv": lambda path: run(binaries / "bench_shell_cases", *quick, path),
              "vibrations.csv": lambda path: path.write_text(run(binaries / "bench_modal_frequencies", *quick)),
              "recorded.json": lambda path: recorded(binaries / "test_reference", path, not quick)}
    for name, make in makers.items():
        if not (folder / name).exists():
            unfinished = folder / f"{name}.part"
            make(unfinished)
            unfinished.rename(folder / name)
    suites = json.loads((folder / "recorded.json").read_text())["testsuites"]
    records = {key: value for suite in suites for test in suite["testsuite"] for key, value in test.items()}
    return solid_cases(read(folder / "solids.csv")), read(folder / "shells.csv"), (folder / "vibrations.csv").read_text(), records


def page(cases, profiles, shells, vibrations, records):
    solids = SOLIDS + solid_table(cases) + "\n![Errors of the solids over the mesh size](pictures/verification_solids.png)\n"
    forces = "\n![Errors of Kelvin, Boussinesq and the disc over the mesh size](pictures/verification_forces.png)\n" + NEAR + near_table(profiles) + \
        "\n![Errors over the distance from the force](pictures/verification_distance.png)\n"
    wrong = WRONG.format(p1_beam=percent(cases["straight_beam_out_of_plane"][1]["p1"][-1][3]), p1_disc=percent(cases["disc_04999"][1]["p1"][-1][3]),
                         near=max(trusted_from(elements["p1"], 0.05) for elements in profiles.values()),
                         fv52_coarse=percent(fv52(records, 8)[0] / FV52[0] - 1), fv52_fine=percent(fv52(records, 32)[0] / FV52[0] - 1))
    return INTRODUCTION.format(machine=machine()) + solids + forces + PATCH + patch_table(cases, records) + PATCH_NOTE + hertz_section(records) + \
        shell_section(shells, records) + vibration_section(vibrations, records) + solid_vibration_section(records) + wrong


def main():
    arguments = [a for a in sys.argv[1:] if not a.startswith("-")]
    if not arguments:
        sys.exit(__doc__)
    quick = ["--quick"] if "--quick" in sys.argv else []
    docs = pathlib.Path(arguments[1] if len(arguments) > 1 else pathlib.Path(__file__).parent.parent / "docs")
    with tempfile.TemporaryDirectory() as folder:
        tables = pathlib.Path(arguments[2] if len(arguments) > 2 else folder)
        cases, shells, vibrations, records = tables_of(pathlib.Path(arguments[0]).resolve(), tables, quick)
    pictures = docs / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    profiles = {name: cases[f"{name}_profile"][1] for name in FORCES if f"{name}_profile" in cases}
    plot_cases(cases, BODIES, pictures / "verification_solids.png", 0.05)
    plot_cases(cases, FORCES, pictures / "verification_forces.png", 0.02)
    plot_distance(profiles, pictures / "verification_distance.png")
    plot_hertz(records, pictures / "verification_hertz.png")
    (docs / "verification.md").write_text(page(cases, profiles, shells, vibrations, records))


if __name__ == "__main__":
    main()
