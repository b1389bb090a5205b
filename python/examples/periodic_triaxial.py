"""Triaxial compression of a periodic cell: isotropic first, then axial strain at constant lateral stress."""

import math

import grit

side, pressure = 10e-3, 50e3  # m, Pa
sim = grit.Simulation({
    "title": "triaxial compression of a periodic cell",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "20 MPa", "friction_angle": 0}},
    "domain": {"low": [0, 0, 0], "high": [side, side, side], "periodic": [True, True, True],
               "servo": {"stress": {"xx": pressure, "yy": pressure, "zz": pressure}, "max_strain_rate": "10 1/s"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": [side, side, side], "count": 300,
        "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "1.2 mm"}}}},
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [
        {"name": "isotropic", "limit": "1 s", "until": {"type": "all", "of": [
            {"type": "stress", "component": "zz", "value": pressure, "within": 0.02}, {"type": "unbalanced-force", "below": 0.01}]}},
        {"name": "deviatoric", "until": {"type": "time", "value": "40 ms"}, "limit": "1 s", "change": {
            "materials": {"sand": {"friction_angle": "27 deg"}},
            "domain": {"servo": {"stress": {"zz": None}}, "strain_rate": [0, 0, "-2 1/s"]}}},
    ],
})
sim.run_stage()
dense = sim.void_ratio()


@sim.probe("test", every_time=0.5e-3, units={"lateral": "Pa", "axial": "Pa"})
def test():
    stress = sim.stress()
    return {"lateral": (stress[0, 0] + stress[1, 1]) / 2, "axial": stress[2, 2], "void_ratio": sim.void_ratio()}


sim.run()
curve = sim.series("test")
ratio = (curve["axial"] / curve["lateral"]).max()
print(f"void ratio {dense:.3f}, peak stress ratio {ratio:.2f}, dilation by {curve['void_ratio'][-1] - dense:.3f}")
assert abs(curve["lateral"][len(curve["lateral"]) // 2:].mean() / pressure - 1) < 0.05
coulomb = (1 + math.sin(math.radians(27))) / (1 - math.sin(math.radians(27)))  # of sliding between grains; a dense packing dilates and bears more
assert coulomb < ratio < 4 * coulomb and curve["void_ratio"][-1] > dense
