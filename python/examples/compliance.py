"""A plate's stored tensors: what a force at a node does, by them and by solve(): compliance.py SCENES"""
import sys

import palpate

import numpy as np

scene = palpate.Scene(sys.argv[1] + "/plate.toml")
assert any("tetrahedra" in line for line in palpate.check(scene)["bodies"][0]["said"])
archive = palpate.Archive(scene)
k = len(archive.dofs)
full = np.zeros((k, k))
full[np.tril_indices(k)] = archive.compliance
full += np.tril(full, -1).T

row = np.flatnonzero(archive.node == 180)[0]
at = np.flatnonzero((archive.dofs == (row, 2)).all(axis=1))[0]
state = palpate.solve(scene, forces={180: (0, 0, -0.1)})
displacement = -0.1 * full[:, at]
print(f"0.1 N push node 180 {-1e3 * displacement[at]:.3f} mm down")
assert np.allclose(state["displacement"][archive.dofs[:, 0], archive.dofs[:, 1]], displacement, rtol=1e-9, atol=1e-15)

assert not archive.compliance.flags.writeable and archive.compliance.base is not None
compliance = palpate.Archive(scene).compliance  # keeps its archive alive
assert np.array_equal(compliance, archive.compliance)
