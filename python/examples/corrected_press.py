"""One node on top of a cylinder of brain held 3 mm down, by the measured law: corrected_press.py SCENES"""
import sys

import palpate

import numpy as np

state = palpate.solve(palpate.Scene(sys.argv[1] + "/brain_cylinder.toml"), {218: (None, None, -0.003)})
held = np.flatnonzero(state["node"] == 218)[0]
force = state["force"][held, 2]
print(f"{force:.5f} N hold node 218, {state['correction']:.3f} of what linear tissue would need")
assert force < 0 and 0 < state["correction"] < 1
