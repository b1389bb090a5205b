"""A platen presses grains in a box, is lifted, and presses again. The script decides when to turn back."""

import grit

side = 8e-3  # m
sim = grit.Simulation({
    "title": "oedometric test",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "10 MPa", "friction_angle": "27 deg"}, "wall": {"friction_angle": 0}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": [side, side, side], "count": 150,
        "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "1.5 mm"}}}},
    "walls": {
        "box": {"type": "box", "low": [0, 0, 0], "high": [side, side, 2 * side], "open": ["z_high"], "material": "wall"},
        "platen": {"type": "rectangle", "corner": [0, side, 1.1 * side], "edge_a": [side, 0, 0], "edge_b": [0, -side, 0], "two_sided": False,
                   "material": "wall", "motion": {"servo": {"pressure": "5 kPa", "max_velocity": "0.3 m/s"}}},
    },
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [
        {"name": "settle", "limit": "1 s", "until": {"type": "all", "of": [
            {"type": "pressure", "wall": "platen", "value": "5 kPa", "within": 0.05}, {"type": "unbalanced-force", "below": 0.05}]}},
        {"name": "press", "until": {"type": "time", "value": "1 s"}, "limit": "2 s"},
    ],
})
sim.run_stage()
platen, rows = sim.walls["platen"], []


@sim.every(steps=20)
def record():
    rows.append((platen.stage_position[2], platen.pressure))


def move(velocity, until):
    """Moves the platen until a condition holds; run() raises grit.Error if the last stage ends before."""
    sim.set("/walls/platen/motion", {"servo": None, "velocity": [0, 0, velocity]})
    while not until():
        sim.run(50)


move(-0.05, lambda: platen.pressure > 50e3)
move(+0.05, lambda: platen.pressure < 10e3)
move(-0.05, lambda: platen.pressure > 80e3)
print(f"{len(rows)} points, {-platen.stage_position[2] / side:.1%} compression at {platen.pressure:.3g} Pa")
assert platen.pressure > 80e3 and max(pressure for _, pressure in rows) > 50e3
