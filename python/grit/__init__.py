"""grit in Python: simulations, and results of `grit run`, as numpy arrays.

    import grit
    sim = grit.Simulation("box.json", threads=2)
    sim.run(until=0.5)                                # s
    sim.bodies.position, sim.walls["lid"].force       # m, N
    run = grit.open("results/box")
    run.series["packing/coordination_number"]

Units are SI. Simulations need numpy and the compiled module; results need numpy and h5py. What is not used is not imported.
"""

import importlib

from .errors import DescriptionError, Error, FileError, NumericsError, PluginError, Problem, ResultsError, UnknownName

_HOMES = {
    **dict.fromkeys(("open", "Run", "Series", "Frames", "Frame", "Table", "Wall"), "results"),
    **dict.fromkeys(("Simulation", "Checkpoint"), "simulation"),
}

__all__ = ["DescriptionError", "Error", "FileError", "NumericsError", "PluginError", "Problem", "ResultsError", "UnknownName", *_HOMES]


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module 'grit' has no attribute {name!r}")
    return getattr(importlib.import_module("." + _HOMES[name], __name__), name)


def __dir__():
    return [*globals(), *_HOMES]
