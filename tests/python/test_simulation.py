#!/usr/bin/env python3
"""Simulations driven from Python.

usage: test_simulation.py GRIT     the module is that of GRIT's build folder
"""

import copy
import gc
import io
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock
import weakref

GRIT = pathlib.Path(sys.argv.pop(1)).absolute()
sys.path.insert(0, str(GRIT.parent.parent / "python"))

import numpy

import grit
from grit import compiled, progress, simulation

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


class SameBits(InAFolder):
    @classmethod
    def setUpClass(cls):
        sim = grit.Simulation(scene())
        sim.run()
        cls.whole = state(sim)

    def test_as_the_command_line(self):
        path = self.write(scene())
        subprocess.run([GRIT, "run", path, "--out", self.folder / "out", "--threads", "1", "--quiet", "--no-report"], check=True, stdout=subprocess.DEVNULL)
        run = grit.open(self.folder / "out")
        frame = run.frames[-1]
        self.assertGreater(run.show().svg.count("<circle"), 5)
        written = b"".join(frame.bodies[name].tobytes() for name in ("position", "velocity", "spin"))
        sim = grit.Simulation(path)
        sim.run()
        self.assertEqual((sim.time, sim.step, sim.done), (frame.time, frame.step, True))
        self.assertEqual(state(sim), written)
        self.assertEqual(sim.walls["floor"].force.tolist(), frame.walls["floor"].force.tolist())
        self.assertEqual(sorted(zip(sim.contacts.body_a, sim.contacts.body_b)), sorted(zip(frame.contacts["body_a"], frame.contacts["body_b"])))

    def test_for_any_number_of_threads(self):
        sim = grit.Simulation(scene(), threads=2)
        sim.run()
        self.assertEqual(state(sim), self.whole)

    def test_step_by_step(self):
        sim = grit.Simulation(scene())
        while not sim.done:
            sim.run(1)
        self.assertEqual(sim.step, 500)
        self.assertEqual(state(sim), self.whole)

    def test_with_arrays_that_are_kept_at_each_instant(self):
        sim, kept = grit.Simulation(scene()), []
        names = ("id", "position", "velocity", "spin", "material", "force", "moment")

        @sim.every(steps=3)
        def keep():
            kept.append([getattr(sim.bodies, name) for name in names] + [sim.contacts.force])
            copies.append([array.copy() for array in kept[-1]])
        copies = []
        sim.run()
        self.assertEqual(state(sim), self.whole)
        self.assertGreater(len(kept), 150)
        for arrays, then in zip(kept, copies):
            for array, copied in zip(arrays, then):
                self.assertEqual(array.tobytes(), copied.tobytes())

    def test_with_the_state_that_is_kept(self):
        sim = grit.Simulation(scene(), keep=["rotation", "displacement", "energy"])
        sim.run()
        self.assertEqual(state(sim), self.whole)


class ArraysLast(unittest.TestCase):
    def test_nothing_is_copied_at_one_instant(self):
        sim = grit.Simulation(scene())
        position, again, radius = sim.bodies.position, sim.bodies.position, sim.bodies.radius
        self.assertEqual(position.ctypes.data, again.ctypes.data)
        self.assertEqual(position.ctypes.data + 24, radius.ctypes.data, "the fourth number of a row")
        self.assertFalse(position.flags.owndata)

    def test_they_show_the_instant_at_which_they_were_taken(self):
        sim = grit.Simulation(scene())
        before = sim.bodies.position
        height, copied, place = before[:, 2], before.copy(), before.ctypes.data
        sim.run(20)
        self.assertEqual(before.ctypes.data, place)
        self.assertTrue((before == copied).all())
        self.assertFalse((sim.bodies.position == copied).all())
        del before
        sim.run(20)
        self.assertTrue((height == copied[:, 2]).all(), "a slice alone")

    def test_they_outlive_the_simulation(self):
        sim = grit.Simulation(scene())
        sim.run(150)
        arrays = [sim.bodies.position, sim.bodies.force[3:], sim.contacts.normal, sim.contacts.normal_force, sim.bodies.id]
        copies = [array.copy() for array in arrays]
        self.assertGreater(len(copies[2]), 10)
        died = weakref.ref(sim)
        del sim
        gc.collect()
        self.assertIsNone(died())
        others = [grit.Simulation(scene()) for _ in range(3)]  # would take the memory
        for other in others:
            other.run(10)
        for array, copied in zip(arrays, copies):
            self.assertEqual(array.tobytes(), copied.tobytes())

    def test_they_last_when_a_value_is_set(self):
        sim = grit.Simulation(scene())
        sim.run(10)
        velocity = sim.bodies.velocity
        copied = velocity.copy()
        sim.set("/engines/gravity/acceleration", [0, 0, "-1 m/s^2"])
        sim.check()
        sim.run(5)
        self.assertTrue((velocity == copied).all())

    def test_they_are_read_only(self):
        sim = grit.Simulation(scene())
        for array in (sim.bodies.position, sim.bodies.id, sim.contacts.force):
            if len(array):
                with self.assertRaises(ValueError):
                    array[0] = 1
                with self.assertRaises(ValueError):
                    array.flags.writeable = True

    def test_simulations_that_refer_to_themselves_are_freed(self):
        sim = grit.Simulation(scene())

        @sim.every(steps=1)
        def look():
            return sim.time
        sim.run(2)
        died = weakref.ref(sim)
        del sim, look
        gc.collect()
        self.assertIsNone(died())


class Running(unittest.TestCase):
    def test_steps_times_and_stages(self):
        sim = grit.Simulation(scene())
        self.assertEqual((sim.time, sim.step, sim.done), (0, 0, False))
        sim.run(steps=120)
        self.assertEqual((sim.step, sim.stage), (120, "fall"))
        until = sim.time + 10.3 * sim.dt
        sim.run(until=until)
        self.assertLess(abs(sim.time - until), 0.5 * sim.dt)
        sim.run(until=until)
        self.assertLess(abs(sim.time - until), 0.5 * sim.dt)
        sim.run_stage()
        self.assertEqual((sim.step, sim.stage), (300, "rest"))
        sim.run(0)
        self.assertEqual(sim.step, 300)
        sim.run(10**9)
        self.assertEqual((sim.step, sim.done), (500, True))
        sim.run()
        self.assertEqual(sim.step, 500)
        self.assertIn("done, 48 bodies", repr(sim))

    def test_what_it_is_not_given(self):
        sim = grit.Simulation(scene())
        sim.run(10)
        for arguments, error, said in (({"steps": 1, "until": 2}, TypeError, "one of steps and until"), ({"steps": -1}, ValueError, "found -1; allowed"),
                                       ({"steps": 1.5}, TypeError, "float"), ({"until": "1 s"}, TypeError, "simulated time in seconds"),
                                       ({"until": float("nan")}, TypeError, "found nan"), ({"until": -1}, ValueError, "but the simulation is at")):
            with self.assertRaisesRegex(error, said):
                sim.run(**arguments)
        self.assertEqual(sim.step, 10)

    def test_forecast(self):
        sim = grit.Simulation(scene())
        forecast = sim.check()
        self.assertEqual((forecast.bodies, forecast.time_step, sim.step), (48, sim.dt, 0))
        self.assertGreater(forecast.critical_time_step, forecast.time_step)
        self.assertIn("48 bodies", repr(forecast))

    def test_values_that_are_set(self):
        sim = grit.Simulation(scene(), sets={"/walls/lid/motion/velocity": [0, 0, "0 m/s"], "/engines/gravity/acceleration": [0, 0, -1]})
        self.assertEqual(sim.description["engines"]["gravity"]["acceleration"], [0, 0, -1])
        sim.run(5)
        self.assertEqual(sim.walls["lid"].position.tolist(), [0, 0, 0])
        sim.set("/walls/lid/motion/velocity", numpy.array([0, 0, -0.01]))
        sim.run(1)
        self.assertEqual(sim.walls["lid"].velocity[2], -0.01)
        sim.set("/materials/sand/contact_modulus", "2 MPa")
        for pointer, value, said in (("/materials/sand/friction_angle", 7, "/materials/sand/friction_angle"), ("/materials/sand/contact_modulus", "2 mm", "MPa"),
                                     ("/seed", 7, "found a change of \"seed\""), ("seed", 7, "allowed is a JSON pointer"),
                                     ("/engines/gravity/acceleration", [0, 0, float("nan")], "/engines/gravity/acceleration/2: found nan"),
                                     ("/engines/gravity/acceleration", {1, 2}, "of type set; allowed are dicts")):
            with self.assertRaisesRegex(grit.DescriptionError, said) as raised:
                sim.set(pointer, value)
            self.assertEqual(len(raised.exception.problems), 1)
        self.assertEqual(grit.Simulation(scene(), sets=["/title=other"]).description["title"], "other")
        sim.run()
        with self.assertRaisesRegex(grit.Error, "the simulation is done"):
            sim.set("/materials/sand/contact_modulus", 1e6)


class Callbacks(unittest.TestCase):
    def test_when_they_are_called(self):
        sim = grit.Simulation(scene((20, 10)))
        by_steps, by_time, ends = [], [], []

        @sim.every(steps=8)
        def count(simulation):
            self.assertIs(simulation, sim)
            by_steps.append(simulation.step)
        sim.every(time=5 * sim.check().time_step)(lambda: by_time.append(sim.step))

        @sim.at_stage_end
        def end():
            ends.append((sim.stage, sim.step))
        sim.run()
        self.assertEqual(by_steps, [0, 8, 16, 20, 28])
        self.assertEqual(by_time, [0, 5, 10, 15, 20, 20, 25, 30])
        self.assertEqual(ends, [("fall", 20), ("rest", 30)])

    def test_they_may_be_removed(self):
        sim, calls = grit.Simulation(scene()), []

        @sim.every(steps=1)
        def count():
            calls.append(sim.step)
        sim.run(2)
        sim.remove(count)
        sim.run(2)
        self.assertEqual(calls, [0, 1, 2])
        with self.assertRaisesRegex(grit.Error, "is no callback of this simulation"):
            sim.remove(count)

    def test_their_exceptions_arrive_unchanged_and_the_run_goes_on(self):
        sim, calls, thrown = grit.Simulation(scene()), [], LookupError("mine")

        @sim.every(steps=50)
        def fail():
            calls.append(sim.step)
            if sim.step == 100:
                raise thrown
        with self.assertRaises(LookupError) as raised:
            sim.run()
        self.assertIs(raised.exception, thrown)
        self.assertEqual(sim.step, 100)
        sim.run()
        self.assertEqual(calls, [0, 50, 100, 150, 200, 250, 300, 300, 350, 400, 450, 500], "twice where a stage ends and the next begins")
        self.assertEqual(state(sim), state_of_a_whole_run())

    def test_an_exception_at_the_end_of_a_stage_is_raised_once(self):
        sim, ends = grit.Simulation(scene()), []

        @sim.at_stage_end
        def fail():
            ends.append(sim.stage)
            raise RuntimeError("stop")
        for stage in ("fall", "rest"):
            with self.assertRaisesRegex(RuntimeError, "stop"):
                sim.run()
            self.assertEqual(sim.stage, stage)
        sim.run()
        self.assertEqual((ends, sim.done), (["fall", "rest"], True))

    def test_they_may_set_values(self):
        sim = grit.Simulation(scene())

        @sim.every(steps=100)
        def lift():
            sim.set("/walls/lid/motion/velocity", [0, 0, 1e-4 * sim.step])
        sim.run(251)
        self.assertEqual(sim.walls["lid"].velocity[2], 1e-4 * 200)

    def test_what_they_may_not_do(self):
        sim = grit.Simulation(scene())
        for act, said in ((lambda: sim.run(1), r"run\(\) cannot be called in a callback"), (sim.save, r"save\(\) cannot be called"), (sim.check, r"check\(\) cannot"),
                          (lambda: sim.every(steps=1)(print), r"every\(\) cannot be called in a callback")):
            once = sim.every(steps=1)(act)
            with self.assertRaisesRegex(grit.Error, said):
                sim.run(2)
            sim.remove(once)
        for arguments in ({}, {"time": 1, "steps": 1}, {"steps": 1.5}, {"time": "1 s"}, {"time": True}):
            with self.assertRaises(TypeError):
                sim.every(**arguments)
        for arguments in ({"time": 0}, {"steps": -1}, {"time": float("inf")}):
            with self.assertRaisesRegex(ValueError, "allowed is a"):
                sim.every(**arguments)
        with self.assertRaisesRegex(TypeError, "allowed is a function"):
            sim.at_stage_end(7)

    def test_probes(self):
        sim = grit.Simulation(scene((20, 10)))

        @sim.probe("height", every_steps=10, units={"mean": "m"})
        def height(simulation):
            return {"mean": simulation.bodies.position[:, 2].mean(), "count": len(simulation.bodies)}
        sim.run()
        series = sim.series("height")
        self.assertEqual(list(series), ["time", "step", "mean", "count"])
        self.assertEqual(series["step"].tolist(), [0, 10, 20, 20, 30])
        self.assertEqual(series["time"][-1], sim.time)
        self.assertEqual(series["mean"][-1], sim.bodies.position[:, 2].mean())
        self.assertEqual([series.units(name) for name in series], ["s", "1", "m", ""])
        with self.assertRaisesRegex(KeyError, "there is no value 'mea'; did you mean 'mean'"):
            series["mea"]
        with self.assertRaisesRegex(KeyError, "there is no probe 'heigth'; did you mean 'height'"):
            sim.series("heigth")
        try:
            import pandas
        except ImportError:
            return
        self.assertEqual(series.to_pandas().loc[sim.time, "count"], 48)
        self.assertIsInstance(series.to_pandas(), pandas.DataFrame)

    def test_what_a_probe_may_not_return(self):
        for value, said in ((3.0, "returned float; allowed is a dict"), ({"force": [1, 2]}, "a value that is no number"), ({"time": 1}, "which every sample has")):
            sim = grit.Simulation(scene())
            sim.probe("mine", every_steps=1)(lambda: value)
            with self.assertRaisesRegex(grit.Error, "probe 'mine'.*" + said):
                sim.run(1)
        sim = grit.Simulation(scene())
        sim.probe("mine", every_steps=1)(lambda: {f"value_{sim.step}": 1})
        with self.assertRaisesRegex(grit.Error, r"returned \['value_1'\]; allowed are the names of its first sample: \['value_0'\]"):
            sim.run(2)

    def test_a_probe_that_is_defined_again_replaces_the_first(self):
        sim = grit.Simulation(scene())
        for factor in (1, 2):
            sim.probe("mine", every_steps=1)(lambda factor=factor: {"value": factor})
        sim.run(1)
        self.assertEqual(sim.series("mine")["value"].tolist(), [2, 2])


class Interrupts(unittest.TestCase):
    def test_in_a_callback(self):
        sim = grit.Simulation(long_scene())

        @sim.every(steps=10)
        def interrupt():
            if sim.step == 30:
                os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            sim.run()
        self.assertEqual(sim.step, 30)
        sim.run(5)
        self.assertEqual(sim.step, 35)

    def test_between_steps_while_other_threads_run(self):
        sim, begun = grit.Simulation(long_scene()), threading.Event()

        @sim.every(steps=10**8)
        def begin():
            begun.set()

        def interrupt():
            begun.wait()
            os.kill(os.getpid(), signal.SIGINT)
        other = threading.Thread(target=interrupt)
        other.start()
        with self.assertRaises(KeyboardInterrupt):
            sim.run(progress=False)
        other.join()
        reached = sim.step
        self.assertGreater(len(sim.contacts) + 1, 0)
        sim.run(5)
        self.assertEqual(sim.step, reached + 5)


    def test_while_an_error_is_raised(self):
        heavy = scene()
        heavy["stages"][1]["change"] = {"engines": {"gravity": {"acceleration": [0, 0, -1e7]}}}
        sim = grit.Simulation(heavy)

        def interrupted(*_):
            raise KeyboardInterrupt
        with unittest.mock.patch("grit.errors.NumericsError", interrupted):
            with self.assertRaises(KeyboardInterrupt):
                sim.run()


class Threads(unittest.TestCase):
    def test_two_simulations_at_once(self):
        both, found = threading.Barrier(2, timeout=60), {}

        def drive(name):
            sim = grit.Simulation(scene())
            sim.every(steps=100)(lambda: both.wait())  # passes if both run
            sim.run()
            found[name] = state(sim)
        threads = [threading.Thread(target=drive, args=(name,)) for name in "ab"]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found["a"], state_of_a_whole_run())
        self.assertEqual(found["b"], state_of_a_whole_run())

    def test_a_simulation_that_runs_refuses_other_threads(self):
        sim, refused = grit.Simulation(scene()), []

        def meddle():
            for act in (lambda: sim.time, lambda: sim.bodies.position, lambda: sim.contacts.force, lambda: sim.run(1), lambda: sim.set("/title", 1), sim.save,
                        lambda: sim.walls, lambda: sim.description):
                try:
                    act()
                except grit.Error as error:
                    refused.append(str(error))

        @sim.every(steps=50)
        def let_meddle():
            if sim.step == 50:
                other = threading.Thread(target=meddle)
                other.start()
                other.join()
        sim.run()
        self.assertEqual(len(refused), 8)
        self.assertTrue(all("is running in another thread" in text for text in refused))
        self.assertEqual(state(sim), state_of_a_whole_run())


class Errors(InAFolder):
    def refused(self, path):
        done = subprocess.run([GRIT, "run", path, "--out", self.folder / "out", "--quiet"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        return done.stderr

    def test_of_descriptions_with_their_places(self):
        path = self.write({**scene(), "titel": 1, "seed": -1})
        with self.assertRaises(grit.DescriptionError) as raised:
            grit.Simulation(path)
        problems = {problem.pointer: problem for problem in raised.exception.problems}
        lines = path.read_text().splitlines()
        for pointer, key in (("/titel", '"titel"'), ("/seed", '"seed"')):
            self.assertIn(key, lines[problems[pointer].line - 1])
            self.assertEqual(problems[pointer].file, str(path))
        self.assertIn('did you mean "title"?', problems["/titel"].message)
        self.assertTrue(self.refused(path).startswith(str(raised.exception)))
        self.assertIsInstance(raised.exception, grit.Error)

    def test_of_descriptions_made_in_python(self):
        with self.assertRaisesRegex(grit.DescriptionError, "description: /seed: ") as raised:
            grit.Simulation(scene(seed=-1))
        self.assertIsNone(raised.exception.problems[0].line)
        with self.assertRaisesRegex(grit.DescriptionError, "description: /stages/0/limit: found inf of type float; allowed are") as raised:
            grit.Simulation(scene(stages=[{"limit": float("inf")}]))
        self.assertEqual(raised.exception.problems[0].pointer, "/stages/0/limit")
        with self.assertRaisesRegex(grit.DescriptionError, r"--set: .*found nan"):
            grit.Simulation(scene(), sets={"/seed": float("nan")})
        for description in (None, 3, ["box.json"]):
            with self.assertRaisesRegex(TypeError, "allowed is the path of a file, or a dict"):
                grit.Simulation(description)
        with self.assertRaisesRegex(TypeError, "sets: found a text"):
            grit.Simulation(scene(), sets="/seed=1")
        with self.assertRaisesRegex(ValueError, "threads: found 0"):
            grit.Simulation(scene(), threads=0)
        with self.assertRaisesRegex(KeyError, "there is no state 'rotations'; did you mean 'rotation'"):
            grit.Simulation(scene(), keep=["rotations"])

    def test_of_files(self):
        with self.assertRaisesRegex(grit.FileError, "nothing.json: cannot be read"):
            grit.Simulation(self.folder / "nothing.json")
        (self.folder / "bad.json").write_text("{")
        with self.assertRaisesRegex(grit.DescriptionError, r"bad.json:1: "):
            grit.Simulation(self.folder / "bad.json")

    def test_of_plugins(self):
        (self.folder / "contacts").mkdir()
        (self.folder / "contacts/broken.so").write_text("no library")
        with self.assertRaisesRegex(grit.PluginError, "broken.so") as raised:
            grit.Simulation(scene(contacts={"type": "broken"}), plugin_path=self.folder)
        self.assertIsInstance(raised.exception, grit.Error)

    def test_of_guards(self):
        heavy = scene()
        heavy["stages"][1]["change"] = {"engines": {"gravity": {"acceleration": [0, 0, -1e7]}}}
        path = self.write(heavy)
        sim = grit.Simulation(path)
        with self.assertRaises(grit.NumericsError) as raised:
            sim.run()
        error = raised.exception
        self.assertEqual((error.guard, error.pointer), ("travel", "/bodies/grains"))
        self.assertIn(error.cause, str(error))
        self.assertIn(str(error), self.refused(path))
        self.assertEqual((len(sim.bodies.force), sim.stage), (48, "rest"))
        self.assertEqual(str(pickle.loads(pickle.dumps(error))), str(error))

    def test_of_the_first_instant(self):
        deep = scene()
        deep["bodies"]["grains"]["source"]["bodies"] = [{"position": [x * MM, 0, 5 * MM], "radius": "1 mm"} for x in (0, 0.4)]
        sim = grit.Simulation(deep)
        with self.assertRaisesRegex(grit.DescriptionError, "/bodies/grains.*overlaps body"):
            sim.check()


class Checkpoints(InAFolder):
    def test_in_memory_pickled_and_in_a_file(self):
        first = grit.Simulation(scene())
        first.run(120)
        first.set("/engines/gravity/acceleration", [0, 0, -3.0])
        there, path = first.save(), self.folder / "there.h5"
        first.save(path)
        first.run()
        self.assertEqual((there.step, there.stage), (120, "fall"))
        for checkpoint in (there, pickle.loads(pickle.dumps(there)), copy.copy(there), path, str(path)):
            second = grit.Simulation(scene())
            second.resume(checkpoint)
            self.assertEqual(second.step, 120)
            self.assertGreater(second.mean_contact_force, 0)
            second.run()
            self.assertEqual(state(second), state(first))
        third = grit.Simulation(scene(), checkpoint=there)
        third.run()
        self.assertEqual(state(third), state(first))

    def test_what_is_refused(self):
        sim, path = grit.Simulation(scene()), self.folder / "there.h5"
        sim.run(3)
        sim.save(path)
        with self.assertRaisesRegex(grit.Error, "a simulation that has begun cannot resume"):
            sim.resume(sim.save())
        with self.assertRaisesRegex(grit.Error, "is of another description:\n  /engines/gravity"):
            grit.Simulation(scene(engines={"gravity": {"type": "gravity", "acceleration": [0, 0, -1]}})).resume(path)
        path.write_bytes(path.read_bytes()[:-40])
        with self.assertRaisesRegex(grit.FileError, "there.h5"):
            grit.Simulation(scene()).resume(path)
        with self.assertRaises(grit.FileError):
            sim.save(self.folder / "nowhere/there.h5")
        with self.assertRaises(TypeError):
            sim.resume(7)


class World(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sim = grit.Simulation(scene(), keep=["rotation", "displacement", "energy"])
        cls.sim.run(250)

    def test_bodies(self):
        bodies = self.sim.bodies
        self.assertEqual((len(bodies), bodies.position.shape, bodies.id.dtype, bodies.force.shape), (48, (48, 3), numpy.uint32, (48, 3)))
        self.assertEqual(bodies.radius.tolist(), [MM] * 48)
        self.assertTrue(numpy.allclose(bodies.mass, 4 / 3 * numpy.pi * MM**3 * self.sim.solid_density))
        self.assertEqual((bodies.materials, set(bodies.material), set(bodies.group), set(bodies.clump)), (["sand"], {0}, {"grains"}, {-1}))
        self.assertEqual(bodies.id[bodies.rows_of([7, 3])].tolist(), [7, 3])
        for wrong in (48, [3, 99]):
            with self.assertRaisesRegex(KeyError, "there is no body with the id"):
                bodies.rows_of(wrong)
        self.assertLess(bodies.displacement[:, 2].max(), 0)
        self.assertGreater(abs(bodies.rotation).max(), 0)
        with self.assertRaisesRegex(grit.Error, 'open the simulation with keep=\\["rotation"\\]'):
            grit.Simulation(scene()).bodies.rotation

    def test_contacts_balance(self):
        sim, contacts = self.sim, self.sim.contacts
        self.assertGreater(contacts.with_wall.sum(), 5)
        self.assertGreater((~contacts.with_wall).sum(), 5)
        self.assertTrue(numpy.allclose(numpy.linalg.norm(contacts.normal, axis=1), 1))
        self.assertTrue(numpy.allclose((contacts.force * contacts.normal).sum(axis=1), contacts.normal_force))
        for name, wall in sim.walls.items():
            own = contacts.body_b == -1 - wall.index
            self.assertEqual(own.sum(), wall.contacts)
            self.assertTrue(numpy.allclose(contacts.force[own].sum(axis=0), wall.force), name)
        net = sim.bodies.mass[:, None] * numpy.array([0, 0, -9.81])
        pairs = ~contacts.with_wall
        numpy.add.at(net, contacts.a, -contacts.force)
        numpy.add.at(net, contacts.b[pairs], contacts.force[pairs])
        self.assertTrue(numpy.allclose(net, sim.bodies.force, atol=1e-9 * abs(net).max()))
        self.assertEqual(sim.bodies.id[contacts.a].tolist(), contacts.body_a.tolist())
        self.assertTrue(numpy.isclose(abs(contacts.normal_force).mean(), sim.mean_contact_force))

    def test_forces_of_the_first_instant_are_known(self):
        touching = scene()
        touching["bodies"]["grains"]["source"]["bodies"] = [{"position": [0, 0, 0.999 * MM], "radius": "1 mm"}]
        sim = grit.Simulation(touching)
        self.assertEqual(len(sim.contacts), 1)
        self.assertLess(sim.walls["floor"].force[2], 0)

    def test_walls(self):
        walls = self.sim.walls
        self.assertEqual(list(walls), ["floor", "lid"])
        self.assertTrue(numpy.allclose(walls["lid"].position, [0, 0, -0.02 * self.sim.time]))
        self.assertTrue(numpy.isclose(walls["lid"].area, (20 * MM)**2))
        with self.assertRaisesRegex(KeyError, "there is no wall 'lit'; did you mean 'lid'"):
            walls["lit"]

    def test_energies(self):
        energies = self.sim.energies
        self.assertLess(energies.gravitational, 0)
        self.assertGreater(energies.elastic_normal, 0)
        self.assertTrue(numpy.isclose(energies.kinetic, self.sim.kinetic_energy))
        self.assertLess(abs(energies.closure_error), 0.05 * (energies.local_damping + energies.friction + energies.rolling + energies.viscosity))
        with self.assertRaisesRegex(grit.Error, 'keep=\\["energy"\\]'):
            grit.Simulation(scene()).energies

    def test_specimen(self):
        low, high = [0, 0, 0], [9 * MM, 9 * MM, 5 * MM]
        stress = self.sim.stress(low, high)
        self.assertEqual(stress.shape, (3, 3))
        self.assertGreater(stress[2, 2], 0)
        self.assertGreater(self.sim.void_ratio(low, high), 0.1)
        with self.assertRaisesRegex(TypeError, "both low and high"):
            self.sim.stress(low)
        self.assertEqual(self.sim.cell.periodic, [False, False, False])
        self.assertEqual(self.sim.specimen[0].shape, (3,))
        self.assertTrue(numpy.isclose(self.sim.mean_diameter, 2 * MM))

    def test_pictures(self):
        picture = self.sim.show("yz", color="radius")
        self.assertGreater(picture.svg.count("<circle"), 10)
        self.assertEqual((picture._repr_svg_()[:4], "48 bodies" in picture.svg), ("<svg", True))
        with tempfile.TemporaryDirectory() as folder:
            picture.save(pathlib.Path(folder) / "grains.svg")
            self.assertEqual((pathlib.Path(folder) / "grains.svg").read_text(), picture.svg)
        self.assertNotIn('class="wall"', picture.svg, "the lid is far above")
        low = scene()
        low["walls"]["lid"]["corner"][2] = 7 * MM
        self.assertIn('class="wall"', grit.Simulation(low).show().svg)
        for arguments, said in (({"view": "zz"}, "found the view 'zz'; allowed are 'xz'"), ({"color": "taste"}, "found the color 'taste'; allowed are")):
            with self.assertRaisesRegex(grit.Error, said):
                self.sim.show(**arguments)

    def test_clumps(self):
        with_rod = scene()
        with_rod["bodies"]["rods"] = {"type": "clump", "material": "sand", "shape": {"type": "rod", "count": 3},
                                      "source": {"type": "list", "bodies": [{"position": [20 * MM, 0, 3 * MM], "radius": "1 mm"}]}}
        sim = grit.Simulation(with_rod)
        sim.run(20)
        clumps, own = sim.clumps, sim.bodies.clump == 0
        self.assertEqual((len(clumps), own.sum(), set(sim.bodies.group[own])), (1, 3, {"rods"}))
        self.assertTrue(numpy.allclose(clumps.axes[0] @ clumps.axes[0].T, numpy.eye(3)))
        self.assertTrue(numpy.allclose(sim.bodies.position[own].mean(axis=0), clumps.centre[0]))
        self.assertTrue(numpy.allclose(sim.bodies.mass[own], clumps.mass[0]))
        kept, then = clumps.centre, clumps.centre.copy()
        sim.run(5)
        self.assertEqual(kept.tobytes(), then.tobytes())
        self.assertLess(sim.clumps.centre[0, 2], then[0, 2])
        self.assertEqual(len(self.sim.clumps), 0)

    def test_departures(self):
        leaving = scene(domain={"low": [-1, -1, 0.5 * MM], "high": [1, 1, 1], "open_sides": ["-z"]})
        del leaving["walls"]["floor"]
        leaving["walls"]["lid"]["corner"][2] = 0.5
        sim = grit.Simulation(leaving)
        sim.run()
        gone = sim.departures
        self.assertGreater(len(gone), 10)
        self.assertEqual(len(gone) + len(sim.bodies), 48)
        self.assertEqual(set(gone.id) & set(sim.bodies.id), set())
        self.assertLess(gone.position[:, 2].max(), 0.5 * MM)
        self.assertTrue((numpy.diff(gone.time) >= 0).all())


class Package(unittest.TestCase):
    def test_the_instruction_set(self):
        v3 = {"sse4_2", "popcnt", "avx2", "bmi2", "fma"}
        installed = ["x86-64-v2", "x86-64-v4", "x86-64-v3"]
        with unittest.mock.patch("platform.machine", lambda: "x86_64"):
            self.assertEqual(compiled.choose(installed, v3, ""), "x86-64-v3")
            self.assertEqual(compiled.choose(installed, v3, "x86-64-v2"), "x86-64-v2")
            self.assertEqual(compiled.choose([*installed, "native"], v3, ""), "native")
            for wanted, flags, said in (("x86-64-v4", v3, "GRIT_ISA=x86-64-v4: this processor does not support"), ("v3", v3, "GRIT_ISA=v3: this instruction set is not installed"),
                                        ("", set(), "this processor supports none of the installed instruction sets; installed: x86-64-v4, x86-64-v3, x86-64-v2")):
                with self.assertRaisesRegex(ImportError, said):
                    compiled.choose(installed, flags, wanted)

    def test_another_instruction_set_is_refused(self):
        done = subprocess.run([sys.executable, "-c", "import grit; grit.Simulation"], env={**os.environ, "GRIT_ISA": "vax", "PYTHONPATH": sys.path[0]},
                              stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("ImportError: GRIT_ISA=vax: this build has one instruction set", done.stderr)

    def test_without_the_compiled_module(self):
        plain = str(pathlib.Path(__file__).resolve().parents[2] / "python")
        code = "import grit\ntry:\n grit.Simulation\nexcept ImportError as error:\n print(error)\nprint(grit.open, grit.ResultsError)"
        done = subprocess.run([sys.executable, "-B", "-c", code], env={**os.environ, "PYTHONPATH": plain}, stdout=subprocess.PIPE, text=True, check=True)
        self.assertIn("reads results only; simulations need the compiled module", done.stdout)
        self.assertIn("<function open", done.stdout)

    def test_progress(self):
        with unittest.mock.patch("sys.stderr", io.StringIO()) as shown, unittest.mock.patch("grit.progress.is_seen", lambda: True):
            line = progress.make()
            line.show("shear", 2, 4, 0.5, 12.3, 1e-3, 8.1e6)
            line.show("shear", 2, 4, None, None, 1e-3, 8.1e6)
            line.close()
            self.assertEqual([text.rstrip() for text in shown.getvalue().split("\r")],
                             ["", "2/4 shear: 50 %, 12 s left, 8.10 M particle-steps/s", "2/4 shear: t = 0.001 s, 8.10 M particle-steps/s"])
            self.assertTrue(shown.getvalue().endswith("\n"))


_whole = []


def state_of_a_whole_run():
    if not _whole:
        sim = grit.Simulation(scene())
        sim.run()
        _whole.append(state(sim))
    return _whole[0]


if __name__ == "__main__":
    unittest.main()
