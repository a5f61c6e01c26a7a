"""The curves of the papers' figures, drawn for docs/papers.md."""
import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from papers_items import DEPTHS, HEIGHT, RADIUS  # noqa: E402

POISSON = 0.45  # of the linear answer that figs. 8 and 9 compare with


def read(file):
    return list(zip(*(map(float, line.split(",")) for line in file.read_text().splitlines() if line[:1].isdigit())))


def draw_brain(curves, file, pressed):
    """TVCG99 figs. 7, 8 and 9; what the simulated cylinder answers to a press of its top (fig. 13) as points."""
    figure, (force, radial, law) = plt.subplots(1, 3, figsize=(11, 3.4), constrained_layout=True)
    for speed, colour in (("500", "tab:red"), ("5", "tab:blue"), ("0.005", "tab:green")):
        x, f = read(curves / f"brain_force_{speed}mm_min.csv")
        force.plot([1e3 * v for v in x], f, color=colour, label=f"{speed} mm/min")
    x, wider = read(curves / "brain_radial.csv")
    linear = [POISSON * RADIUS * v / HEIGHT for v in x]
    radial.plot([1e3 * v for v in x], [1e3 * v for v in wider], color="tab:blue", label="law of the experiment")
    radial.plot([1e3 * v for v in x], [1e3 * v for v in linear], color="grey", linestyle="--", label="linear, ν r x / h")
    law.plot([1e3 * v for v in linear], [1e3 * v for v in wider], color="tab:blue", label="P")
    law.plot([1e3 * v for v in linear], [1e3 * v for v in linear], color="grey", linestyle="--", label="linear")
    depths = [1e3 * d for d in DEPTHS]
    force.plot(depths, [pressed[f"force_{d}"] for d in DEPTHS], "ko", label="simulated, 5 mm/min")
    radial.plot(depths, [1e3 * pressed[f"radial_{d}"] for d in DEPTHS], "ko", label="simulated")
    for axes, across, up in ((force, "compression [mm]", "force [N]"), (radial, "compression [mm]", "radial displacement [mm]"),
                             (law, "linear radial displacement [mm]", "radial displacement [mm]")):
        axes.set_xlabel(across)
        axes.set_ylabel(up)
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
    small_png.save(figure, file, dpi=110)
    plt.close(figure)


def draw(root, pictures, values):
    pressed = next(v for item, v in values.items() if item.name.endswith("fig. 13"))
    draw_brain(root / "scenes/curves", pictures / "papers_brain.png", pressed)
