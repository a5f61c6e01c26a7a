"""Draws what compressed tensors cost over the nodes of the surface: compressed_plots.py ROWS.csv PICTURE.png.

ROWS.csv is what bench_compressed prints."""
import collections
import csv
import re
import sys

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

PANELS = (
    ("processor time of precompute [s]", {"precompute_processor": "compressed"}),
    ("tensors [MB]", {"tensors": "compressed", "tensors_dense": "dense, packed"}),
    ("haptic step [µs]", {"step_p50": "median", "step_p999": "99.9 %"}),
)


def read_rows(path):
    """{metric: [(nodes, value)]}, by nodes."""
    rows = collections.defaultdict(list)
    with open(path) as file:
        for bench, case, metric, value, _ in csv.reader(file):
            if bench == "compressed":
                rows[metric].append((int(re.sub(r"\D", "", case)), float(value)))
    if not rows:
        sys.exit(f"compressed_plots.py: {path} has no rows of bench_compressed")
    return {metric: sorted(points) for metric, points in rows.items()}


def main(path, picture):
    rows = read_rows(path)
    figure, axes = plt.subplots(1, len(PANELS), figsize=(12, 3.6), layout="constrained")
    for axis, (title, lines) in zip(axes, PANELS):
        for metric, label in lines.items():
            axis.loglog(*zip(*rows[metric]), marker="o", label=label)
        axis.set(title=title, xlabel="surface nodes")
        axis.grid(True, which="both", alpha=0.3)
        axis.legend()
    small_png.save(figure, picture)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
