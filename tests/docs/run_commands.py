#!/usr/bin/env python3
"""run_commands.py BIN [--all]: runs the `palpate` lines of README.md and docs/ word for word, in a folder with a copy of
scenes/ and what docs/organ.md begins with, then the CTest project of docs/drive.md and the reader of docs/logs.md, each
as the page has it. Some lines are shortened by an option of theirs, some exempt: the tables below say which and why.
README.md is typed in a shell that finds the programs only once a line of the page has told it where.
Without --all only those of README.md, docs/drive.md and docs/logs.md that take no minutes."""
import contextlib
import fnmatch
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import organ_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = "build/release/bin"  # in a checkout
PAGES_IN_SHORT = ["README.md", "docs/drive.md", "docs/logs.md"]

# Never run: (page, line, why). `*` stands for anything.
EXEMPT = [
    ("docs/papers.md", "*", "the test `papers` runs them"),
    ("docs/deploy.md", "*", "names two hosts; the tests `deploy` and `network` make two"),
    ("docs/security.md", "*", "names two hosts, and a scene on one of them; the tests `security` make them"),
    ("*", "* HOST*", "names another host"),
    ("docs/drive.md", "palpate drive --merge results.jsonl *", "belongs to the lines of tasks, which run together below"),
]

# Run with more words at their end: (line, words). A later row goes before an earlier one.
SHORTENED = [
    ("palpate run *", "--seconds 1"),
    ("palpate run * --record *", "--seconds 2"),
    ("*palpate run * --web*", "--seconds 1"),
    ("palpate drive scenes/liver.toml * --log *", "--seconds 3"),
    ("palpate latency*", "--seconds 1"),
    ("palpate record *", "--seconds 2"),
    ("palpate top", "--once"),
    ("palpate study *", "--quick"),
    ("palpate stability *", "--quick"),
    ("* --quick*", ""),
    ("palpate film out/* -o *", "--to 1"),
    ("palpate film * --from 2 --to 4 *", ""),
]

# Only with --all: minutes of computing.
LONG = ["palpate study *", "palpate stability *", "palpate modes *", "* --sweep *", "palpate drive *--set body.young*",
        "palpate film * --speed 0.1 *"]

# Need a program that is built only where its libraries are: (line, program).
NEEDS = [("palpate mesh *", "palpate_organ"), ("palpate organ *", "palpate_organ"), ("palpate segment *", "palpate_organ"),
         ("palpate * organ.*", "palpate_organ")]

# Need a running system: one runs meanwhile.
BESIDE_A_RUN = ["palpate record *", "palpate top*"]

# May end with an error that ends with these words: (line, words).
ENDS_SO = [("palpate stability *", "points failed; see out/")]  # docs/stability.md names them

# Logs that lines take and the page does not make.
LOGS = ["out/liver.lcmlog", "monday.lcmlog", "friday.lcmlog", "session.lcmlog"]

# How a line of a page begins that is typed.
TYPED = ("palpate ", f"{PROGRAMS}/palpate ", "mkdir ", "export PATH=")


def matches(line, patterns):
    return any(fnmatch.fnmatchcase(line, pattern) for pattern in patterns)


def lines_of(page):
    """The lines of indented and fenced blocks that begin with `palpate `, by a path too, make a folder for one, or tell the
    shell where it is."""
    fenced = False
    for line in (ROOT / page).read_text().splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif (fenced or line.startswith("    ")) and line.strip().startswith(TYPED):
            yield line.strip()


def shortened(line):
    words = next((more for pattern, more in reversed(SHORTENED) if fnmatch.fnmatchcase(bare(line), pattern)), "")
    return f"{bare(line)} {words}".strip()


def bare(line):
    """Without the page's remark."""
    return re.split(r"\s+#", line)[0]


def ends_so(command, said):
    last = said.strip().splitlines()[-1:]
    return any(fnmatch.fnmatchcase(command, pattern) and words in "".join(last) for pattern, words in ENDS_SO)


def block(page, language, word):
    """The fenced block of this language that holds `word`."""
    blocks = re.findall(rf"```{language}\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    return next(text for text in blocks if word in text)


class Place:
    """A fresh folder with a copy of scenes/ and the programs, which are first in PATH from find_programs() on."""

    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder
        self.failures = []
        self.environment = dict(os.environ)
        shutil.copytree(ROOT / "scenes", folder / "scenes")
        (folder / PROGRAMS).parent.mkdir(parents=True)
        (folder / PROGRAMS).symlink_to(programs)
        (folder / "out").mkdir()

    def find_programs(self, told=f'export PATH="$PWD/{PROGRAMS}:$PATH"'):
        """By the line that a page has for it."""
        self.environment["PATH"] = subprocess.run(["bash", "-c", f'{told}; printf %s "$PATH"'], cwd=self.folder, text=True,
                                                  env=self.environment, check=True, capture_output=True).stdout

    def run(self, command, place="", folder="."):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(["bash", "-c", command], cwd=self.folder / folder, env=self.environment, text=True,
                              capture_output=True, timeout=3600)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        good = done.returncode == 0 or ends_so(command, done.stderr)
        print(f"{'ok' if good else 'FAILED':6} {used:6.1f} s  {place}: {command}", flush=True)
        if not good:
            self.failures.append(command)
            print(done.stdout + done.stderr, flush=True)
        return done.stdout

    @contextlib.contextmanager
    def a_run(self):
        """A system in the domain that lines without --domain look at."""
        scene = subprocess.Popen(["palpate", "run", "scenes/liver.toml", "--domain", "0", "--seconds", "60"],
                                 cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL)
        try:
            self.run("until palpate top --once | grep -q haptic; do sleep 0.1; done", "a system begins")
            yield
        finally:
            scene.terminate()
            scene.wait()


def reason_to_leave_out(place, page, line):
    exempt = [why for on, pattern, why in EXEMPT if fnmatch.fnmatchcase(page, on) and fnmatch.fnmatchcase(line, pattern)]
    absent = [f"{program} is not built" for pattern, program in NEEDS
              if fnmatch.fnmatchcase(line, pattern) and not (place.programs / program).exists()]
    return next(iter(exempt + absent), None)


def run_page(place, page, everything):
    for line in lines_of(page):
        reason = reason_to_leave_out(place, page, bare(line))
        if reason or (matches(bare(line), LONG) and not everything):
            print(f"-                {page}: {bare(line)}: {reason or 'only with --all'}")
            continue
        if bare(line).startswith("export "):
            place.find_programs(bare(line))
            continue
        with place.a_run() if matches(bare(line), BESIDE_A_RUN) else contextlib.nullcontext():
            place.run(shortened(line), page)


def run_tasks(place):
    """What a sweep prints as tasks, on this machine alone, and its table."""
    lines = [bare(line) for line in lines_of("docs/drive.md")]
    place.run(next(line for line in lines if "--tasks" in line), "docs/drive.md")
    place.run("sh tasks.sh > results.jsonl", "docs/drive.md, in place of GNU parallel")
    place.run(next(line for line in lines if "--merge" in line), "docs/drive.md")


def run_project(place):
    """The tests in somebody else's repository; its scene is the liver under another name."""
    project = place.folder / "project"
    shutil.copytree(place.folder / "scenes", project)
    (project / "liver.toml").rename(project / "press.toml")
    (project / "CMakeLists.txt").write_text(block("docs/drive.md", "cmake", "my_driver_tests"))
    for step in re.findall(r"- run: (.*)", block("docs/drive.md", "yaml", "haptics")):
        place.run(step, "docs/drive.md", "project")


def run_reader(place):
    """The reader of logs prints a line for each force."""
    (place.folder / "reader.py").write_text(block("docs/logs.md", "python", "def events"))
    forces = place.run("/usr/bin/python3 reader.py out/liver.lcmlog", "docs/logs.md")
    counted = place.run("palpate export out/liver.lcmlog --topic force_state --jsonl -o forces.jsonl && wc -l < forces.jsonl",
                        "docs/logs.md")
    if not forces or len(forces.splitlines()) != int(counted or 0):
        place.failures.append(f"the reader of docs/logs.md has {len(forces.splitlines())} forces, the log {counted}")


def check_demo(place):
    """What demo.sh says last is a line of README.md."""
    said = re.findall(r'^echo "    (.*)"$', (ROOT / "scripts/demo.sh").read_text(), re.MULTILINE)[-1]
    if said.replace("$bin", PROGRAMS) not in map(bare, lines_of("README.md")):
        place.failures.append(f"scripts/demo.sh says {said}, README.md does not")


def main():
    programs, everything = pathlib.Path(sys.argv[1]).resolve(), "--all" in sys.argv
    pages = ["README.md"] + sorted(f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md"))
    with tempfile.TemporaryDirectory(prefix="palpate-docs-") as folder:
        place = Place(programs, pathlib.Path(folder))
        place.run(f"{PROGRAMS}/palpate drive scenes/liver.toml --seconds {5 if everything else 3} --log {LOGS[0]}", "logs for what follows")
        for log in LOGS[1:]:
            shutil.copy(place.folder / LOGS[0], place.folder / log)
        organ_files.write_all(place.folder)
        for page in pages if everything else PAGES_IN_SHORT:
            if page != "README.md":
                place.find_programs()
            run_page(place, page, everything)
        check_demo(place)
        run_project(place)
        run_reader(place)
        if everything:
            run_tasks(place)
    for failure in place.failures:
        print("failed:", failure)
    return 1 if place.failures else 0


sys.exit(main())
