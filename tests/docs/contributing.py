"""Holds CONTRIBUTING.md to the tree: its layout has every folder, and the files and targets that it names are there."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "CONTRIBUTING.md").read_text().replace("``", "")
OF_THE_READER = ("build/", "NAME")  # made by the build, or by who follows the page
TOPS = ["common", "tools"]  # whose folders the layout has one by one


def layout_faults():
    block = PAGE.split("## Layout")[1].split("## ")[0]
    for room in re.split(r"^    (?=\w)", block, flags=re.MULTILINE)[1:]:
        top = room.split("/")[0]
        for folder in re.findall(r"^      (\w+)/", room, re.MULTILINE):
            if not (ROOT / top / folder).is_dir():
                yield f"the layout has {top}/{folder}, which is not there"
        for folder in sorted(p for p in (ROOT / top).iterdir() if p.is_dir()) if top in TOPS else []:
            if not re.search(rf"(?<!\S){folder.name}/", room.split("/", 1)[1]):
                yield f"the layout lacks {top}/{folder.name}"


def named_files(text):
    """Words of code with a folder in them."""
    words = [word for code in re.findall(r"`([^`]+)`", text) for word in code.split()]
    return [w for w in words if re.fullmatch(r"[\w.-]+(/[\w.-]+)+", w) and not any(mark in w for mark in OF_THE_READER)]


def name_faults():
    for file in named_files(PAGE):
        if not (ROOT / file).exists():
            yield f"{file} is not there"
    for sentence in re.split(r"\.\s", PAGE):
        lists = [file for file in named_files(sentence) if file.endswith("CMakeLists.txt") and (ROOT / file).exists()]
        text = " ".join((ROOT / file).read_text() for file in lists)
        for target in re.findall(r"`(palpate_\w+)", sentence) if lists else []:
            if not re.search(rf"\b{target}\b", text):
                yield f"{', '.join(lists)} has no {target}"


faults = [*layout_faults(), *name_faults()]
print(*faults, sep="\n")
assert len(named_files(PAGE)) > 15, "hardly a file is named: the page is not read as it is written"
sys.exit(1 if faults else 0)
