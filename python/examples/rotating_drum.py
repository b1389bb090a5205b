"""Grains in a rotating drum: their surface is inclined, and the moment on the drum lifts their centre of mass sideways."""

import math

import numpy

import grit

radius, depth, speed = 20e-3, 8e-3, 3.0  # m, m, rad/s
sim = grit.Simulation({
    "title": "rotating drum",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa", "friction_angle": "35 deg"}, "end": {"friction_angle": 0}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": ["-14 mm", 0, "-14 mm"], "high": ["14 mm", depth, "8 mm"], "count": 250,
        "sizes": {"type": "uniform", "smallest": "2 mm", "largest": "2.5 mm"}}}},
    "walls": {
        "drum": {"type": "cylinder", "start": [0, 0, 0], "end": [0, depth, 0], "radius": radius, "material": "sand", "motion": {"spin": [0, speed, 0], "ramp_time": "0.1 s"}},
        "back": {"type": "plane", "material": "end", "point": [0, 0, 0], "normal": [0, 1, 0]},
        "front": {"type": "plane", "material": "end", "point": [0, depth, 0], "normal": [0, -1, 0]},
    },
    "engines": {"gravity": {"type": "gravity"}},
    "stages": [{"name": "turn", "until": {"type": "time", "value": "1 s"}, "limit": "2 s"}],
})


@sim.probe("drum", every_time=5e-3, units={"x": "m", "z": "m", "moment": "N m"})
def drum():
    x, _, z = numpy.average(sim.bodies.position, axis=0, weights=sim.bodies.mass)
    return {"x": x, "z": z, "moment": sim.walls["drum"].moment[1]}


sim.run()
late = slice(len(sim.series("drum")["time"]) // 2, None)
x, z, moment = (sim.series("drum")[name][late].mean() for name in ("x", "z", "moment"))
weight = 9.81 * sim.bodies.mass.sum()
angle = math.degrees(math.atan2(abs(x), -z))
print(f"dynamic angle of repose {angle:.0f}°, moment on the drum {moment:.2e} N m, of the weight {weight * x:.2e} N m")
assert 20 < angle < 50
assert abs(moment - weight * x) < 0.1 * abs(moment)
