"""Writes the table of the tissue models into docs/models.md: model_table.py ROWS.csv [docs/models.md].

ROWS.csv holds what bench_three_models prints, alone or among the rows of out/bench.csv. The table stands between the two
marker lines of the document and is replaced as a whole."""
import sys

MODELS = ["precomputed", "tensor_mass", "spring_mass", "corotational"]
HEAD = ["", "pre-computed", "tensor-mass", "spring-mass", "corotational"]
BEGIN, END = "<!-- model_table.py begins -->", "<!-- model_table.py ends -->"


def number(value):
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:.3g}"


def percent(value):
    value *= 100
    if abs(value) < 1e-9:
        return "0"
    return f"{value:.2g} %" if abs(value) < 10 else f"{value:.0f} %"


def signed(value):
    return "0" if abs(value) < 1e-11 else f"{'+' if value > 0 else '−'}{percent(abs(value))}"


QUESTIONS = [
    ("time of a step, box of 760 nodes [µs]", "step_p50", number),
    ("largest stable step [µs]", "max_step", number),
    ("simulated time per time of one core", "times_real_time", number),
    ("field error at rest, ν = 0.25", "field_error_nu025", percent),
    ("field error at rest, ν = 0.45", "field_error_nu045", percent),
    ("force error, ν = 0.25", "force_error_nu025", signed),
    ("force error, ν = 0.45", "force_error_nu045", signed),
    ("stiffness: five to a cell, mirrored", "stiffness_mirrored", signed),
    ("stiffness: five to a cell, regular nodes", "stiffness_regular", signed),
    ("stiffness: six to a cell", "stiffness_six", signed),
    ("field error after a cut", "cut_field_error", percent),
    ("stiffness change by that cut", "cut_stiffness_change", signed),
    ("false force under 30°, of that under 10 % stretch", "false_force", percent),
]


def read_rows(path):
    values, origin = {}, ""
    for line in open(path):
        cells = line.rstrip("\n").split(",")
        if cells[0] != "three_models":
            continue
        values[cells[1], cells[2]] = float(cells[3])
        if len(cells) > 6:
            origin = f"{cells[5]}, commit {cells[6]}"
    if not values:
        sys.exit(f"model_table.py: {path} has no rows of three_models")
    return values, origin


def table(values, origin):
    lines = ["| " + " | ".join(HEAD) + " |", "| --- |" + " --- |" * len(MODELS)]
    for title, metric, form in QUESTIONS:
        cells = [form(values[m, metric]) if (m, metric) in values else "–" for m in MODELS]
        if metric == "cut_stiffness_change":
            title += f" (direct solve: {form(values['direct', metric])})"
        lines.append("| " + " | ".join([title] + cells) + " |")
    if origin:
        lines += ["", f"Measured on {origin}."]
    return "\n".join(lines)


def main():
    document = sys.argv[2] if len(sys.argv) > 2 else "docs/models.md"
    text = open(document).read()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    open(document, "w").write(before + BEGIN + "\n" + table(*read_rows(sys.argv[1])) + "\n" + END + after)


if __name__ == "__main__":
    main()
