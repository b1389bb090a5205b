"""Clumps of spheres are poured into a box. Each falls and rotates as one rigid body; their spheres carry the loads."""

import numpy

import grit

sim = grit.Simulation({
    "title": "deposition of clumps",
    "contacts": {"type": "linear-rolling"},
    "materials": {"stone": {"contact_modulus": "2 MPa", "friction_angle": "30 deg"}},
    "bodies": {"rods": {"type": "clump", "shape": {"type": "rod", "count": 3}, "material": "stone", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": ["20 mm", "20 mm", "50 mm"], "count": 60,
        "sizes": {"type": "uniform", "smallest": "5 mm", "largest": "6 mm"}}}},
    "walls": {"box": {"type": "box", "low": [0, 0, 0], "high": ["20 mm", "20 mm", "60 mm"], "open": ["z_high"], "material": "stone"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [{"name": "fall", "until": {"type": "at-rest", "below": 0.02}, "limit": "2 s"}],
})
sim.run()
weight = 9.81 * sim.clumps.mass.sum()
standing = abs(sim.clumps.axes[:, 2, :])[numpy.arange(len(sim.clumps)), sim.clumps.inertia.argmin(axis=1)]
print(f"{len(sim.clumps)} clumps of {len(sim.bodies)} spheres; load on the box {-sim.walls['box'].force[2] / weight:.3f} of the weight")
print(f"mean |cos| of long axes with the vertical: {standing.mean():.2f}; 0.5 for random directions, less for rods that lie")
assert len(sim.bodies) == 3 * len(sim.clumps) and abs(sim.walls["box"].force[2] + weight) < 0.05 * weight
assert standing.mean() < 0.5
