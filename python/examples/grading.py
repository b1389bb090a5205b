"""A packing with a sieve curve: its mass is distributed over sizes as given."""

import numpy

import grit

sieves, passing = numpy.array([0.5e-3, 0.8e-3, 1.2e-3, 2e-3]), numpy.array([0, 0.3, 0.8, 1])  # m; fraction by mass
side = 12e-3  # m
sim = grit.Simulation({
    "title": "packing with a sieve curve",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "5 MPa", "friction_angle": "30 deg"}},
    "domain": {"low": [0, 0, 0], "high": [side, side, side], "periodic": [True, True, True],
               "servo": {"stress": {"xx": "10 kPa", "yy": "10 kPa", "zz": "10 kPa"}, "max_strain_rate": "10 1/s"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": [side, side, side], "count": 800,
        "sizes": {"type": "sieve", "diameters": sieves, "passing": passing}}}},
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [{"name": "compress", "limit": "1 s", "until": {"type": "stress", "component": "zz", "value": "10 kPa", "within": 0.05}}],
})
sim.run()
diameters, mass = 2 * sim.bodies.radius, sim.bodies.mass
found = numpy.array([mass[diameters <= sieve].sum() for sieve in sieves]) / mass.sum()
print("passing:", ", ".join(f"{1e3 * sieve:.1f} mm {100 * part:.0f} %" for sieve, part in zip(sieves, found)), f"; void ratio {sim.void_ratio():.2f}")
assert abs(found - passing).max() < 0.05 and 0.3 < sim.void_ratio() < 1
