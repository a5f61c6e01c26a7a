#!/usr/bin/env python3
"""Every test that a table of docs/safety.md names is there: `Suite.*`, `Suite.ItsNameBeginsSo...`, `Instance/Suite.*`."""
import fnmatch
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = re.compile(r"`((?:\w+/)?[A-Z]\w*\.[\w*]+(?:\.\.\.)?)`")
TEST = re.compile(r"\b(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,\s*(\w+)\s*\)")
INSTANCE = re.compile(r"\bINSTANTIATE_TEST_SUITE_P\(\s*(\w+)\s*,\s*(\w+)")


def tests():
    """Suite.Test of the sources, and Instance/Suite.Test where a suite has instances."""
    text = "\n".join(file.read_text() for file in sorted((ROOT / "tests").rglob("*.[ch]pp")))
    found = [".".join(test) for test in TEST.findall(text)]
    for instance, suite in INSTANCE.findall(text):
        found += [f"{instance}/{test}" for test in found if test.startswith(suite + ".")]
    return found


def main():
    rows = [line for line in (ROOT / "docs/safety.md").read_text().splitlines() if line.startswith("|")]
    named = sorted({name for row in rows for name in NAME.findall(row)})
    there = tests()
    missing = [name for name in named if not fnmatch.filter(there, name.replace("...", "*"))]
    for name in missing:
        print(f"docs/safety.md names {name}, and no test is called so", file=sys.stderr)
    if not named:
        print("docs/safety.md names no test", file=sys.stderr)
    return 1 if missing or not named else 0


if __name__ == "__main__":
    sys.exit(main())
