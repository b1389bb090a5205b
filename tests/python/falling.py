"""Grains that fall, for the tests of simulations in Python. The first argument of a test is GRIT: the module is that of its build folder."""

import json
import pathlib
import sys
import tempfile
import unittest

GRIT = pathlib.Path(sys.argv.pop(1)).absolute()
sys.path.insert(0, str(GRIT.parent.parent / "python"))

import numpy

import grit

MM = 1e-3


def scene(steps=(300, 200), **changes):
    """A cloud of grains that falls on a floor, below a lid that a servo moves."""
    grains = [{"position": [3 * MM * (i % 4) + 0.1 * MM * (i // 16), 3 * MM * (i // 4 % 4), 1.01 * MM + 2.01 * MM * (i // 16)], "radius": "1 mm",
               "velocity": [0, 0, -0.05]} for i in range(48)]
    return {
        "title": "grains that fall",
        "contacts": {"type": "linear-rolling"},
        "materials": {"sand": {"contact_modulus": "1 MPa"}},
        "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": grains}}},
        "walls": {
            "floor": {"type": "plane", "material": "sand"},
            "lid": {"type": "rectangle", "corner": [-5 * MM, -5 * MM, 12 * MM], "edge_a": [20 * MM, 0, 0], "edge_b": [0, 20 * MM, 0], "material": "sand",
                    "motion": {"velocity": [0, 0, "-20 mm/s"]}},
        },
        "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.5}},
        "stages": [{"name": name, "until": {"type": "steps", "value": count}, "limit": "1e6 s"} for name, count in zip(("fall", "rest"), steps)],
        "output": {"frames": {"every_time": "1 s"}},
        **changes,
    }


def long_scene():
    """It rests for ever."""
    long = scene((10**9, 1))
    del long["walls"]["lid"]["motion"]
    return long


def state(sim):
    """All motion, in the order of ids, as bytes."""
    order = numpy.argsort(sim.bodies.id)
    return b"".join(numpy.ascontiguousarray(rows[order]).tobytes() for rows in (sim.bodies.position, sim.bodies.velocity, sim.bodies.spin))


class InAFolder(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="grit-python-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def write(self, description, name="box.json"):
        path = self.folder / name
        path.write_text(json.dumps(description, indent=1))
        return path


_whole = []


def state_of_a_whole_run():
    if not _whole:
        sim = grit.Simulation(scene())
        sim.run()
        _whole.append(state(sim))
    return _whole[0]
