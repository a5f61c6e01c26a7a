"""A controller of one's own presses the liver with a constant force: closed_loop.py SCENES"""
import sys

import palpate

import numpy as np

WANTED = 0.2  # N
GAIN = 2e-4  # m per N and step

sim = palpate.Simulator(palpate.Scene(sys.argv[1] + "/liver.toml", {"contact.friction": 0}))
sim.follow(1500)  # the scripted motion brings the tip onto the tissue
dofs = sim.dofs
for _ in range(2000):
    dofs[0, 2] += GAIN * (WANTED - np.linalg.norm(sim.force[0]))
    sim.step(dofs)

force = np.linalg.norm(sim.force[0])
print(f"{force:.3f} N at a depth of {1e3 * sim.dofs[0, 2]:.2f} mm")
assert abs(force - WANTED) < 0.01 * WANTED
assert sim.contacts(0)[0]["body"] == "liver"
