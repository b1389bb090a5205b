"""Grains fall into an open box and come to rest."""

import grit

sim = grit.Simulation({
    "title": "gravity deposition",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"density": "2600 kg/m^3", "contact_modulus": "5 MPa", "friction_angle": "27 deg"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "20 mm"], "count": 150,
        "sizes": {"type": "uniform", "smallest": "1.5 mm", "largest": "2 mm"}}}},
    "walls": {"box": {"type": "box", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "30 mm"], "open": ["z_high"], "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [{"name": "fall", "until": {"type": "at-rest", "below": 0.05}, "limit": "2 s"}],
})


@sim.probe("fall", every_time=5e-3, units={"height": "m", "energy": "J"})
def fall():
    return {"height": sim.bodies.position[:, 2].max(), "energy": sim.kinetic_energy}


sim.run()
print(sim, len(sim.contacts), "contacts")
print("weight on the box:", -sim.walls["box"].force[2], "N, of the grains:", 9.81 * sim.bodies.mass.sum(), "N")
assert sim.done and abs(sim.walls["box"].force[2] + 9.81 * sim.bodies.mass.sum()) < 0.05 * 9.81 * sim.bodies.mass.sum()
assert sim.series("fall")["height"][-1] < 15e-3
