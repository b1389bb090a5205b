"""Triaxial test between six frictionless walls: isotropic compression, then axial strain at constant lateral pressure."""

import math

import grit

side, pressure, rate = 10e-3, 50e3, 2.0  # m, Pa, 1/s
faces = {"left": (0, 1), "right": (0, -1), "front": (1, 1), "back": (1, -1), "bottom": (2, 1), "top": (2, -1)}  # axis and direction of the inner normal


def wall(axis, inwards):
    point, normal = [0, 0, 0], [0, 0, 0]
    point[axis], normal[axis] = -inwards * side / 2, inwards
    return {"type": "plane", "point": point, "normal": normal, "material": "wall", "extent": 2 * side,
            "motion": {"servo": {"axis": "xyz"[axis], "pressure": pressure, "area": "specimen", "max_velocity": "0.2 m/s"}}}


def driven(velocity):
    return {"motion": {"servo": None, "velocity": [0, 0, velocity]}}


sim = grit.Simulation({
    "title": "triaxial test",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "20 MPa", "friction_angle": "5 deg"}, "wall": {"friction_angle": 0}},
    "domain": {"low": [-side, -side, -side], "high": [side, side, side]},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [-side / 2, -side / 2, -side / 2], "high": [side / 2, side / 2, side / 2], "count": 400,
        "sizes": {"type": "uniform", "smallest": "0.9 mm", "largest": "1.2 mm"}}}},
    "walls": {name: wall(*face) for name, face in faces.items()},
    "specimen": {"low": ["left", "front", "bottom"], "high": ["right", "back", "top"]},
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.3}},
    "stages": [
        {"name": "isotropic", "limit": "1 s", "until": {"type": "all", "of": [
            *({"type": "pressure", "wall": name, "value": pressure, "within": 0.02} for name in faces), {"type": "unbalanced-force", "below": 0.01}]}},
        {"name": "deviatoric", "until": {"type": "time", "value": "50 ms"}, "limit": "1 s", "change": {
            "materials": {"sand": {"friction_angle": "27 deg"}},
            "walls": {"bottom": driven(rate * side / 2), "top": driven(-rate * side / 2)}}},
    ],
})
sim.run_stage()


@sim.probe("test", every_time=1e-3, units={"axial": "Pa", "lateral": "Pa"})
def test():
    stress = sim.stress()
    return {"axial": stress[2, 2], "lateral": (stress[0, 0] + stress[1, 1]) / 2}


sim.run()
curve = sim.series("test")
peak = (curve["axial"] / curve["lateral"]).max()
print(f"peak stress ratio {peak:.2f}, lateral pressure {curve['lateral'][10:].mean() / 1e3:.1f} kPa")
assert abs(curve["lateral"][10:].mean() / pressure - 1) < 0.05
coulomb = (1 + math.sin(math.radians(27))) / (1 - math.sin(math.radians(27)))  # of sliding between grains; a dense packing bears more
assert coulomb < peak < 4 * coulomb
