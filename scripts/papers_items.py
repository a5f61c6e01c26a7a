"""What the three papers print, the commands that make it here, and how each answer is read: the table of papers.py.

`values` takes a papers.Run and returns numbers by name; `judged` has the range of those that do not depend on the machine."""
import dataclasses
import math
import typing

HEIGHT, RADIUS = 0.013, 0.015  # [m] of the brain specimen
DEPTHS = (0.0013, 0.0026, 0.0039)  # [m] of fig. 13's presses
SPEEDS = ("500", "5", "0.005")  # [mm/min]


@dataclasses.dataclass(frozen=True, eq=False)
class Item:
    paper: str
    name: str
    claim: str
    ours: str
    differs: str = ""
    commands: tuple = ()
    values: typing.Callable = lambda run: {}
    judged: dict = dataclasses.field(default_factory=dict)
    pictures: tuple = ()
    short: tuple = ()  # commands in their place in the short form, which may give some of the values alone


def bench(name, suite=None, only=(), **names):
    """Values of a benchmark: names of ours for "case metric" of its suite, which mostly has its name. In the short form
    those of cases with a word of `only` in their names."""
    def values(run):
        rows = run.rows(suite or name)
        return {ours: rows[theirs] for ours, theirs in names.items() if not (run.is_short and only) or any(word in theirs for word in only)}
    command = f"bench_{name} --quick"
    return {"commands": (command,), "values": values, "short": tuple(f"{command} --only {word}" for word in only)}


def tests(program, cases):
    """The number of passed cases of a test program, of which none may fail."""
    return {"commands": (f"{program} --gtest_filter='{cases}'",), "values": lambda run: {"passed": run.number(r"\[  PASSED  \] (\d+) test")},
            "judged": {"passed": (1, math.inf)}}


def curve(run, name, x):
    """A measured curve's value at a displacement x [m], by straight lines."""
    lines = [line for line in (run.folder / name).read_text().splitlines() if line[:1].isdigit()]
    points = [tuple(map(float, line.split(","))) for line in lines]
    for (a, fa), (b, fb) in zip(points, points[1:]):
        if a <= x <= b * (1 + 1e-12):
            return fa + (fb - fa) * (x - a) / (b - a)
    raise ValueError(f"{name} does not reach {x}")


# ---- TVCG99

PLATE = "palpate solve scenes/plate.toml"
TWO_NEAR = "--hold 900:0,0,-0.001 --hold 904:0,0,-0.001"


def plate_difference(run):
    """Largest difference of the displacements of all nodes in both files, over the largest."""
    direct = {row["node"]: row for row in run.table("plate_direct.csv")}
    worst = largest = 0
    for row in run.table("plate_tensors.csv"):
        other = direct[row["node"]]
        worst = max(worst, max(abs(row[a] - other[a]) for a in ("ux", "uy", "uz")))
        largest = max(largest, math.hypot(row["ux"], row["uy"], row["uz"]))
    return {"difference": worst / largest}


def overshoot(run):
    """How far the first of two nodes goes, over how far it is held."""
    def moved(name):
        return next(row for row in run.table(name) if row["node"] == 900)
    plain, corrected = moved("plain.csv"), moved("corrected.csv")
    return {"plain": plain["uz"] / -0.001, "corrected": corrected["uz"] / -0.001, "force_ratio": plain["fz"] / corrected["fz"]}


def curves(run):
    fast, middling, slow = (curve(run, f"brain_force_{speed}mm_min.csv", 0.0039) for speed in SPEEDS)
    return {"force_500": fast, "force_5": middling, "force_slow": slow, "ratio": fast / slow, "radial": 1e3 * curve(run, "brain_radial.csv", 0.0039),
            "linear_radial": 1e3 * 0.45 * RADIUS * 0.3}


def pressed(run):
    """Force [N] and widening [m] of the pressed cylinder at each depth, and the worst of their errors against the measured ones."""
    values = {"force_error": 0, "radial_error": 0}
    for depth in DEPTHS:
        rows = run.table(f"press_{depth}.csv")
        force = -sum(row["fz"] for row in rows if abs(row["z"] - HEIGHT) < 1e-9)
        middle = [row for row in rows if abs(row["z"] - HEIGHT / 2) < 1e-9 and math.hypot(row["x"], row["y"]) > RADIUS - 1e-6]
        radial = sum(math.hypot(row["x"] + row["ux"], row["y"] + row["uy"]) - RADIUS for row in middle) / len(middle)
        for name, value, file in (("force", force, "brain_force_5mm_min.csv"), ("radial", radial, "brain_radial.csv")):
            values[f"{name}_{depth}"] = value
            values[f"{name}_error"] = max(values[f"{name}_error"], abs(value / curve(run, file, depth) - 1))
    return values


BRAIN_CURVES = "python3 scripts/brain_curves.py out/papers"

TVCG99 = [
    Item("TVCG99", "sec. 2, figs. 1-4", "180 slices; a simplex mesh of 14,000 triangles where marching cubes give 94,000.",
         "`palpate segment` takes grey values to labels slice by slice, and `palpate organ` labels to a surface and tetrahedra; [organ.md](organ.md) compares its triangles with those of marching cubes at the same distance, on another liver.",
         "The surface is a level of a smoothed distance, which has no steps, not a simplex mesh. They do not say at which distance they compare. Their image is not public."),
    Item("TVCG99", "sec. 3-3", "Linear elasticity is right up to displacements of about 10 % of the mesh's size.",
         "Under a ball pressed in by half its radius (3 mm) the linear force on a cylinder of 30 x 13 mm differs by {cylinder:+.0%} from that of neo-Hookean tissue, on a plate by {plate:+.1%}.",
         "No share of a size says it: strain and rotation do, and a monitor watches them ([nonlinear.md](nonlinear.md)).",
         **bench("linear_range", only=("plate",), cylinder="brain_cylinder_0.5R force_error", plate="plate_0.5R force_error"),
         judged={"cylinder": (-0.25, -0.1), "plate": (-0.05, 0)}),
    Item("TVCG99", "fig. 5, eq. 8-10", "A plate held at its corners under one contact, and under several combined by superposition.",
         "Two contacts through the tensors and through the full system solved afresh differ by {difference:.1e} of the displacement.",
         "eq. 10 prints u*: with it the force is wrong as soon as two nodes are held; ũ* is meant and taken. eq. 7 divides by the elementary displacement.",
         (f"{PLATE} {TWO_NEAR} --csv out/papers/plate_tensors.csv", f"{PLATE} {TWO_NEAR} --method direct --csv out/papers/plate_direct.csv"),
         values=plate_difference, judged={"difference": (0, 1e-8)}),
    Item("TVCG99", "figs. 6-9", "A cylinder of brain compressed at 500 mm/min: force and widening bend away from the linear ones and depend on the speed; fitted by polynomials of degree 4 to 10.",
         "At 30 % compression {force_500:.2f}, {force_5:.2f} and {force_slow:.2f} N at 500, 5 and 0.005 mm/min; the radius grows by {radial:.2f} mm, linearly (ν = 0.45) by {linear_radial:.2f} mm.",
         "The experiment's data are not public; the curves follow from the law that was fitted to them (Miller and Chinzei 1997). Fits are made in a scaled variable, must rise, and go on straight beyond the data.",
         (BRAIN_CURVES,), values=curves,
         judged={"force_500": (2, 4), "ratio": (3, 8), "radial": (2.9, 2.95)},
         pictures=(("papers_brain.png", "Force and widening of the cylinder over its compression, and the linear and quasi non-linear answer to it"),)),
    Item("TVCG99", "fig. 10", "Summed as they are, the answers to two held nodes go further than the nodes are held.",
         "Nodes 22 mm apart on the plate, each held 1 mm deep, go {plain:.2f} mm deep with {force_ratio:.2f} times the force; by eq. 8 {corrected:.6f} mm.",
         "", (f"{PLATE} {TWO_NEAR} --plain --csv out/papers/plain.csv", f"{PLATE} {TWO_NEAR} --csv out/papers/corrected.csv"),
         values=overshoot, judged={"plain": (1.5, 1.8), "corrected": (1 - 1e-9, 1 + 1e-9), "force_ratio": (1.3, 2)}),
    Item("TVCG99", "sec. 4-1", "The tensors take 7 min (193 vertices, 725 tetrahedra), 8 h (1,400 and 6,500) and 9 h (1,735 and 8,124), by conjugate gradients.",
         "*{small:.2f} s* (210 and 720), *{liver:.2f} s* (1,418 and 6,501), *{large:.2f} s* (1,728 and 7,986), *{box:.0f} s* (10,143 and 52,800). By conjugate gradients the liver takes *{cg3:.0f} s* at a residual of 1e-3, "
         "which leaves {error3:.1%} error, and *{cg9:.0f} s* at 1e-9.",
         "One sparse factorisation and blocks of right-hand sides: exact to rounding, for linear elements. What scenes take by default (quadratic elements offline) takes longer and costs nothing at run time ([offline.md](offline.md)).",
         **bench("precompute", only=("nodes210", "cg_tol1e-3", "cg_tol1e-9"), small="nodes210 wall", liver="liver1400 wall", large="nodes1728 wall", box="box10k wall", cg3="liver1400_cg_tol1e-3 wall",
               cg9="liver1400_cg_tol1e-9 wall", error3="liver1400_cg_tol1e-3 error", error9="liver1400_cg_tol1e-9 error"),
         judged={"error3": (1e-4, 0.05), "error9": (0, 1e-8)}),
    Item("TVCG99", "table 1", "A liver of 1,400 nodes under a contact: 15 s solved whole and 7 ms from tensors, linear; over 50 s and 8 ms, quasi non-linear.",
         "*{normal:.0f} ms* and *{fast:.4f} ms*; *{normal_bent:.0f} ms* and *{fast_bent:.4f} ms*.",
         "Whole: one sparse factorisation and solve in place of conjugate gradients. From tensors: the whole surface, and most of the time is for the dent "
         "under the tip, which is finer than the mesh.",
         **bench("table1", normal="liver1400_linear normal", fast="liver1400_linear accelerated", normal_bent="liver1400_quasi_nonlinear normal",
                 fast_bent="liver1400_quasi_nonlinear accelerated")),
    Item("TVCG99", "sec. 5, fig. 11", "Collision by buckets: 500 Hz without, 300 Hz with the mesh deformed and the buckets updated; one contact point.",
         "*{rest:.1f} µs* and *{deformed:.1f} µs* for the eight points of a tip: the loop runs at 1 kHz.",
         "Tips are spheres, shafts and jaws segments; contacts are as many as there are.",
         **bench("collision", rest="liver1400_rest p50", deformed="liver1400_deformed p50")),
    Item("TVCG99", "sec. 5, fig. 12", "A contact inside a triangle is spread over its three vertices by α.",
         "In the first press of the liver scene's motion, before the tip slides, the α rule asks for {alpha:.2f} N at most, the exact barycentric condition for {barycentric:.2f} N, the patch of the default for {patch:.2f} N.",
         "As printed, the sign in α moves the point up to 3 times too far; with it mended three nodes are held where one point is: too stiff. Where the tip slides its force jumps, and which way is up to the last digits of the tensors. `contact.rule = \"alpha\"` keeps it for comparison.",
         tuple(f"palpate drive scenes/liver.toml --seconds 3.2 --set contact.rule={rule} --json" for rule in ("alpha", "barycentric", "patch")),
         values=lambda run: {rule: run.figures(i)["tool.probe.force.max"] for i, rule in enumerate(("alpha", "barycentric", "patch"))},
         judged={"alpha": (0.6, 0.75), "barycentric": (0.5, 0.62), "patch": (0.39, 0.44)}),
    Item("TVCG99", "sec. 6-1, fig. 13", "A constant displacement on the cylinder's top: the simulated force and the widening at mid-height lie on the experimental curves exactly.",
         "At 10, 20 and 30 % compression the force is within {force_error:.1%} of the curve and the mean widening at mid-height within {radial_error:.2%}.",
         "The press is prescribed, as theirs; a plate as a tool is a tip of 200 m radius, which is flat to 0.6 µm over the top (`tests/sim/brain_cylinder_test.cpp` runs it through the haptic step). "
         "With ends that stick the linear curves are not the closed forms of sec. 3-4, and come from the specimen's own mesh.",
         (BRAIN_CURVES, *(f"palpate solve scenes/brain_cylinder.toml --hold top:0,0,-{d} --csv out/papers/press_{d}.csv" for d in DEPTHS)),
         values=pressed, judged={"force_error": (0, 0.005), "radial_error": (0, 0.002)}),
    Item("TVCG99", "sec. 6-2, figs. 14-17", "Two machines; force at 300 Hz and picture at 50 Hz with a liver of about 1,500 nodes, ribs drawn behind it; the tool's five degrees of freedom and the contacts cross.",
         "Two processes, 1,418 nodes: force at *{haptic:.1f} Hz*, picture at *{visual:.1f} Hz* and *{latency:.0f} ms* after the tool's position was read (median).",
         "Ribs are drawn, as theirs ([rendering.md](rendering.md)); two hosts: [deploy.md](deploy.md).",
         ("palpate run scenes/liver.toml --seconds 10 --processes 2 --summary out/papers/liver.json",),
         values=lambda run: {"haptic": run.document("liver.json")["haptic_node"]["rate_hz"], "visual": run.document("liver.json")["render_node"]["rate_hz"],
                      "latency": 1e-3 * run.document("liver.json")["render_node"]["latency_us_p50"]},
         short=("palpate run scenes/liver.toml --seconds 2 --processes 2 --summary out/papers/liver.json",)),
]

# ---- RR3510

HYBRID = "palpate drive scenes/cylinder_hybrid.toml --seconds 3 --json"
END = "body.cylinder.displacement.end"


def same_rest(run):
    """The sag of three hybrids over that of the whole body solved at rest."""
    rest = max(math.hypot(row["ux"], row["uy"], row["uz"]) for row in run.table("sag.csv"))
    sags = [run.figures(i)[END] for i in (1, 2, 3)]
    return {"sag": 1e3 * rest, "worst": max(abs(sag / rest - 1) for sag in sags)}


def conditions(run):
    """How far a load of 1 mN moves a node of each model [um], and what the hybrid cylinder's top carries of its weight [N]."""
    def moved(name):
        row = next(row for row in run.table(f"{name}.csv") if row["node"] == LOADED[name][1])
        return 1e6 * math.hypot(row["ux"], row["uy"], row["uz"])
    return {name: moved(name) for name in LOADED} | {"weight": sum(row["fz"] for row in run.table("weight.csv") if row["z"] > 0.05 - 1e-9),
                                                     "sag": run.number(r"sag: ([\d.]+) mm", -1)}


LOADED = {"quasi_static": ("plate", 902, ""), "tensor_mass": ("plate_cut", 40, " --method direct"),
          "hybrid": ("cylinder_hybrid", 40, " --method direct"), "shell": ("duct_poke", 40, "")}

RR3510 = [
    Item("RR3510", "sec. 4, fig. 1", "500 Hz with a mesh of nearly 8,000 tetrahedra; the time is linear in the number of surface nodes.",
         "One superposition of 64 contacts over the liver's surface takes *{p50:.0f} µs*, at *{share:.1f}* times the bandwidth of a copy of the same size.",
         "Several contacts at once; the contacts' own forces come before that, at 1 kHz.",
         **bench("superpose", p50="liver1400_64 p50", share="liver1400_64 bandwidth_ratio")),
    Item("RR3510", "eqs. 3-5, app. A", "Element tensors K_jk and shape vectors M_j.",
         "`K_jk = V (λ g_j g_kᵀ + μ g_k g_jᵀ + μ (g_j·g_k) I)`: symmetric, semidefinite with six zero modes, the Hessian of the energy of app. B ({passed:.0f} tests).",
         "eq. 5 prints λ and the first μ exchanged, which is no Hessian of eq. 1 and has negative eigenvalues; app. A's M_j changes sign with j; eq. 3 lacks the minus of sec. 5.2.3; eq. 4's damping must oppose the velocity.",
         **tests("test_fem", "Elasticity.*")),
    Item("RR3510", "sec. 5.4", "RK4 allows steps about ten times those of Euler's method, and is about twice as fast.",
         "On a cube of 125 nodes RK4's largest stable step is {over_semi:.1f} times that of semi-implicit and {over_forward:.0f} times that of forward Euler; at equal error it is *{fast_semi:.1f}* and *{fast_forward:.0f}* times as fast.",
         "Which Euler theirs was, they do not say: their factor of the step lies between the two. [tissue.md](tissue.md#integration) has a finer cube.",
         **bench("integrators", over_semi="soft_rk4 step_over_semi_implicit", over_forward="soft_rk4 step_over_forward_euler",
                 fast_semi="soft_rk4 speedup_over_semi_implicit", fast_forward="soft_rk4 speedup_over_forward_euler"),
         judged={"over_semi": (1.3, 1.6), "over_forward": (50, 300)}),
    Item("RR3510", "sec. 5.1, 5.6", "40 Hz with 760 vertices and about 4,000 edges, springs alike; more than 1,000 nodes at the rate of pictures.",
         "*{tensors:,.0f}* steps a second with 760 nodes, springs *{springs:,.0f}*; with 10,648 nodes *{large:,.0f}*, on one core.", "",
         ("bench_tensor_mass --quick", "bench_three_models --quick"),
         lambda run: {"tensors": run.rows("tensor_mass_rk4")["box760 steps_per_s"], "springs": run.rows("spring_mass_rk4")["box760 steps_per_s"],
                      "large": run.rows("tensor_mass_rk4")["box10648 steps_per_s"]}),
    Item("RR3510", "sec. 5.5", "A tetrahedron is taken out by ten updates of tensors; the tissue then behaves as if it had been removed at rest.",
         "*{remove:.0f} µs* in a box of 10,648 nodes, with all that goes with it: tensors, masses, surface, buckets.",
         "Tensors are summed afresh from what remains, so that no rounding gathers. That it behaves so is table 1's line \"after a cut\".",
         **bench("cutting", "remove_tetrahedron", remove="box10648 p50")),
    Item("RR3510", "table 1", "Computation +++, +, +; realism +, +, −; cutting −, ++, +; large displacements −, −, + for pre-computed, tensor-mass and spring-mass.",
         "A step *{pre:.1f}*, *{tensor:.1f}*, *{spring:.1f} µs*; field error at rest, ν = 0.45, {pre_error:.0e}, {tensor_error:.0e}, {spring_error:.0%}; error after a cut {pre_cut:.0%}, {tensor_cut:.0e}, {spring_cut:.0%}; "
         "false force under a turn of 30° {pre_turn:.0%}, {tensor_turn:.0%}, {spring_turn:.0e} of that under 10 % stretch.",
         "Measured in full in [models.md](models.md), beside a fourth model, corotational, which turns and stays exact.",
         **bench("three_models", pre="precomputed step_p50", tensor="tensor_mass step_p50", spring="spring_mass step_p50",
                 pre_error="precomputed field_error_nu045", tensor_error="tensor_mass field_error_nu045", spring_error="spring_mass field_error_nu045",
                 pre_cut="precomputed cut_field_error", tensor_cut="tensor_mass cut_field_error", spring_cut="spring_mass cut_field_error",
                 pre_turn="precomputed false_force", tensor_turn="tensor_mass false_force", spring_turn="spring_mass false_force"),
         judged={"tensor_error": (0, 1e-6), "spring_error": (0.1, 0.3), "tensor_cut": (0, 1e-5), "spring_cut": (0.02, 0.06), "tensor_turn": (1.5, 2),
                 "spring_turn": (0, 1e-10)}),
    Item("RR3510", "fig. 2", "A plate of 759 vertices and 2,212 tetrahedra, held at its corners, is cut and deforms.",
         "{nodes:.0f} nodes, {tetrahedra:.0f} tetrahedra; the first {cut:.0f} are cut in 3.5 s, and the plate sags to {sag:.1f} mm; at the end of the motion it is in two.",
         "They name no material. Ours averages its strain at the nodes (`element = \"nodal_strain\"`): two cells across, linear tetrahedra are half too stiff. With `--set body.dynamic.element=linear --set body.young=3e4` it sags as far and is cut alike.",
         ("palpate check scenes/plate_cut.toml", "palpate drive scenes/plate_cut.toml --seconds 3.5 --json"),
         values=lambda run: {"nodes": run.number(r"'plate': ([\d,]+) nodes"), "tetrahedra": run.number(r"nodes, ([\d,]+) tetrahedra"),
                             "cut": run.figures(1)["body.plate.cut"], "sag": 1e3 * run.figures(1)["body.plate.displacement.max"]},
         judged={"nodes": (759, 759), "tetrahedra": (2212, 2212), "cut": (80, 95), "sag": (20, 23)}),
    Item("RR3510", "fig. 3", "A cylinder of 248 vertices and 889 tetrahedra tears under gravity, where the relative change of volume passes a threshold.",
         "{nodes:.0f} nodes, {tetrahedra:.0f} tetrahedra. Of one material it tears below the clamp of its upper end, where it is stretched most: {torn_alone:.0f} tetrahedra within {seconds:.1f} s, in {pieces_alone:.0f} pieces. Tougher above and pulled a little to the side, it tears further down, from one side to the other: {torn:.0f}.",
         "They name no material.",
         ("palpate check scenes/cylinder_tear.toml", "palpate drive scenes/cylinder_tear.toml --json",
          "palpate drive scenes/cylinder_tear_alone.toml --seconds 0.7 --json"),
         values=lambda run: {"nodes": run.number(r"'cylinder': ([\d,]+) nodes"), "tetrahedra": run.number(r"nodes, ([\d,]+) tetrahedra"),
                             "torn": run.figures(1)["body.cylinder.torn"], "torn_alone": run.figures(2)["body.cylinder.torn"],
                             "pieces_alone": run.figures(2)["body.cylinder.pieces"], "seconds": run.figures(2)["seconds"]},
         judged={"nodes": (248, 248), "tetrahedra": (889, 889), "torn": (115, 137), "pieces_alone": (2, 2), "torn_alone": (115, 137)},
         pictures=(("papers_tear.jpg", "A cylinder of one material after 0.5 s, still whole, and after 0.68 s"),)),
    Item("RR3510", "table 2", "The pre-computed model takes displacements, not forces; the tensor-mass model takes both.",
         "Every model with static states takes both: 1 mN moves a node of a quasi-static plate by {quasi_static:.0f} µm, of a tensor-mass plate by {tensor_mass:.1f} µm, "
         "of a hybrid cylinder by {hybrid:.0f} µm, of a shell duct by {shell:.1f} µm; the hybrid's top carries what hangs below it, {weight:.4f} N. "
         "In a scene `gravity` and `[[body.load]]` are for every model with a mesh: its weight moves the plate by {sag:.2f} mm.",
         "A force is a right-hand side like any other: through the compliance for what has an archive of its surface, afresh (`--method direct`) for tissue that moves. An organ's mesh from images is its shape "
         "under its own weight already, so that the quasi-static examples have none.",
         (*(f"palpate solve scenes/{scene}.toml --force {node}:0,0,-0.001{method} --csv out/papers/{name}.csv" for name, (scene, node, method) in LOADED.items()),
          "palpate solve scenes/cylinder_hybrid.toml --method direct --gravity 0 0 -9.81 --csv out/papers/weight.csv",
          *(f"palpate {command} scenes/plate.toml --set body.gravity=[0,0,-9.81]" for command in ("precompute", "check"))),
         values=conditions, judged={"quasi_static": (23, 27), "tensor_mass": (14, 18), "hybrid": (550, 700), "shell": (5.5, 6.5), "weight": (0.32, 0.3427), "sag": (6.1, 6.15)}),
    Item("RR3510", "fig. 4a", "Nodes that both parts share connect them.",
         "The hepatectomy's parts share {shared:.0f} nodes.", "They carry the mass of the quasi-static elements around them, so that the step's bound is rigorous.",
         ("palpate check scenes/hepatectomy.toml",),
         values=lambda run: {"shared": run.number(r"joined to the quasi-static part at (\d+) nodes")}, judged={"shared": (84, 84)}),
    Item("RR3510", "fig. 4b", "A fine quasi-static part and a coarse tensor-mass one, connected at four nodes only: visual artefacts where they gape.",
         "{shared:.0f} nodes are shared; under its weight and a probe's press of {force:.2f} N the coarse block hangs on them and gapes.",
         "The picture shows the gap, as theirs; `palpate check` tells it at rest.",
         ("palpate check scenes/block_partial.toml", "palpate drive scenes/block_partial.toml --seconds 5 --json"),
         values=lambda run: {"shared": run.number(r"joined to the quasi-static part at (\d+) nodes"), "force": run.figures(1)["tool.probe.force.max"]},
         judged={"shared": (4, 4), "force": (0.04, 0.055)}, pictures=(("papers_partial.jpg", "A coarse block hangs on a fine one by the four corners of their common face"),)),
    Item("RR3510", "figs. 5, 6", "A hybrid cylinder under gravity, upper half quasi-static, comes to the rest of a single quasi-static or dynamic model.",
         "At rest the whole body sags {sag:.4f} mm; after 3 s hybrids with the lower half, the upper half or one side moving differ from it by {worst:.1e}.",
         "The quasi-static part answers inside each stage of the integrator; a step behind, as the loop of fig. 5 reads, it is unstable.",
         ("palpate solve scenes/cylinder_hybrid.toml --method direct --gravity 0 0 -9.81 --csv out/papers/sag.csv", HYBRID,
          HYBRID + " --set 'body.hybrid.region=[{group=\"upper\"}]'", HYBRID + " --set 'body.hybrid.region=[{box=[[-1,-1,-1],[0,1,1]]}]'"),
         values=same_rest, judged={"sag": (7.6, 7.8), "worst": (0, 1e-3)}),
    Item("RR3510", "sec. 6.3, figs. 7, 8", "A liver of 1,537 vertices and 7,039 tetrahedra, 18 % of them tensor-mass (280 and 1,260); a forceps pinches the segment, which is cut off.",
         "{nodes:,.0f} nodes and {tetrahedra:,.0f} tetrahedra, {share:.1f} % of them tensor-mass ({moving_nodes:.0f} and {moving:,.0f}); {cut:.0f} are cut, the forceps holds a piece of {off:.0f}, with {held:.3f} N at the end.",
         "Another liver: theirs is not public; and the end of its left lobe, not segment 6, which is at the lower right. Fig. 7's wireframe in the colours of the parts is drawn with `[render] colour = \"parts\"` ([rendering.md](rendering.md)).",
         ("palpate check scenes/hepatectomy.toml", "palpate drive scenes/hepatectomy.toml --json"),
         values=lambda run: {"nodes": run.number(r"'liver': ([\d,]+) nodes"), "tetrahedra": run.number(r"nodes, ([\d,]+) tetrahedra"),
                      "share": run.number(r"([\d.]+) % of the tetrahedra"), "moving_nodes": run.number(r"moving: ([\d,]+) nodes"),
                      "moving": run.number(r"moving: [\d,]+ nodes, ([\d,]+) tetrahedra"), "cut": run.figures(1)["body.liver.cut"],
                      "off": run.figures(1)["body.liver.off"], "held": run.figures(1)["tool.forceps.force.end"]},
         judged={"share": (17, 18.5), "cut": (200, 500), "off": (190, 240), "held": (0.056, 0.068)}),
]

# ---- BHS01


def powers(run):
    """Slopes of the time of a step over the number n of translations, from the smallest to the largest common size."""
    rows = run.rows("modal_accuracy")
    def power(metric):
        return math.log(rows[f"n2400 {metric}"] / rows[f"n192 {metric}"]) / math.log(2400 / 192)
    return {"dense": power("dnios_dense"), "field": power("nirms_field"), "ratio": rows["n2400 dnios_dense"] / rows["n2400 nirms_field"],
            "dense_us": rows["n2400 dnios_dense"], "field_us": rows["n2400 nirms_field"], "step_us": rows["n2400 nirms"],
            "point": rows["r50 tap_point"], "residual": rows["r50 tap_residual_point"], "share": rows["r50 force_share"],
            "gain": rows["condensed solve_full"] / rows["condensed solve_condensed"], "condensed": rows["condensed difference"],
            "all": rows["all tap_field"]}


MODAL = {"commands": ("bench_modal_accuracy --quick",), "values": powers}

BHS01 = [
    Item("BHS01", "eqs. 1-14, app. A", "Membrane and bending triangles, six degrees of freedom a node; the bending polynomial of nine terms.",
         "The default is a discrete-Kirchhoff triangle, verified on published cases ([shell.md](shell.md), [verification.md](verification.md)). The paper's element is there for comparison and converges to a plate 38 % too soft ({passed:.0f} tests).",
         "Its polynomial has det N = x₃⁵ y₂⁵ (x₃ + 2 y₃ − y₂): singular for a right isosceles triangle with its right angle at node 1, which is refused. Fixed nodes are eliminated, not multiplied by a large number; the membrane has drilling freedoms of its own.",
         **tests("test_shell", "PolynomialBending.*:PublishedShells.Polynomial*")),
    Item("BHS01", "eqs. 15-16", "Condensing the rotations halves the degrees of freedom and the computations.",
         "Among dense matrices a solution takes *{gain:.1f}* times less time, and differs by {condensed:.0e}.",
         "The sparse system with its rotations beats both; condensed matrices are formed in tests and comparisons alone.",
         **MODAL, judged={"condensed": (0, 1e-9)}),
    Item("BHS01", "eqs. 17-22", "A few significant modes stand for the body; the error of leaving the others out is insignificant.",
         "Not at the touched point: of a tap of 30 ms, 50 modes miss {point:.0%} of its displacement. With the residual flexibility of the others {residual:.1%} are missed; with all modes both systems agree to {all:.0e}.",
         "The initial state is X₀ = Φᵀ M U₀ (printed Φ U₀).",
         **MODAL, judged={"point": (0.1, 0.25), "residual": (0, 0.01), "all": (0, 1e-9)}),
    Item("BHS01", "eqs. 23-26", "Newmark's average acceleration is stable for any step; central differences only below T_n/π.",
         "Central differences stay bounded 5 % below T_n/π and grow without bound 5 % above; Newmark's scheme is stable at both and at 10⁵ times that ({passed:.0f} tests).",
         "eq. 26 should read K̂ Û = F̂. Contacts are met at the end velocity of a step: at its end position they chatter ([duct.md](duct.md)).",
         **tests("test_shell", "CentralDifference.*:Newmark.*")),
    Item("BHS01", "app. B", "Direct integration (DNIOS) takes O(n²) operations a step, the modes (NIRMS) O(n log n).",
         "Between 192 and 2,400 translations the time grows as n to the *{dense:.1f}* and the *{field:.1f}* with 50 modes and the whole field; at 2,400 *{dense_us:,.0f} µs* and *{field_us:.0f} µs*, the modes alone *{step_us:.2f} µs*.",
         "With r modes the field costs O(n r), with no logarithm. The force M Φ f (printed Φ f) returns {share:.0%} of a point load at 50 modes: the hand gets the contact's own force.",
         **MODAL, judged={"share": (0.05, 0.2)}),
    Item("BHS01", "eqs. 27-28", "The catheter: particles with springs, bending, damping; semi-implicit Euler.",
         "A step of 60 particles in the duct's 50 modes takes *{p50:.0f} µs*; no particle has been found on the wrong side of the wall in hours of random motion ([duct.md](duct.md)).",
         "Implicit by default, as stable for any stiffness; `integrator = \"semi_implicit\"` is eq. 28, in as many substeps as the stiffest spring asks for.",
         **bench("catheter", "catheter_step", only=("particles60",), p50="particles60 p50")),
    Item("BHS01", "sec. IV-VI", "Forces at about 1 kHz, pictures at 30 Hz at least, on two processors of 300 MHz.",
         "A haptic step of duct, catheter and two forceps takes *{p50:.0f} µs* (median): 1 kHz with 60 pictures a second beside it ([duct.md](duct.md)).", "",
         **bench("duct_step", p50="insertion p50")),
    Item("BHS01", "sec. III, figs. 6, 8", "A catheter of 2 to 3 mm in a duct of 8 to 10 mm; forceps of three segments.",
         "{catheter:.1f} mm, in a duct of {duct:.1f} mm at its narrowest; a shaft and two jaws that meet at the joint.", "Segments have a radius; the picture's forceps is the one that collides.",
         ("palpate check scenes/catheter_insertion.toml",),
         values=lambda run: {"catheter": 1e3 * run.number(r"([\d.]+) m thick; model catheter"), "duct": 1e3 * run.number(r"([\d.]+) m wide inside")},
         judged={"catheter": (2, 3), "duct": (8, 10)}),
    Item("BHS01", "sec. VII", "Forces and torques of line segments, the reaction at the port, grip forces on the handle.",
         "A forceps that pokes, pushes, grasps and pulls the duct feels up to {force:.2f} N, {torque:.1f} mN m about its joint and {grip:.1f} mN m on its handle.",
         "", ("palpate drive scenes/duct_poke.toml --json",),
         values=lambda run: {"force": run.figures()["tool.forceps.force.max"], "torque": 1e3 * run.figures()["tool.forceps.torque.max"],
                             "grip": 1e3 * run.figures()["tool.forceps.grip.max"]},
         judged={"force": (0.2, 0.6), "torque": (1, 10), "grip": (10, 30)}),
    Item("BHS01", "sec. VIII, fig. 11", "A pair of forceps leads the catheter into the duct; the trainee's performance can be measured.",
         "Two scripted forceps lead it {deepest:.0f} mm deep with {grasps:.0f} grasps, {drops:.0f} drops, {touches:.0f} touches of the wall and at most {force:.1f} mN.",
         "No trainees were measured.", ("palpate drive scenes/catheter_insertion.toml --json",),
         values=lambda run: {"deepest": 1e3 * run.figures()["body.catheter.deepest"], "grasps": run.figures()["body.catheter.grasps"],
                      "drops": run.figures()["body.catheter.drops"], "touches": run.figures()["body.catheter.wall_contacts"],
                      "force": 1e3 * run.figures()["body.catheter.force.max"]},
         judged={"deepest": (30, 40), "grasps": (1, 10), "drops": (0, 0)}),
]

PAPERS = {"TVCG99": TVCG99, "RR3510": RR3510, "BHS01": BHS01}
