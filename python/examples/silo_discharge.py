"""A silo is filled, its gate slides away, and the grains leave through the open lower side of the domain, more slowly than a fluid."""

import math

import grit

width, depth, outlet = 24e-3, 6e-3, 10e-3  # m
sim = grit.Simulation({
    "title": "discharge of a silo",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa", "friction_angle": "20 deg"}},
    "domain": {"low": [-width, 0, "-10 mm"], "high": [width, depth, "0.1 m"], "periodic": [False, True, False], "open_sides": ["-z"]},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [-width / 2, 0, "1 mm"], "high": [width / 2, depth, "40 mm"], "count": 400,
        "sizes": {"type": "uniform", "smallest": "1.4 mm", "largest": "1.6 mm"}}}},
    "walls": {
        "left": {"type": "plane", "material": "sand", "point": [-width / 2, 0, 0], "normal": [1, 0, 0]},
        "right": {"type": "plane", "material": "sand", "point": [width / 2, 0, 0], "normal": [-1, 0, 0]},
        "floor_left": {"type": "rectangle", "material": "sand", "corner": [-width, -depth, 0], "edge_a": [width - outlet / 2, 0, 0], "edge_b": [0, 3 * depth, 0]},
        "floor_right": {"type": "rectangle", "material": "sand", "corner": [outlet / 2, -depth, 0], "edge_a": [width - outlet / 2, 0, 0], "edge_b": [0, 3 * depth, 0]},
        "gate": {"type": "rectangle", "material": "sand", "corner": [-outlet, -depth, 0], "edge_a": [2 * outlet, 0, 0], "edge_b": [0, 3 * depth, 0]},
    },
    "engines": {"gravity": {"type": "gravity"}},
    "stages": [
        {"name": "fill", "until": {"type": "at-rest", "below": 0.05}, "limit": "2 s"},
        {"name": "discharge", "until": {"type": "time", "value": "1 s"}, "limit": "2 s"},
    ],
})
sim.run_stage()
mass = sim.bodies.mass.sum()
head = sim.bodies.position[:, 2].max()
sim.set("/walls/gate/motion/velocity", ["1 m/s", 0, 0])
while len(sim.departures) < 200:
    sim.run(200)
duration = sim.departures.time[-1] - sim.departures.time[0]
rate = sim.departures.mass.sum() / duration
fluid = sim.solid_density * outlet * depth * math.sqrt(2 * 9.81 * head)  # an ideal fluid as heavy as the solid
print(f"{len(sim.departures)} grains in {duration:.2f} s: {1e3 * rate:.1f} g/s, {rate / fluid:.2f} of a fluid")
assert 0.05 * fluid < rate < 0.6 * fluid
assert abs(sim.bodies.mass.sum() + sim.departures.mass.sum() - mass) < 1e-9 * mass
