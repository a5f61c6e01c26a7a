"""One node of a plate held 2 mm down, and the shape that follows: solve_plate.py SCENES"""
import sys

import palpate

import numpy as np

state = palpate.solve(palpate.Scene(sys.argv[1] + "/plate.toml"), {180: (None, None, -0.002)})
held = np.flatnonzero(state["node"] == 180)[0]
print(f"{state['force'][held, 2]:.4f} N hold node 180 at {1e3 * state['displacement'][held, 2]:.2f} mm")
assert np.isclose(state["displacement"][held, 2], -0.002)
assert state["force"][held, 2] < 0
assert np.count_nonzero(np.abs(state["force"]).max(axis=1) > 1e-12) == 1
