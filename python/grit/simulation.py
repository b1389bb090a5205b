"""A simulation that Python drives. See docs/how-to/python.md."""

import inspect
import json
import math
import numbers
import sys
from collections.abc import Mapping

from . import arguments, compiled, progress as progress_display
from .errors import Error, UnknownName
from .engine import Engine
from .picture import Picture
from .recording import Recording, Samples
from .world import Bodies, Cell, Clumps, Contacts, Departures, Energies, Walls

_grit = compiled.load()
Checkpoint = _grit.Checkpoint

_STATES = ("rotation", "displacement", "energy")
_MOST_THREADS = 2**15


def _with_simulation(function):
    """The function as one that takes the simulation, also if it has no parameter without a default."""
    if not callable(function):
        raise TypeError(f"found {function!r}; allowed is a function, as @sim.every(steps=100) decorates it")
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
    plugin_path: a folder with plugins, or several, before those of GRIT_PLUGIN_PATH and those next to the library.
    keep: state that is kept although nothing in the description needs it: "rotation", "displacement", "energy".
    checkpoint: from which the simulation continues, as by resume(); the files that bodies came from may be gone.

    Raises DescriptionError with all problems, FileError, PluginError. Relative paths in a dict start in the working directory.
    """

    def __init__(self, description, threads=1, sets=(), plugin_path=(), *, keep=(), checkpoint=None):
        is_json = isinstance(description, Mapping)
        self._name = "description" if is_json else arguments.path("description", description, "the path of a file, or a dict")
        keep = [keep] if isinstance(keep, str) else arguments.several("keep", keep, f"a list of {', '.join(_STATES)}")
        for one in keep:
            if one not in _STATES:
                raise UnknownName("state", one, _STATES)
        self._core = _grit.Simulation(arguments.as_json(description) if is_json else self._name, is_json, arguments.whole("threads", threads, 1, _MOST_THREADS),
                                      arguments.assignments(sets), arguments.folders("plugin_path", plugin_path), keep, checkpoint is not None)
        self._core.own(self)
        self._observers, self._recordings, self._engines, self._display = [], {}, {}, None
        self._bodies, self._contacts, self._clumps = Bodies(self._core), Contacts(self._core), Clumps(self._core)
        if checkpoint is not None:
            self.resume(checkpoint)

    def __repr__(self):
        now = "done" if self.done else "failed" if self.failed else f"stage {self.stage!r}" if self.stage else "not begun"
        bodies = len(self.bodies)
        return f"<simulation of {self._name}: {self.time:.6g} s, step {self.step}, {now}, {bodies} {'body' if bodies == 1 else 'bodies'}>"

    # Running

    def run(self, steps=None, *, until=None, progress=None):
        """Runs to the end, or takes `steps` time steps, or runs until a simulated time [s], through the ends of stages.

        progress: True or False; by default progress is shown in a terminal and in a notebook, after half a second.
        Takes fewer steps if the last stage ends. Raises Error, for steps and times, if all stages have ended before: see `done`.
        Raises what a callback raises, and KeyboardInterrupt: these end the run between two steps, and it may go on.
        Raises NumericsError if a guard trips or a stage does not end within its limit. The simulation has then failed: what is there can be
        looked at, and run() raises the same error again. After a time step above the critical one, set another, and go on.
        """
        if steps is not None:
            if until is not None:
                raise TypeError("give one of steps and until")
            steps = arguments.whole("steps", steps, 0)
        elif until is not None:
            if isinstance(until, bool) or not isinstance(until, numbers.Real) or until != until:
                raise TypeError(f"until: found {arguments.shown(until)}; allowed is a simulated time in seconds")
            until = math.inf if until > sys.float_info.max else float(max(until, -sys.float_info.max))
            if until < self.time - self.dt:
                raise ValueError(f"until: found {until} s, but the simulation is at {self.time} s")
        self._run(steps, until, False, progress)

    def run_stage(self, *, progress=None):
        """Runs the present stage to its end. Raises as run() does, and Error if all stages have ended."""
        self._run(None, None, True, progress)

    def _run(self, steps, until, stage, progress):
        try:
            self._core.run(steps, until, stage, progress_display.is_seen() if progress is None else bool(progress))
        finally:
            if self._display is not None:
                self._display.close()
                self._display = None

    def check(self):
        """Evaluates the first instant: bodies, contacts, time step and memory. Raises DescriptionError for problems that only show there."""
        return self._core.check()

    def set(self, pointer, value):
        """Sets a value of the description from now on, as `change` of a stage does: of a material, interface, wall or engine, of the rates or
        servo of /domain, of /time_step or /guards. SI, or a text with a unit. Raises DescriptionError, also for what has no effect any more,
        such as the density of bodies that are there; nothing has changed then."""
        self._core.set(arguments.text("pointer", pointer, "/materials/sand/friction_angle"), arguments.as_json(value, pointer, "set"))

    def save(self, path=None):
        """The complete state, from which a simulation of the same description continues with identical results: as a Checkpoint, or in a file."""
        if path is None:
            return self._core.save()
        self._core.write(arguments.path("path", path))
        return None

    def resume(self, checkpoint):
        """Continues from a Checkpoint, or a file that save() wrote, of the same description, before the first step. Raises Error for another
        description; its guards may be others."""
        if not isinstance(checkpoint, Checkpoint):
            checkpoint = _grit.read_checkpoint(arguments.path("checkpoint", checkpoint, "a Checkpoint, or the path of a file that save() wrote"))
        self._core.resume(checkpoint)

    # Callbacks

    def every(self, *, time=None, steps=None):
        """Decorates a function that is called at the start of each stage and then at this interval of simulated time [s], or of steps.
        It takes the simulation, or nothing. What it raises ends the run."""
        return self._at_interval("time", time, "steps", steps)

    def _at_interval(self, time_name, time, steps_name, steps):
        if (time is None) == (steps is None):
            raise TypeError(f"give one of {time_name} and {steps_name}")
        if time is not None:
            interval, register = arguments.positive(time_name, time), self._core.every_time
        else:
            interval, register = arguments.whole(steps_name, steps, 1), self._core.every_steps
        return lambda function: self._observe(function, lambda: register(interval))

    def at_stage_end(self, function):
        """Decorates a function that is called at the end of each stage."""
        return self._observe(function, self._core.at_stage_end)

    def _observe(self, function, register):
        observer = _with_simulation(function)
        register()
        self._observers.append((function, observer))
        return function

    def remove(self, function):
        """Ends the calls of a function that every(), at_stage_end() or engine() has registered."""
        if engines := [name for name, engine in self._engines.items() if engine.function is function]:
            for name in engines:
                self._core.remove_engine(name)
                del self._engines[name]
            return
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
        units: {value: unit}. Python is slow: probes of the description are faster. Raises Error for the name of one of these."""
        recording = Recording(arguments.text("name", name, "heights"), units, _grit.is_unit)
        if name in self._core.probes():
            raise Error(f"the description has a probe {name!r}; choose another name")
        at_interval = self._at_interval("every_time", every_time, "every_steps", every_steps)

        def decorate(function):
            sample = _with_simulation(function)

            def record(simulation):
                recording.add(simulation.time, simulation.step, sample(simulation))
            if name in self._recordings:  # a cell of a notebook that is run again
                self.remove(self._recordings[name][1])
            at_interval(record)
            self._recordings[name] = recording, record
            return function
        return decorate

    def engine(self, name, *, stiffness=0.0, damping=0.0):
        """Decorates a function that returns the force on each body [N], in every step: an array n × 3, one vector for all, None for nothing, or a
        pair of forces and moments [N m]. It takes the simulation, or nothing.

        stiffness, damping: upper bounds over all bodies of the derivatives of the force with position [N/m] and with velocity [N s/m], over the
        mass: of these the time step must know. The same name again replaces the engine, remove(function) ends it.
        The function must give the same for the same instant, and not depend on the order of bodies. What it raises ends the simulation, as it is
        in the middle of a step; at Ctrl-C it is called again, and the run ends after the step. An engine is no part of the description: add it
        again before resume(). Raises Error for the name of an engine of the description. Slow: engines of the description are much faster.
        """
        name = arguments.text("name", name, "wind")
        rates = arguments.not_negative("stiffness", stiffness), arguments.not_negative("damping", damping)

        def decorate(function):
            engine = Engine(name, function, _with_simulation(function))
            before = self._engines.get(name)
            self._engines[name] = engine
            try:
                self._core.set_engine(name, *rates)
            except BaseException:
                del self._engines[name]
                if before is not None:
                    self._engines[name] = before
                raise
            return function
        return decorate

    def _acted(self, name, bodies):
        return self._engines[name].act(self, bodies)

    def series(self, name):
        """What the probe of this name has recorded since the simulation was opened: one that probe() added, or one of the description."""
        if name in self._recordings:
            return self._recordings[name][0]
        described = self._core.probes()
        if name not in described:
            raise UnknownName("probe", name, [*self._recordings, *described])
        return Samples(self._core, name)

    # State

    time = property(lambda self: self._core.time, doc="simulated, since the start of the run [s]")
    step = property(lambda self: self._core.step, doc="since the start of the run")
    dt = property(lambda self: self._core.dt, doc="time step [s]")
    stage = property(lambda self: self._core.stage, doc="name of the present stage; empty before the first step")
    done = property(lambda self: self._core.done, doc="whether all stages have ended")
    failed = property(lambda self: self._core.failed, doc="whether an error ended the simulation, which run() raises again")
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
        return Picture(self._core.picture(arguments.text("view", view, "xz"), arguments.text("color", color, "speed")))

    @property
    def energies(self):
        """The energy balance [J]. Needs a probe `energy`, or keep=["energy"]."""
        now = self._core.energies()
        if now is None:
            raise Error("the energy balance is not kept; open the simulation with keep=[\"energy\"]")
        return Energies(**now)

    def stress(self, low=None, high=None):
        """Mean stress [Pa] in the specimen, or in a box, compression positive (Love-Weber), 3 × 3."""
        return self._core.stress(arguments.box(low, high))

    def void_ratio(self, low=None, high=None):
        """Volume of voids over volume of solids in the specimen, or in a box."""
        return self._core.void_ratio(arguments.box(low, high))

    @property
    def description(self):
        """All values of the description at the start, in SI, as a dict."""
        return json.loads(self._core.description())
