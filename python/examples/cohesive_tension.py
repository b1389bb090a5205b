"""Uniaxial tension of a cohesive block: a cubic array of glued spheres breaks at the sum of the bonds of one layer."""

import math

import grit

n, radius, strength = 5, 1e-3, 50e3  # spheres along each edge, m, Pa
spacing = 1.9999 * radius  # bonds form where spheres touch


def layer(z):
    return {"type": "sphere", "material": "rock", "source": {"type": "list", "bodies": [
        {"position": [spacing * x, spacing * y, spacing * k], "radius": radius} for x in range(n) for y in range(n) for k in z]}}


sim = grit.Simulation({
    "title": "uniaxial tension of a cohesive block",
    "contacts": {"type": "linear-cohesive"},
    "materials": {"rock": {"contact_modulus": "50 MPa", "friction_angle": "30 deg", "tensile_strength": strength}},
    "bodies": {"low": layer([0]), "middle": layer(range(1, n - 1)), "high": layer([n - 1])},
    "engines": {
        "damping": {"type": "local-damping", "coefficient": 0.2, "groups": ["middle"]},
        "fixed": {"type": "prescribed-motion", "groups": ["low"]},
        "pulled": {"type": "prescribed-motion", "groups": ["high"], "velocity": [0, 0, "2 mm/s"]},
    },
    "stages": [{"name": "pull", "until": {"type": "time", "value": "12 ms"}, "limit": "1 s"}],
})


@sim.probe("tension", every_steps=10, units={"force": "N", "bonds": "1"})
def tension():
    """Of the contacts between the pulled layer and the next."""
    groups, contacts = sim.bodies.group, sim.contacts
    across = (groups[contacts.a] == "high") != (groups[contacts.b] == "high")
    return {"force": -contacts.normal_force[across].sum(), "bonds": len(contacts)}


sim.run()
peak, bonds = sim.series("tension")["force"].max(), n * n * strength * math.pi * radius**2
print(f"peak {peak:.3f} N, of {n * n} bonds {bonds:.3f} N; {sim.series('tension')['force'][-1]:.3f} N at the end")
assert abs(peak - bonds) < 0.02 * bonds and abs(sim.series("tension")["force"][-1]) < 0.1 * bonds
