"""What scenes, static states, runs and logs take, refuse and warn of: simulator.py SCENES"""
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import warnings

import palpate

import numpy as np

from refused import refused

scenes = pathlib.Path(sys.argv[1]).resolve()
plate = palpate.Scene(scenes / "plate.toml")

for method in "tensors", "direct":
    for number in math.nan, math.inf, -math.inf:
        refused(ValueError, "hold of node 180", lambda: palpate.solve(plate, {180: (None, None, number)}, method=method))
        refused(ValueError, "force on node 180", lambda: palpate.solve(plate, forces={180: (0, number, 0)}, method=method))
        refused(ValueError, "gravity", lambda: palpate.solve(plate, gravity=(0, 0, number), method=method))
    refused(RuntimeError, "not finite", lambda: palpate.solve(plate, forces={180: (0, 0, 1e308)}, method=method))

changed = palpate.Scene(scenes / "plate.toml", {
    "title": 'a "b" of\tsome', "tool.first.pivot": np.array([0.0, 0.01, 0.25]), "tool.first.up": (0, 1, 0), "body.young": np.float64(8e3),
    "rates.haptic_hz": np.int64(500), "tool.first.trajectory": scenes / "trajectories/plate_second.csv", "render.overlay": False})
assert changed.title == 'a "b" of\tsome'
for line in "pivot = [0.0, 0.01, 0.25]", "up = [0.0, 1.0, 0.0]", "young = 8000.0", "haptic_hz = 500.0", "overlay = false":
    assert line in changed.to_toml(), line
refused(RuntimeError, "young must be a number, not a string", lambda: palpate.Scene(scenes / "plate.toml", {"body.young": "8000"}))

with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    bad = folder / "bad.csv"
    bad.write_text("time,yaw\n0,0\n")
    os.environ["PALPATE_CACHE"] = str(folder / "cache")
    scene = palpate.Scene(scenes / "plate.toml", {"tool.first.trajectory": bad})
    refused(RuntimeError, "the header must be", lambda: palpate.Simulator(scene))
    assert not (folder / "cache").exists(), "it is read before archives are computed"
    del os.environ["PALPATE_CACHE"]

    log, cut = folder / "run.lcmlog", folder / "cut.lcmlog"
    program = pathlib.Path(palpate.__file__).parents[2] / "bin" / "palpate"
    subprocess.run([program, "drive", scenes / "plate.toml", "--seconds", "0.1", "--log", log], check=True, stdout=subprocess.DEVNULL)
    cut.write_bytes(log.read_bytes()[:-1000])
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        whole = palpate.topics_in(log), len(palpate.read_log(log, "force_state")["step"])
        assert not said, "of a whole log"
        damaged = palpate.topics_in(cut), len(palpate.read_log(cut, "force_state")["step"])
    assert sum(damaged[0].values()) < sum(whole[0].values())
    assert len(said) == 2 and str(said[0].message) == str(said[1].message)
    assert str(said[0].message).startswith(f"{cut}: the last event is cut off at byte ")
    told = subprocess.run([program, "info", cut], check=True, capture_output=True, text=True).stdout
    assert str(said[0].message) in told.splitlines(), "the sentence of palpate info"

simulator = palpate.Simulator(plate)
refused(ValueError, "-1 steps", lambda: simulator.follow(-1))
simulator.follow(0)
assert simulator.time == 0
for number in math.nan, math.inf:
    refused(ValueError, "finite", lambda: simulator.step(np.full((2, 6), number)))
for documented in palpate.Scene, palpate.Device, palpate.Simulator, palpate.Simulator.step:
    assert documented.__doc__, documented

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell in the background ignores
threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
try:
    simulator.follow(10**9)
    assert False, "Ctrl-C ends it"
except KeyboardInterrupt:
    assert simulator.time > 0
simulator = palpate.Simulator(plate)
while not simulator.contacts(0):
    assert not simulator.over
    simulator.follow(100)
contact = simulator.contacts(0)[0]
for name, length in ("nodes", 3), ("weights", 3), ("normal", 3), ("force", 3):
    assert isinstance(contact[name], np.ndarray) and contact[name].shape == (length,), name

view = simulator.surface_view()
seen = view.copy()
simulator.follow(300)
assert np.array_equal(simulator.surface(), simulator.origin() + view), "a call brings it up to the last step"
assert not np.array_equal(view, seen), "of the same memory"
assert not view.flags.writeable and not simulator.normals().flags.writeable
simulator.follow(50)
at = simulator.surface()
del simulator
assert np.allclose(at - view, at[0] - view[0], atol=1e-6), "which a view keeps alive"
