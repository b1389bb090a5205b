"""A simulation that Python drives. See docs/how-to/python.md."""

import inspect
import json
import math
import numbers
import operator
import os
from collections.abc import Mapping

import numpy

from . import compiled, progress as progress_display
from .errors import DescriptionError, Error, Problem, UnknownName
from .picture import Picture
from .recording import Recording
from .world import Bodies, Cell, Clumps, Contacts, Departures, Energies, Walls

_grit = compiled.load()
Checkpoint = _grit.Checkpoint

_STATES = ("rotation", "displacement", "energy")


def _plain(value, pointer="", source="description"):
    """A value as JSON has it; numbers, arrays and paths of Python and numpy are converted."""
    if isinstance(value, Mapping):
        return {str(key): _plain(one, f"{pointer}/{str(key).replace('~', '~0').replace('/', '~1')}", source) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one, f"{pointer}/{i}", source) for i, one in enumerate(value)]
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        return _plain(value.tolist(), pointer, source)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if value is None or isinstance(value, (bool, int, str)) or (isinstance(value, float) and math.isfinite(value)):
        return value
    message = f"found {value!r} of type {type(value).__name__}; allowed are dicts, lists, finite numbers, texts, True, False and None"
    raise DescriptionError(f"{source}: {pointer or '/'}: {message}", [Problem(source, None, pointer, message)])


def _json(value, pointer="", source="description"):
    return json.dumps(_plain(value, pointer, source))


def _assignments(sets):
    if isinstance(sets, Mapping):
        return [f"{pointer}={_json(value, pointer, '--set')}" for pointer, value in sets.items()]
    if isinstance(sets, str):
        raise TypeError("sets: found a text; allowed is a dict {\"/pointer\": value} or a list of \"/pointer=value\"")
    return list(sets)


def _paths(paths):
    return [os.fspath(paths)] if isinstance(paths, (str, os.PathLike)) else [os.fspath(path) for path in paths]


def _positive(name, value, kind=numbers.Real):
    if isinstance(value, bool) or not isinstance(value, kind):
        raise TypeError(f"{name}: found {value!r}; allowed is {'a number' if kind is numbers.Real else 'a whole number'} above 0")
    if not 0 < value < math.inf:
        raise ValueError(f"{name}: found {value!r}; allowed is a {'finite' if kind is numbers.Real else 'whole'} number above 0")
    return value


def _box(low, high):
    if (low is None) != (high is None):
        raise TypeError("give both low and high, or none for the specimen")
    return None if low is None else ([float(x) for x in low], [float(x) for x in high])


def _with_simulation(function):
    """The function as one that takes the simulation, also if it has no parameter without a default."""
    if not callable(function):
        raise TypeError(f"found {function!r}; allowed is a function")
    try:
        required = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD
        takes = any(one.kind in required and one.default is one.empty for one in inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        takes = True
    return function if takes else lambda simulation: function()


class Simulation:
    """A simulation of a description: the path of a file, or a dict.

    threads: results are identical for any number.
    sets: changes of the description, {"/pointer": value} or ["/pointer=value"]; texts may have units, "200 kPa".
    plugin_path: folders with plugins, before those of GRIT_PLUGIN_PATH and those next to the library.
    keep: state that is kept although nothing in the description needs it: "rotation", "displacement", "energy".
    checkpoint: a Checkpoint from which the simulation continues; the files that bodies came from may be gone.

    Raises DescriptionError with all problems, FileError, PluginError. Relative paths in a dict start in the working directory.
    """

    def __init__(self, description, threads=1, sets=(), plugin_path=(), *, keep=(), checkpoint=None):
        is_json = isinstance(description, Mapping)
        if not is_json and not isinstance(description, (str, os.PathLike)):
            raise TypeError(f"description: found {type(description).__name__}; allowed is the path of a file, or a dict")
        keep = [keep] if isinstance(keep, str) else list(keep)
        for one in keep:
            if one not in _STATES:
                raise UnknownName("state", one, _STATES)
        self._name = "description" if is_json else os.fspath(description)
        self._core = _grit.Simulation(_json(description) if is_json else self._name, is_json, _positive("threads", threads, numbers.Integral),
                                      _assignments(sets), _paths(plugin_path), keep, checkpoint)
        self._observers, self._recordings, self._display = [], {}, None
        self._bodies, self._contacts, self._clumps = Bodies(self._core), Contacts(self._core), Clumps(self._core)

    def __repr__(self):
        now = "done" if self.done else f"stage {self.stage!r}" if self.stage else "not begun"
        bodies = len(self.bodies)
        return f"<simulation of {self._name}: {self.time:.6g} s, step {self.step}, {now}, {bodies} {'body' if bodies == 1 else 'bodies'}>"

    # Running

    def run(self, steps=None, *, until=None, progress=None):
        """Runs to the end, or takes `steps` time steps, or runs until a simulated time [s], through the ends of stages.

        progress: True or False; by default progress is shown in a terminal and in a notebook, after half a second.
        Raises NumericsError if a guard trips or a stage does not end within its limit; what a callback raises; KeyboardInterrupt.
        All end the run between two steps, and it may go on.
        """
        if steps is not None:
            if until is not None:
                raise TypeError("give one of steps and until")
            if not isinstance(steps, int):
                steps = operator.index(steps)
            if steps < 0:
                raise ValueError(f"steps: found {steps}; allowed is a whole number from 0")
        elif until is not None:
            if not isinstance(until, numbers.Real) or math.isnan(until):
                raise TypeError(f"until: found {until!r}; allowed is a simulated time in seconds")
            if until < self.time - self.dt:
                raise ValueError(f"until: found {until} s, but the simulation is at {self.time} s")
        self._run(steps, until, False, progress)

    def run_stage(self, *, progress=None):
        """Runs the present stage to its end."""
        self._run(None, None, True, progress)

    def _run(self, steps, until, stage, progress):
        try:
            self._core.run(self, steps, until, stage, progress_display.is_seen() if progress is None else bool(progress))
        finally:
            if self._display is not None:
                self._display.close()
                self._display = None

    def check(self):
        """Evaluates the first instant: bodies, contacts, time step and memory. Raises DescriptionError for problems that only show there."""
        return self._core.check()

    def set(self, pointer, value):
        """Sets a value of the description from now on, as `change` of a stage does: of a material, interface, wall or engine, of the rates or
        servo of /domain, of /time_step or /guards. SI, or a text with a unit. Raises DescriptionError."""
        self._core.set(pointer, _json(value, pointer, "set"))

    def save(self, path=None):
        """The complete state, from which a simulation of the same description continues with identical results: as a Checkpoint, or in a file."""
        if path is None:
            return self._core.save()
        self._core.write(os.fspath(path))

    def resume(self, checkpoint):
        """Continues from a Checkpoint, or a file that save() wrote, of the same description, before the first step."""
        self._core.resume(checkpoint if isinstance(checkpoint, Checkpoint) else self._core.read(os.fspath(checkpoint)))

    # Callbacks

    def every(self, *, time=None, steps=None):
        """Decorates a function that is called at the start of each stage and then at this interval of simulated time [s], or of steps.
        It takes the simulation, or nothing. What it raises ends the run."""
        if (time is None) == (steps is None):
            raise TypeError("give one of time and steps")
        if time is not None:
            _positive("time", time)
        else:
            _positive("steps", steps, numbers.Integral)
        return lambda function: self._observe(function, lambda: self._core.every_steps(int(steps)) if time is None else self._core.every_time(float(time)))

    def at_stage_end(self, function):
        """Decorates a function that is called at the end of each stage."""
        return self._observe(function, self._core.at_stage_end)

    def _observe(self, function, register):
        observer = _with_simulation(function)
        register()
        self._observers.append((function, observer))
        return function

    def remove(self, function):
        """Ends the calls of a function that every() or at_stage_end() has registered."""
        if not any(known is function for known, _ in self._observers):
            raise Error(f"{function!r} is no callback of this simulation")
        self._observers = [(None, None) if known is function else (known, observer) for known, observer in self._observers]

    def _observed(self, number):
        observer = self._observers[number][1]
        if observer is not None:
            observer(self)

    def _progressed(self, *now):
        if self._display is None:
            self._display = progress_display.make()
        self._display.show(*now)

    def probe(self, name, *, every_time=None, every_steps=None, units=None):
        """Decorates a function whose result, a dict of numbers, is recorded at an interval: series(name) has the values as arrays.
        units: {value: unit}. Python is slow: probes of the description are faster and in the results of `grit run`."""
        recording = Recording(name, units)

        def decorate(function):
            sample = _with_simulation(function)

            def record(simulation):
                recording.add(simulation.time, simulation.step, sample(simulation))
            if name in self._recordings:  # a cell of a notebook that is run again
                self.remove(self._recordings[name][1])
            self.every(time=every_time, steps=every_steps)(record)
            self._recordings[name] = recording, record
            return function
        return decorate

    def series(self, name):
        """What the probe of this name has recorded."""
        if name not in self._recordings:
            raise UnknownName("probe", name, list(self._recordings))
        return self._recordings[name][0]

    # State

    time = property(lambda self: self._core.time, doc="simulated, since the start of the run [s]")
    step = property(lambda self: self._core.step, doc="since the start of the run")
    dt = property(lambda self: self._core.dt, doc="time step [s]")
    stage = property(lambda self: self._core.stage, doc="name of the present stage; empty before the first step")
    done = property(lambda self: self._core.done, doc="whether all stages have ended")
    bodies = property(lambda self: self._bodies, doc="arrays with one row per body")
    contacts = property(lambda self: self._contacts, doc="arrays with one row per contact")
    clumps = property(lambda self: self._clumps, doc="arrays with one row per clump")
    departures = property(lambda self: Departures(self._core), doc="bodies that left the domain")
    walls = property(lambda self: Walls(self._core), doc="walls by name")
    cell = property(lambda self: Cell(**self._core.cell()), doc="the box of the domain")
    specimen = property(lambda self: self._core.specimen(), doc="low and high corner of the specimen [m], as /specimen of the description defines it")
    mean_diameter = property(lambda self: self._core.mean_diameter, doc="by number; for clumps, of the enclosing sphere [m]")
    solid_density = property(lambda self: self._core.solid_density, doc="mass over volume of all bodies [kg/m³]")
    kinetic_energy = property(lambda self: self._core.equilibrium()[0], doc="of translation and rotation [J]")
    unbalanced_force = property(lambda self: self._core.equilibrium()[1], doc="mean net force on a body over the mean contact force")
    mean_contact_force = property(lambda self: self._core.equilibrium()[2], doc="mean normal force of all contacts [N]")

    def show(self, view="xz", color="speed"):
        """The grains as a picture, which notebooks show. view: "xz", "xy", "yz"; color: "speed", "radius", "rotation", "displacement".
        Unbounded walls are not drawn."""
        return Picture(self._core.picture(view, color))

    @property
    def energies(self):
        """The energy balance [J]. Needs a probe `energy`, or keep=["energy"]."""
        now = self._core.energies()
        if now is None:
            raise Error("the energy balance is not kept; open the simulation with keep=[\"energy\"]")
        return Energies(**now)

    def stress(self, low=None, high=None):
        """Mean stress [Pa] in the specimen, or in a box, compression positive (Love-Weber), 3 × 3."""
        return self._core.stress(_box(low, high))

    def void_ratio(self, low=None, high=None):
        """Volume of voids over volume of solids in the specimen, or in a box."""
        return self._core.void_ratio(_box(low, high))

    @property
    def description(self):
        """All values of the description at the start, in SI, as a dict."""
        return json.loads(self._core.description())
