"""Force over depth of a press on the liver: force_depth.py SCENES [PICTURE.png]"""
import sys

import palpate

import numpy as np

sim = palpate.Simulator(palpate.Scene(sys.argv[1] + "/liver.toml"))
curve = []
while sim.time < 3:
    sim.follow()
    curve.append((1e3 * sim.dofs[0, 2], np.linalg.norm(sim.force[0])))
depth, force = np.array(curve).T

assert force[0] == 0 and 0.3 < force.max() < 1
if len(sys.argv) > 2:
    import matplotlib.pyplot as plt

    plt.plot(depth, force)
    plt.xlabel("depth of the tip beyond the trocar [mm]")
    plt.ylabel("force [N]")
    plt.savefig(sys.argv[2])
