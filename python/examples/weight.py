"""The sag of a cylinder by its own weight, and the forces that hold it: weight.py SCENES"""
import sys

import palpate

import numpy as np

scene = palpate.Scene(sys.argv[1] + "/cylinder_hybrid.toml")
state = palpate.solve(scene, gravity=(0, 0, -9.81), method="direct")
print(f"it sags {-1e3 * state['displacement'][:, 2].min():.2f} mm")
assert -0.05 < state["displacement"][:, 2].min() < -1e-4
assert abs(state["force"][:, 2].sum()) < 1e-6, "what holds it is its weight"
