"""A sphere on an inclined plane rolls without slip as long as tan θ < 7/2 μ: its acceleration is 5/7 g sin θ, else g (sin θ - μ cos θ)."""

import math

import grit

g, angle = 9.81, math.radians(30)


def acceleration(friction):
    """Of a sphere that starts at rest [m/s²]."""
    sim = grit.Simulation({
        "title": "sphere on an inclined plane",
        "contacts": {"type": "linear-rolling"},
        "materials": {"glass": {"contact_modulus": "10 MPa", "friction_angle": math.atan(friction), "rolling_stiffness": 0, "rolling_limit": 0}},
        "bodies": {"ball": {"type": "sphere", "material": "glass", "source": {
            "type": "list", "bodies": [{"position": [0, 0, "10 mm"], "radius": "10 mm"}]}}},
        "walls": {"plane": {"type": "plane", "material": "glass"}},
        "engines": {"gravity": {"type": "gravity", "acceleration": [g * math.sin(angle), 0, -g * math.cos(angle)]}},
        "stages": [{"name": "roll", "until": {"type": "time", "value": "0.2 s"}, "limit": "1 s"}],
    })
    sim.run()
    return sim.bodies.velocity[0, 0] / sim.time


rolls, slips = acceleration(0.5), acceleration(0.1)
print(f"rolls with {rolls:.3f} m/s², slips with {slips:.3f} m/s²")
assert abs(rolls - 5 / 7 * g * math.sin(angle)) < 0.01 * rolls
assert abs(slips - g * (math.sin(angle) - 0.1 * math.cos(angle))) < 0.01 * slips
