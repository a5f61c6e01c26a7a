"""Writes docs/footprint.md from short runs of every example scene: footprint_table.py [BIN]."""
import json
import pathlib
import platform
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent
bin_folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "build/release/bin"
nodes = ["haptic_node", "deform_node", "render_node"]


def run(scene):
    with tempfile.TemporaryDirectory() as folder:
        summary = pathlib.Path(folder) / "summary.json"
        keys = []
        if "[network.security]" in scene.read_text():
            keys = ["--keys", pathlib.Path(folder) / "keys"]
            subprocess.run([bin_folder / "palpate", "keys", keys[1]], check=True, capture_output=True)
        subprocess.run([bin_folder / "palpate", "precompute", scene], check=True, capture_output=True)
        subprocess.run([bin_folder / "palpate", "run", scene, "--seconds", "1", "--processes", "2", "--domain", "96", "--summary", summary, *keys],
                       check=True, capture_output=True)
        return json.loads(summary.read_text())


def cell(node):
    return f"{node['resident_bytes'] / 1e6:.0f} MB, {node['startup_s']:.2f} s" if node else "not started"


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return platform.machine()


commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
lines = ["# What a scene costs", "",
         "Resident memory of each process when it is ready, and the time from its start until then, archives being there",
         f"already. Written by `scripts/footprint_table.py`; {machine()}, commit {commit}.", "",
         "| scene | haptic node | deformation node | render node |", "| --- | --- | --- | --- |"]
for scene in sorted((root / "scenes").glob("*.toml")):
    print(scene.stem, file=sys.stderr)
    summary = run(scene)
    lines.append(f"| {scene.stem} | " + " | ".join(cell(summary.get(name)) for name in nodes) + " |")
lines += ["",
          "What runs with `--processes 2` is what the scene's sections ask for: a test starts every example scene and compares, from outside,",
          "its processes, the topics on the network, the haptic node's threads and its open files with the sections",
          "(`tests/tools/scene_needs_test.cpp`). A scene with one linear organ has two threads in the haptic node, opens no",
          "topic of cutting, modes or catheters, and starts no deformation node. `palpate check SCENE` says what will be",
          "built, how large it is, and what is left out.", "",
          "The programs are the same for all scenes, and with them the libraries that they link: the haptic node links no",
          "library of pictures, films, meshes or sparse solvers (`tests/tools/homes_test.cpp`)."]
(root / "docs/footprint.md").write_text("\n".join(lines) + "\n")
