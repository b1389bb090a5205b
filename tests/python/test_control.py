#!/usr/bin/env python3
"""Callbacks, interrupts, threads and errors of simulations in Python, and its package.

usage: test_control.py GRIT     the module is that of GRIT's build folder
"""

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

from falling import GRIT, MM, InAFolder, long_scene, scene, state, state_of_a_whole_run

import numpy

import grit
from grit import compiled, progress


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

    def test_the_end_of_a_stage_without_a_step(self):
        met = {"until": {"type": "kinetic-energy", "below": 1e30}, "limit": "1 s"}
        described, ends = scene((20, 10)), []
        described["stages"] += [{"name": "third", **met}, {"name": "fourth", **met}]
        sim = grit.Simulation(described)
        sim.at_stage_end(lambda: ends.append((sim.stage, sim.step)))
        sim.run()
        self.assertEqual([name for name, step in ends], ["fall", "rest", "third", "fourth"])
        self.assertEqual([step for name, step in ends], [20, 30, 30, 30])

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

    def test_probes_of_the_description(self):
        described = scene((20, 10), probes={"packing": {"type": "packing", "every_steps": 10}, "walls": {"type": "walls", "every_steps": 5}})
        sim = grit.Simulation(described)
        self.assertEqual(len(sim.series("packing")["time"]), 0)
        self.assertEqual(sim.series("walls")["lid_force"].shape, (0, 3))
        sim.run()
        packing, walls = sim.series("packing"), sim.series("walls")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.json"
            file.write_text(json.dumps(described))
            subprocess.run([GRIT, "run", file, "--out", file.parent / "out", "--quiet", "--no-report"], check=True, stdout=subprocess.DEVNULL)
            written = grit.open(file.parent / "out").series
            for name, samples in (("packing", packing), ("walls", walls)):
                self.assertEqual(sorted(samples), sorted(one.partition("/")[2] for one in written if one.startswith(name + "/")))
                for channel in samples:
                    numpy.testing.assert_array_equal(samples[channel], written[f"{name}/{channel}"])
                    self.assertEqual(samples.units(channel), written.units(f"{name}/{channel}"))
                    self.assertEqual(samples.about(channel), written.about(f"{name}/{channel}"))
        self.assertEqual(packing["step"].tolist(), [0, 10, 20, 30])
        self.assertEqual(walls["lid_force"].shape, (len(walls["time"]), 3))
        with self.assertRaisesRegex(KeyError, "there is no channel 'lid_forc'; did you mean 'lid_force'"):
            walls["lid_forc"]
        with self.assertRaisesRegex(KeyError, "there is no probe 'walks'; did you mean 'walls'"):
            sim.series("walks")
        with self.assertRaisesRegex(grit.Error, "the description has a probe 'walls'; choose another name"):
            sim.probe("walls", every_steps=1)(lambda: {"value": 1})
        try:
            import pandas
        except ImportError:
            return
        self.assertEqual(packing.to_pandas().loc[sim.time, "step"], 30)
        self.assertNotIn("lid_force", walls.to_pandas())

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


class TheEndOfTheInterpreter(unittest.TestCase):
    """While a daemon thread drives a simulation."""

    def ends(self, thread, main="", first="", last="pass", status=3):
        """Bodies: of the thread, which sets `begun`; of the main thread after that, before grit is imported, and of the last destructor, which
        comes when Python has begun to stop threads."""
        script = f"""
import atexit, os, sys, threading
{first}
sys.argv = ["", {str(GRIT)!r}]
import falling, grit

class Last:
    def __del__(self):
        {last}
        for _ in range(10**6):  # in which other threads may get the lock
            pass

sim, begun, goes_on, last = grit.Simulation(falling.long_scene()), threading.Event(), threading.Event(), Last()
Last.goes_on = goes_on

def drive():
{thread}

other = threading.Thread(target=drive, daemon=True)
other.start()
begun.wait()
{main}
sys.exit({status})
"""
        done = subprocess.run([sys.executable, "-B", "-c", script], env={**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stdout), (status, ""))

    def test_in_a_run(self):
        for steps in (1, 10**9):
            self.ends(f"""
    sim.every(steps={steps})(begun.set)
    sim.run()""")

    def test_in_many_runs(self):
        self.ends("""
    while True:
        sim.run(steps=1)
        begun.set()""")

    def test_in_an_engine(self):
        self.ends("""
    sim.engine("none")(begun.set)
    sim.run()""")

    def test_in_a_callback_that_waits(self):
        for decorator in ("sim.every(steps=1)", "sim.engine('wind')"):
            self.ends(f"""
    @{decorator}
    def wait():
        begun.set()
        goes_on.wait()
    sim.run()""", last="self.goes_on.set()")

    def test_while_simulations_are_opened(self):
        self.ends("""
    while True:
        grit.Simulation(falling.scene())
        begun.set()""")

    def test_of_which_others_know(self):
        self.ends("""
    sim.every(steps=10**9)(begun.set)
    sim.run()""", first="atexit.register(lambda: other.join())")

    def test_that_runs_another_simulation(self):
        self.ends("""
    sim.every(steps=10**9)(begun.set)
    sim.run()""", first="atexit.register(lambda: grit.Simulation(falling.scene((5, 5))).run())")

    def test_of_a_child(self):
        self.ends("""
    sim.every(steps=10**9)(begun.set)
    sim.run()""", """
child = os.fork()
if not child:
    sys.exit(4)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 4""")


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
        with self.assertRaisesRegex(grit.DescriptionError, "sets: /seed: found nan"):
            grit.Simulation(scene(), sets={"/seed": float("nan")})
        for description in (None, 3, ["box.json"]):
            with self.assertRaisesRegex(TypeError, "allowed is the path of a file, or a dict"):
                grit.Simulation(description)
        with self.assertRaisesRegex(TypeError, "sets: found a text"):
            grit.Simulation(scene(), sets="/seed=1")
        with self.assertRaisesRegex(ValueError, "threads: found 0; allowed is a whole number from 1 to"):
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


if __name__ == "__main__":
    unittest.main()
