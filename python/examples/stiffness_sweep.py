"""The same press on tissue of several stiffnesses: stiffness_sweep.py SCENES"""
import sys

import palpate

import numpy as np

young = np.array([5e4, 1e5])
force = []
for value in young:
    sim = palpate.Simulator(palpate.Scene(sys.argv[1] + "/plate.toml", {"body.young": value}))
    while not sim.over:
        sim.follow(100)
    force.append(sim.figures()["tool.first.force.max"])
print(np.column_stack([young, force]))
assert np.all(np.diff(force) > 0)
