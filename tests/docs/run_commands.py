#!/usr/bin/env python3
"""run_commands.py BIN [--all]: runs the lines of README.md and docs/ that call a program of this project word for word, in
a folder with a copy of scenes/ and what docs/organ.md begins with, then the CTest project of docs/drive.md and the reader
of docs/logs.md, each as the page has it. Sections for two hosts run as a whole, this machine being both. Some lines are
shortened by an option of theirs, some exempt: the tables below say which and why.
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
COMMANDS = ("palpate ", f"{PROGRAMS}/palpate ", "mkdir ", "export PATH=", "haptic_node ", "render_node ", "web_node ", "ros_bridge ", "palpate_generate ", "./scripts/demo.sh")

# Sections whose lines belong together: (page, heading, what goes before, what leaves nothing behind).
WALKS_IN_SHORT = [("README.md", "Two machines", "true", "scripts/deploy.sh HOST --remove")]
WALKS = WALKS_IN_SHORT + [("docs/deploy.md", "In short", "true", "true"),
                          ("docs/security.md", "In short", "rm -r scenes/keys; cd scenes", "true")]  # README's keys

# This machine in place of the pages' hosts, and its folders in place of theirs: (pattern, words).
HERE = [(r"\bHOST\b|\b192\.168\.1\.\d+\b|\b10\.0\.0\.3\b", "127.0.0.1"), (r"\beth0\b", "lo"), (r"^\./scripts/build\.sh$", "true"),
        (r"\bbuild/release\b", "{build}"), (r"/opt/palpate", "{folder}/opt")]

# Never run: (page, line, why). `*` stands for anything.
EXEMPT = [
    ("docs/papers.md", "*", "the test `papers` runs them"),
    ("docs/deploy.md", "*", "its lines belong together: a walk"),
    ("docs/security.md", "*", "its lines belong together: a walk"),
    ("README.md", "* scenes/two_hosts.toml *", "belongs to a walk"),
    ("README.md", "* scenes/keys*", "belongs to a walk"),
    ("docs/latency.md", "* HOST_?*", "names two hosts, of which one answers until Ctrl-C"),
    ("docs/meshes.md", "*[[]*", "shows what may stand there"),
    ("docs/drive.md", "palpate drive --merge results.jsonl *", "belongs to the lines of tasks, which run together below"),
]

# Run with more words at their end: (line, words). A later row goes before an earlier one.
SHORTENED = [
    ("palpate run *", "--seconds 1"),
    ("haptic_node *", "--seconds 2"),
    ("render_node *", "--seconds 2"),
    ("web_node *", "--seconds 2"),
    ("ros_bridge *", "--seconds 2"),
    ("*_node * --seconds *", ""),
    ("palpate run * --record *", "--seconds 2"),
    ("*palpate run * --web*", "--seconds 1"),
    ("palpate drive scenes/liver.toml * --log *", "--seconds 3"),
    ("palpate latency*", "--seconds 1"),
    ("palpate latency * --seconds *", ""),
    ("palpate record *", "--seconds 2"),
    ("palpate top*", "--once"),
    ("palpate top* --once*", ""),
    ("palpate study *", "--quick"),
    ("palpate stability *", "--quick"),
    ("* --quick*", ""),
    ("palpate film out/* -o *", "--to 1"),
    ("palpate film * --from 2 --to 4 *", ""),
]

# Only with --all: minutes of computing.
LONG = ["palpate study *", "palpate stability *", "palpate modes *", "* --sweep *", "palpate drive *--set body.young*",
        "palpate film * --speed 0.1 *", "./scripts/demo.sh"]

# Need a program that is built only where its libraries are: (line, program).
NEEDS = [("palpate mesh *", "palpate_organ"), ("palpate organ *", "palpate_organ"), ("palpate segment *", "palpate_organ"),
         ("palpate * organ.*", "palpate_organ"), ("palpate_generate *", "palpate_generate")]

# Need a running system: one runs meanwhile.
BESIDE_A_RUN = ["palpate record *", "palpate top*", "render_node *", "web_node *", "ros_bridge *"]

# Run where the sources are.
AT_THE_TOP = ["./scripts/demo.sh"]

# May end with an error that ends with these words: (line, words).
ENDS_SO = [("palpate stability *", "points failed; see out/")]  # docs/stability.md names them

# Logs that lines take and the page does not make.
LOGS = ["out/liver.lcmlog", "monday.lcmlog", "friday.lcmlog", "session.lcmlog"]


def matches(line, patterns):
    return any(fnmatch.fnmatchcase(line, pattern) for pattern in patterns)


def lines_of(page):
    """The lines of indented and fenced blocks that call a program, make a folder for one, or tell the shell where it is."""
    fenced = False
    for line in (ROOT / page).read_text().splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif (fenced or line.startswith("    ")) and line.strip().startswith(COMMANDS) and "►" not in line:
            yield line.strip()


def section_lines(page, heading):
    """All indented lines of a section."""
    text = (ROOT / page).read_text().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return [line.strip() for line in text.splitlines() if line.startswith("    ")]


def shortened(line):
    command, background = re.fullmatch(r"(.*?)( &)?", bare(line)).groups()
    words = next((more for pattern, more in reversed(SHORTENED) if fnmatch.fnmatchcase(command, pattern)), "")
    return f"{command} {words}".strip() + (background or "")


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
        # Tests beside this one put files in place under scenes/meshes/.palpate, by other names first.
        shutil.copytree(ROOT / "scenes", folder / "scenes", ignore=shutil.ignore_patterns("keys", "*.tmp-*"))
        (folder / PROGRAMS).parent.mkdir(parents=True)
        (folder / PROGRAMS).symlink_to(programs)
        (folder / "scripts").symlink_to(ROOT / "scripts")
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

    def here(self, line):
        """A line with this machine and its folders in place of the page's."""
        for pattern, words in HERE:
            line = re.sub(pattern, words.format(build=self.programs.parent, folder=self.folder), line)
        return line

    def make_other_host(self):
        """A folder that is the home directory there, and an ssh that goes there whichever host is named."""
        (self.folder / "far").mkdir()
        ssh = self.folder / "ssh" / "ssh"
        ssh.parent.mkdir()
        ssh.write_text(f"""#!/bin/sh
while [ "${{1#-}}" != "$1" ]; do shift 2; done  # -o WORD
shift  # the host
cd {self.folder}/far
export HOME={self.folder}/far SSH_CONNECTION='127.0.0.1 1 127.0.0.1 22'
exec sh -c "$*"
""")
        ssh.chmod(0o755)
        self.environment["PATH"] = f"{ssh.parent}:{self.folder}/scripts:{self.environment['PATH']}"

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
            place.run(place.here(shortened(line)), page, ROOT if matches(bare(line), AT_THE_TOP) else ".")


def run_walk(place, page, heading, before, after):
    """The lines of a section one after the other in one shell."""
    lines = [place.here(shortened(line)) for line in [before, *section_lines(page, heading), after]]
    place.run("\n".join(["set -e", *lines]), f"{page}, {heading}")


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
        place.make_other_host()
        for walk in WALKS if everything else WALKS_IN_SHORT:
            run_walk(place, *walk)
        run_project(place)
        run_reader(place)
        if everything:
            run_tasks(place)
    for failure in place.failures:
        print("failed:", failure)
    return 1 if place.failures else 0


sys.exit(main())
