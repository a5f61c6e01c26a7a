"""Writes docs/papers.md: every figure and claim of the three papers beside ours: papers.py BIN_DIR [DOCS_DIR].

BIN_DIR is the folder of the built programs. The items stand in scripts/papers_items.py, each with its commands, which are run,
and with the ranges in which its values must be: where a command fails or a value has left its range, so does this program.
--short runs the items' shorter commands and writes no page; --only NAME takes the items whose name has NAME in it, likewise.
--listed runs nothing, and fails where the page has another item, wording or command than these."""
import argparse
import csv
import json
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys
import tempfile

from papers_items import PAPERS

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = "out/papers"  # as the page names it; the commands write into a folder of this run

INTRODUCTION = """# The papers, reproduced

Written by `scripts/papers.py`; do not edit. What the three papers print as a figure, a number or a claim beside what the same
work comes to here, with the command that makes it, and where we differ on purpose, why. Sources: S. Cotin, H. Delingette and N. Ayache, *Real-time elastic deformations of soft
tissues for surgery simulation*, IEEE TVCG 5(1), 1999 (**TVCG99**); the same, *Efficient linear elastic models of soft tissues for real-time surgery
simulation*, INRIA RR-3510, 1998 (**RR3510**); C. Basdogan, C.-H. Ho and M. A. Srinivasan, *Virtual environments for medical training*, IEEE/ASME
Transactions on Mechatronics 6(3), 2001 (**BHS01**).

    python3 scripts/papers.py build/release/bin           # all of it, this page
    python3 scripts/papers.py build/release/bin --short   # judged, what takes long in a shorter form: what the tests run

The commands below are run from the top of the repository with `build/release/bin` in the `PATH`; files go to `out/papers` (`mkdir -p out/papers`). Figures in *italics* depend
on the machine, here {machine}; linear algebra takes one core; the tests judge all others (`scripts/nightly.sh papers` those of the commands as they stand here). The papers' own are of a Pentium of 166 MHz, DEC Alphas of 233 and 400 MHz
and a pair of Pentium II of 300 MHz: much of what lies between theirs and ours is 25 years of hardware.
"""


class Run:
    """What the commands of one item printed and wrote."""

    def __init__(self, outputs, folder, is_short=False):
        self.outputs, self.folder, self.is_short = outputs, folder, is_short

    def rows(self, suite):
        """Values of benchmark rows, suite,case,metric,value,unit, by "case metric"."""
        found = {}
        for line in "\n".join(self.outputs).splitlines():
            cells = line.split(",")
            if len(cells) == 5 and cells[0] == suite:
                found[f"{cells[1]} {cells[2]}"] = float(cells[3])
        return found

    def figures(self, which=0):
        """Figures of a `palpate drive --json`."""
        return json.loads(self.outputs[which])["figures"]

    def number(self, pattern, which=0):
        """The first group of a pattern in what a command printed, as a number."""
        match = re.search(pattern, self.outputs[which])
        if not match:
            raise ValueError(f"'{pattern}' is not in:\n{self.outputs[which]}")
        return float(match[1].replace(",", ""))

    def document(self, name):
        """A JSON file that a command wrote."""
        return json.loads((self.folder / name).read_text())

    def table(self, name):
        """Rows of a CSV file that a command wrote: dictionaries of numbers."""
        with open(self.folder / name, newline="") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


class Runner:
    """Runs each command once."""

    def __init__(self, programs, folder, short):
        self.programs, self.folder, self.short, self.done = programs, folder, short, {}
        threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # as the papers' machines had one processor
        self.environment = os.environ | threads | {"PATH": f"{programs}:{os.environ['PATH']}"}

    def output(self, command):
        if command not in self.done:
            print(command, file=sys.stderr, flush=True)
            words = shlex.split(command.replace(FOLDER, str(self.folder)))
            if words[0] == "python3":
                words[0] = sys.executable
            result = subprocess.run(words, cwd=ROOT, env=self.environment, capture_output=True, text=True)
            if result.returncode != 0:
                raise RuntimeError(f"{command}\nended with {result.returncode}: {result.stderr.strip()}")
            self.done[command] = result.stdout
        return self.done[command]

    def values(self, item):
        commands = item.short if self.short and item.short else item.commands
        values = item.values(Run([self.output(c) for c in commands], self.folder, self.short)) if commands else {}
        if commands and not values:
            raise ValueError(f"{item.paper} {item.name}: its commands give no value")
        return values

    def judged(self, item, values):
        """Names and ranges; in the short form of what it gives."""
        return [(name, limits) for name, limits in item.judged.items() if name in values or not (self.short and item.short)]


def complaints(item, values, judged):
    """Sentences on values outside their ranges."""
    for name, (low, high) in judged:
        if not low <= values[name] <= high:
            yield f"{item.paper} {item.name}: {name} is {values[name]:.6g}, and was to be from {low:g} to {high:g}"


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return f"{line.split(':')[1].strip()}, {os.cpu_count()} virtual cores, with a load of {os.getloadavg()[0]:.1f} by others"
    return platform.machine()


def typeset(text):
    """True minus signs, and a space before per cent."""
    return re.sub(r"(?<=\d)%", " %", re.sub(r"(?<!\w)-(?=\d)", "−", text))


def row(item, ours, differs):
    return f"| **{item.name}** | {item.claim} | {typeset(ours)} | {typeset(differs)} |"


def commands_of(title, items):
    lines = [f"### Commands of {title}", ""]
    for item in items:
        if item.commands:
            lines += [f"{item.name}:", "", *(f"    {command}" for command in item.commands), ""]
    return "\n".join(lines)


def section(title, items, values):
    lines = [f"## {title}", "", "| | the paper | here | where we differ, and why |", "| --- | --- | --- | --- |"]
    lines += [row(item, item.ours.format(**values[item]), item.differs.format(**values[item])) for item in items]
    lines += [""] + [f"![{words}](pictures/{file})\n" for item in items for file, words in item.pictures]
    return "\n".join(lines) + "\n" + commands_of(title, items)


def any_values(item):
    """A pattern of the item's row, whatever its values are."""
    text = row(item, *(re.sub(r"\{\w+(:[^}]*)?\}", "\0", text) for text in (item.ours, item.differs)))
    return re.escape(text).replace("\0", r"[−\d.,e+-]+(?: %)?")


def unlisted(page):
    """Sentences on what the page says otherwise than the items."""
    for title, items in PAPERS.items():
        yield from (f"papers.md: {title}, {item.name}: its row is another" for item in items if not re.search(f"^{any_values(item)}$", page, re.M))
        if commands_of(title, items).strip() not in page:
            yield f"papers.md: {title}: its commands are others"


def write_page(docs, values, machine):
    import papers_plots  # matplotlib is for the page alone
    (docs / "pictures").mkdir(parents=True, exist_ok=True)
    papers_plots.draw(ROOT, docs / "pictures", values)
    sections = [section(title, items, values) for title, items in PAPERS.items()]
    (docs / "papers.md").write_text(INTRODUCTION.format(machine=machine) + "\n" + "\n".join(sections))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", metavar="BIN_DIR", type=pathlib.Path)
    parser.add_argument("docs", metavar="DOCS_DIR", type=pathlib.Path, nargs="?", default=ROOT / "docs")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--only", metavar="NAME", default="")
    parser.add_argument("--listed", action="store_true")
    arguments = parser.parse_args()
    if arguments.listed:
        sys.exit("\n".join(unlisted((arguments.docs / "papers.md").read_text())) or 0)
    bad, values, measured_on = [], {}, machine()
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(arguments.programs.resolve(), pathlib.Path(folder), arguments.short)
        for item in (i for items in PAPERS.values() for i in items if arguments.only in f"{i.paper} {i.name}"):
            values[item] = runner.values(item)
            bad += complaints(item, values[item], runner.judged(item, values[item]))
            print(f"{item.paper} {item.name}: " + ", ".join(f"{name} {value:.6g}" for name, value in values[item].items()), flush=True)
    if not arguments.short and not arguments.only:
        write_page(arguments.docs, values, measured_on)
    if bad:
        sys.exit("\n".join(bad))


if __name__ == "__main__":
    main()
