"""A sphere falls on a plane and bounces: the restitution is the square root of the ratio of heights."""

import grit

restitution, height, radius = 0.7, 0.1, 5e-3  # –, m, m
sim = grit.Simulation({
    "title": "bouncing sphere",
    "contacts": {"type": "linear-rolling"},
    "materials": {"steel": {"density": "7800 kg/m^3", "contact_modulus": "50 MPa", "restitution": restitution}},
    "bodies": {"ball": {"type": "sphere", "material": "steel", "source": {
        "type": "list", "bodies": [{"position": [0, 0, height + radius], "radius": radius}]}}},
    "walls": {"floor": {"type": "plane", "material": "steel"}},
    "engines": {"gravity": {"type": "gravity"}},
    "time_step": {"steps_per_impact": 50},
    "stages": [{"name": "bounce", "until": {"type": "time", "value": "1 s"}, "limit": "2 s"}],
})


def rising():
    return sim.bodies.velocity[0, 2] > 0


while not rising():
    sim.run(20)
while rising():
    sim.run(20)
rebound = sim.bodies.position[0, 2] - radius
print(f"rebound to {1e3 * rebound:.1f} mm, restitution {(rebound / height)**0.5:.3f}")
assert abs((rebound / height)**0.5 - restitution) < 0.01 * restitution
