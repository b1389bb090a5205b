"""Grains without walls are compressed isotropically, then sheared at constant normal stress."""

import grit

side = 10e-3  # m
sim = grit.Simulation({
    "title": "simple shear of a periodic cell",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "10 MPa", "friction_angle": "27 deg"}},
    "domain": {"low": [0, 0, 0], "high": [side, side, side], "periodic": [True, True, True],
               "servo": {"stress": {"xx": "20 kPa", "yy": "20 kPa", "zz": "20 kPa"}, "max_strain_rate": "10 1/s"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": [side, side, side], "count": 200,
        "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "1.5 mm"}}}},
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [
        {"name": "compress", "limit": "1 s", "until": {"type": "all", "of": [
            {"type": "stress", "component": "zz", "value": "20 kPa", "within": 0.05}, {"type": "unbalanced-force", "below": 0.05}]}},
        {"name": "shear", "until": {"type": "time", "value": "20 ms"}, "limit": "1 s", "change": {
            "domain": {"servo": {"stress": {"xx": None, "yy": None}}, "shear_rate": {"xz": "5 1/s"}}}},
    ],
}, threads=2)
sim.run_stage()


@sim.probe("test", every_time=0.5e-3, units={"normal_stress": "Pa"})
def test():
    stress = sim.stress()
    return {"normal_stress": stress[2, 2], "stress_ratio": -stress[0, 2] / stress[2, 2]}


sim.run()
curve = sim.series("test")
print(f"stress ratio {curve['stress_ratio'][-10:].mean():.2f} after a shear strain of {5 * (curve['time'][-1] - curve['time'][0]):.2f}")
assert 0.1 < curve["stress_ratio"][-10:].mean() < 1
