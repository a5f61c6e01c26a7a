"""stability_figures.py STABILITY.CSV [PAGE]: the figures of docs/stability.md that a whole run has, a line each. With the
page: says which of these lines it lacks, and ends with 1 if it lacks one."""
import csv
import re
import sys


def number(text, name):
    return float(re.search(rf"{name}=([-+.\de]+)", text)[1])


def energy(joule):
    """Never below nothing."""
    return f"{joule:.3g} J" if joule >= 0.9995 else f"{max(0.0, 1e3 * joule):.3g} mJ"


class Table:
    def __init__(self, file):
        with open(file, encoding="utf-8") as opened:
            self.rows = list(csv.DictReader(opened))

    def of(self, case):
        return [r for r in self.rows if r["case"] == case]

    def at(self, case, parameter, value):
        return next(r for r in self.of(case) if (r["parameter"], r["value"]) == (parameter, value))

    def stable(self, case):
        return sum(r["outcome"] == "stable" for r in self.of(case))


def stiffness(row):
    k = number(row["note"], "K_max")
    if k < 1e6:
        return f"{k:.0f}"
    return "not told from the steps" if row["outcome"] == "failed" else "1e6"


def loop(table, parameter, value):
    return [table.at(f"loop {how}", parameter, value) for how in ("observer only", "controller")]


def delays(table):
    for delay in ("0", "5", "20", "50", "100"):
        alone, controlled = loop(table, "delay [ms]", delay)
        wall = [table.at(f"wall of 2000 N/m, {how}", "delay [ms]", delay) for how in ("observer only", "controller")]
        yield [delay, f"{number(alone['note'], 'bound'):.0f}", stiffness(alone), stiffness(controlled)] + [
            energy(float(r["energy_growth"])) for r in (alone, controlled, *wall)]


def others(table):
    for name, parameter, value in (
            ("rate 100 Hz", "rate [Hz]", "100"), ("250 Hz", "rate [Hz]", "250"), ("4000 Hz", "rate [Hz]", "4000"),
            ("steps of 0.01 mm", "quantisation [m]", "1e-05"), ("steps of 0.1 mm", "quantisation [m]", "0.0001"),
            ("steps of 1 mm", "quantisation [m]", "0.001"), ("10 ms and 5 ms of jitter", "jitter [ms] after 10 ms", "5"),
            ("10 ms, 30 % lost", "loss [1] after 10 ms", "0.3")):
        alone, controlled = loop(table, parameter, value)
        yield [name, f"{number(alone['note'], 'bound'):.0f}", stiffness(alone), stiffness(controlled),
               energy(float(controlled["energy_growth"]))]


def off(row):
    mean, static = map(float, re.match(r"([-+.\de]+) N, static ([-+.\de]+) N", row["note"]).groups())
    return abs(mean - static) / abs(static)


def counts(table):
    any_tip, named = table.of("moving contact, any"), table.of("moving contact")
    points = sum(len(table.of(c)) for c in ("moving contact", "moving contact, by nodes", "moving contact, any",
                                            "moving contact, averaged strain", "moving contact, shafts",
                                            "moving contact, at a rim"))
    yield f"{points} points"
    yield f"{table.stable('moving contact, any') + table.stable('moving contact')} of {len(any_tip) + len(named)} are stable"
    yield f"off the static answer by {100 * max(map(off, any_tip + named)):.2f} % at most"
    yield f"by more than 0.1 % in {sum(off(r) > 1e-3 for r in any_tip)} of them"
    for case in ("averaged strain", "shafts", "at a rim"):
        yield f"{table.stable('moving contact, ' + case)} of {len(table.of('moving contact, ' + case))} are stable"


def main():
    table = Table(sys.argv[1])
    lines = [*counts(table), *(f"| {' | '.join(row)} |" for row in [*delays(table), *others(table)])]
    if len(sys.argv) < 3:
        print("\n".join(lines))
        return 0
    with open(sys.argv[2], encoding="utf-8") as page:
        text = page.read()
    lacking = [line for line in lines if line not in text]
    for line in lacking:
        print(f"{sys.argv[2]} lacks: {line}")
    return 1 if lacking else 0


if __name__ == "__main__":
    sys.exit(main())
