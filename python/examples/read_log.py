"""Forces of a log as arrays, and the same run again in lock step: read_log.py SCENES"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import palpate

import numpy as np

program = shutil.which("palpate") or pathlib.Path(palpate.__file__).parents[2] / "bin" / "palpate"  # or beside a build
with tempfile.TemporaryDirectory() as folder:
    log = folder + "/run.lcmlog"
    scene = sys.argv[1] + "/liver.toml"
    subprocess.run([program, "drive", scene, "--seconds", "1.8", "--log", log], check=True, stdout=subprocess.DEVNULL)
    print(palpate.topics_in(log))
    recorded = palpate.read_log(log, "force_state")

sim = palpate.Simulator(palpate.Scene(scene))
force = []
for _ in recorded["step"]:
    sim.follow()
    force.append(sim.force[0])
assert recorded["force"].shape == (1800, 3)
assert np.array_equal(recorded["force"], force), "bit for bit"
assert np.abs(force).max() > 0.1
