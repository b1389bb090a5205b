#!/usr/bin/env python3
"""Simulations in Python that are used wrongly: what is said, and the state after it.

usage: test_misuse.py GRIT     the module is that of GRIT's build folder
"""

import pickle
import sys
import unittest
import unittest.mock

from falling import MM, InAFolder, scene, state, state_of_a_whole_run

import grit
import numpy


class Failed(unittest.TestCase):
    def test_a_guard_leaves_one_state(self):
        sim = grit.Simulation(scene(guards={"overlap": 1e-4}))
        with self.assertRaisesRegex(grit.NumericsError, "more than /guards/overlap") as raised:
            sim.run()
        there, step, forces = state(sim), sim.step, sim.bodies.force.copy()
        self.assertEqual((sim.failed, sim.done), (True, False))
        self.assertIn(", failed, 48 bodies", repr(sim))
        for act in (lambda: sim.run(50), sim.run, sim.run_stage, lambda: sim.run(until=1), sim.save, lambda: sim.set("/guards/overlap", 0.5)):
            with self.assertRaises(grit.NumericsError) as again:
                act()
            self.assertEqual((str(again.exception), again.exception.guard), (str(raised.exception), "overlap"))
        self.assertEqual((state(sim), sim.step), (there, step))
        self.assertTrue((sim.bodies.force == forces).all())
        self.assertIn("<svg", sim.show().svg)

    def test_what_a_callback_raises_is_no_failure(self):
        sim = grit.Simulation(scene())
        fail = sim.every(steps=100)(lambda: 1 / 0)
        with self.assertRaises(ZeroDivisionError):
            sim.run()
        self.assertFalse(sim.failed)
        sim.remove(fail)
        sim.run()
        self.assertEqual(state(sim), state_of_a_whole_run())

    def test_a_time_step_may_be_set_again(self):
        sim = grit.Simulation(scene())
        sim.run(100)
        sim.set("/time_step/value", 1)
        with self.assertRaisesRegex(grit.NumericsError, "above the critical one"):
            sim.run(1)
        self.assertEqual((sim.failed, sim.step), (False, 100))
        with self.assertRaisesRegex(grit.NumericsError, "above the critical one"):
            sim.bodies.force
        sim.set("/time_step/value", None)
        sim.run()
        self.assertEqual(state(sim), state_of_a_whole_run())


class Done(InAFolder):
    def setUp(self):
        super().setUp()
        self.sim = grit.Simulation(scene((20, 10)))
        self.sim.run(10**30)

    def test_loops_end(self):
        sim = self.sim
        self.assertTrue(sim.done)
        for act in (lambda: sim.run(1), lambda: sim.run(until=1), sim.run_stage):
            with self.assertRaisesRegex(grit.Error, 'the simulation is done: its last stage, "rest", ended at .* s, so that it takes no more steps'):
                while True:
                    act()
        sim.run()  # nothing is left
        sim.run(0)
        sim.run(until=sim.time)
        self.assertEqual(sim.step, 30)

    def test_its_checkpoint_resumes_as_done(self):
        path = self.folder / "end.h5"
        self.sim.save(path)
        for checkpoint in (path, self.sim.save()):
            again = grit.Simulation(scene((20, 10)), checkpoint=checkpoint)
            self.assertEqual((again.done, again.step, again.stage), (True, 30, "rest"))
            self.assertEqual(state(again), state(self.sim))
            self.assertTrue(numpy.allclose(again.bodies.force, self.sim.bodies.force))
            again.run()
            with self.assertRaisesRegex(grit.Error, "is done"):
                again.run(1)


class Checkpoints(InAFolder):
    def test_of_another_description(self):
        sim, path = grit.Simulation(scene()), self.folder / "there.h5"
        sim.run(100)
        sim.save(path)
        changes = {"/materials/sand/contact_modulus": 2e6, "/engines/gravity/acceleration": [0, 0, -1], "/stages/0/until/value": 301,
                   "/bodies/grains/source/bodies/0/radius": 0.9 * MM}
        for pointer, value in changes.items():
            for checkpoint, name in ((path, str(path)), (sim.save(), "this checkpoint"), (pickle.loads(pickle.dumps(sim.save())), "this checkpoint")):
                other = grit.Simulation(scene(), sets={pointer: value})
                for resume in (lambda: other.resume(checkpoint), lambda: grit.Simulation(scene(), sets={pointer: value}, checkpoint=checkpoint)):
                    with self.assertRaisesRegex(grit.Error, f"{name}: is of another description:") as raised:
                        resume()
                    self.assertIn(f"\n  {pointer}: found", str(raised.exception).replace("/2:", ":"))
                    self.assertTrue(str(raised.exception).endswith("\n  resume with the original grit, plugins and description, or run from the start"))
                self.assertEqual((other.step, other.failed), (0, False))
                other.run(3)
        with self.assertRaisesRegex(grit.Error, r'(?s)the stage "more" is new.*\n  resume\(\) continues with the same stages.*from the start\n') as raised:
            grit.Simulation(scene(stages=[*scene()["stages"], {**scene()["stages"][0], "name": "more"}]), checkpoint=sim.save())
        self.assertNotIn("--", str(raised.exception))

    def test_other_guards_are_allowed(self):
        sim = grit.Simulation(scene())
        sim.run(100)
        again = grit.Simulation(scene(guards={"overlap": 0.3}), checkpoint=sim.save())
        again.run()
        self.assertEqual(state(again), state_of_a_whole_run())

    def test_damaged_files(self):
        path = self.folder / "there.h5"
        path.write_text("no checkpoint")
        sim = grit.Simulation(scene())
        with self.assertRaisesRegex(grit.FileError, "(?s)there.h5.*run from the start") as raised:
            sim.resume(path)
        self.assertNotIn("--", str(raised.exception))
        sim.run()
        self.assertEqual(state(sim), state_of_a_whole_run())

    def test_what_they_show(self):
        sim = grit.Simulation(scene())
        sim.run(10)
        self.assertRegex(repr(sim.save()), r"^<checkpoint: [0-9.e-]+ s, step 10, stage 'fall', [0-9.]+ MB>$")


class Missing(InAFolder):
    def test_modules_and_programs(self):
        sim = grit.Simulation(scene())
        sim.probe("speed", every_steps=1)(lambda simulation: {"largest": 1.0})
        sim.run(1)
        with unittest.mock.patch.dict(sys.modules, {"pandas": None}), self.assertRaisesRegex(ImportError, "^to_pandas needs pandas: .*; install it: apt install python3-pandas$"):
            sim.series("speed").to_pandas()
        with unittest.mock.patch.dict("os.environ", {"PATH": str(self.folder)}), self.assertRaisesRegex(
                FileNotFoundError, "^a picture as PNG needs rsvg-convert, which is not there; install it: apt install librsvg2-bin$"):
            sim.show().save(self.folder / "a.png")
        self.assertEqual(list(self.folder.iterdir()), [])


class Values(unittest.TestCase):
    def test_that_have_no_effect_any_more(self):
        sim = grit.Simulation(scene())
        sim.run(10)
        for pointer, value, said in (("/materials/sand/density", 5200, "found a new density"), ("/walls/lid/motion", {}, "found an empty object"),
                                     ("/bodies/grains/source", {"type": "list", "bodies": []}, "found a change of \"bodies\"; allowed is one of materials, interfaces, walls"),
                                     ("/domain/low", [0, 0, 0], "domain"), ("/contacts/type", "hertz-mindlin", "found a change of \"contacts\"")):
            with self.assertRaisesRegex(grit.DescriptionError, said):
                sim.set(pointer, value)
        sim.run()
        self.assertEqual(state(sim), state_of_a_whole_run())


class Arguments(InAFolder):
    def test_of_each_call(self):
        sim, place = grit.Simulation(scene()), self.folder
        text, number, many = 3.5, "three", 7
        calls = {
            TypeError: [
                lambda: sim.run(number), lambda: sim.run(text), lambda: sim.run(True), lambda: sim.run(until=number), lambda: sim.run(until=True), lambda: sim.set(text, 1),
                lambda: sim.save(text), lambda: sim.resume(text), lambda: sim.resume(b"a.h5"), lambda: sim.every(time=number), lambda: sim.every(steps=number),
                lambda: sim.every(steps=1)(text), lambda: sim.at_stage_end(text), lambda: sim.probe(text, every_steps=1), lambda: sim.probe("a", every_steps=number),
                lambda: sim.probe("a"), lambda: sim.probe("a", every_steps=1, units="Pa"), lambda: sim.show(text), lambda: sim.show(color=many),
                lambda: sim.stress(number, number), lambda: sim.stress([0, 0], [1, 1]), lambda: sim.void_ratio(0, 1), lambda: sim.void_ratio([0, 0, "a"], [1, 1, 1]),
                lambda: sim.bodies.rows_of("a"), lambda: sim.bodies.rows_of(0.5), lambda: grit.Simulation(many), lambda: grit.Simulation(scene(), threads=number),
                lambda: grit.Simulation(scene(), sets=many), lambda: grit.Simulation(scene(), sets=[many]), lambda: grit.Simulation(scene(), sets={3: 4}),
                lambda: grit.Simulation(scene(), plugin_path=many), lambda: grit.Simulation(scene(), plugin_path=[many]), lambda: grit.Simulation(scene(), keep=many),
                lambda: grit.Simulation(scene(), checkpoint=many)],
            ValueError: [
                lambda: sim.run(-1), lambda: sim.set("", {}), lambda: sim.save(""), lambda: sim.save("a\0b"), lambda: sim.every(steps=0), lambda: sim.every(time=-1),
                lambda: sim.probe("", every_steps=1), lambda: sim.probe("a", every_steps=1, units={"a": "blub"}), lambda: sim.probe("a", every_steps=1, units={"a": 3}),
                lambda: sim.stress([0, 0, 0], [1, 1, 0]), lambda: sim.show().save(place / "a.pdf"), lambda: grit.Simulation(scene(), threads=0),
                lambda: grit.Simulation(scene(), threads=10**20), lambda: grit.Simulation("a\0b"), lambda: grit.Simulation(scene(), threads=10**5000),
                lambda: sim.every(time=10**400), lambda: sim.engine("wind", stiffness=10**400), lambda: sim.run(steps=-10**5000),
                lambda: sim.stress([0, 0, 0], [1, 1, 10**400])],
            grit.FileError: [
                lambda: sim.resume(place / "nothing.h5"), lambda: sim.save(place / "nowhere/a.h5"), lambda: sim.show().save(place / "nowhere/a.svg"),
                lambda: grit.Simulation(scene(), plugin_path="/nowhere"), lambda: grit.Simulation(scene(), plugin_path=[place])],
            grit.UnknownName: [lambda: sim.walls[0], lambda: sim.series("a"), lambda: grit.Simulation(scene(), keep=[many])],
        }
        for error, several in calls.items():
            for call, place_of in zip(several, range(len(several))):
                with self.subTest(error=error.__name__, number=place_of):
                    with self.assertRaises(error) as raised:
                        call()
                    said = str(raised.exception)
                    self.assertNotRegex(said, r"incompatible|grit\._grit|--[a-z]|\.\.$|[a-z0-9'] There are")
                    if error is TypeError or error is ValueError:
                        self.assertRegex(said, "allowed is|give one of")
        sim.run()
        self.assertEqual(state(sim), state_of_a_whole_run())

    def test_files_beside_a_state_stay(self):
        (self.folder / "a.h5.part").write_text("mine")
        for _ in range(2):
            grit.Simulation(scene()).save(self.folder / "a.h5")
        self.assertEqual((self.folder / "a.h5.part").read_text(), "mine")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["a.h5", "a.h5.part"])

    def test_names_of_values_with_a_unit(self):
        sim = grit.Simulation(scene())
        sim.probe("mine", every_steps=1, units={"heigth": "m"})(lambda: {"height": 1})
        with self.assertRaisesRegex(grit.Error, r"probe 'mine' has a unit of 'heigth', which it does not return; it returns \['height'\]"):
            sim.run(1)

    def test_descriptions_that_are_no_json(self):
        endless, ring, deep, nested = scene(), [], [], numpy.empty(1, dtype=object)
        endless["walls"]["floor"]["motion"] = endless["walls"]
        ring.append({"a": ring})
        nested[0] = nested
        for _ in range(500):
            deep = [deep]
        for title, said in ((10**400, "a whole number of about 400 digits; allowed are whole numbers up to 1.8e.308 in amount"), (-10**5000, "a whole number of about 5000 digits"),
                            ([3, {"a": 10**400}], "a whole number"), (float("nan"), "nan of type float; allowed are dicts, lists, finite"),
                            (-float("inf"), "-inf of type float"), (numpy.array([1, numpy.inf]), "inf of type float"), (numpy.longdouble("inf"), "inf of type float"),
                            ({1, 2}, r"{1, 2} of type set; allowed are dicts"), (b"a", "b'a' of type bytes"), (1j, "1j of type complex"),
                            (set(range(1000)), r"[0-9, {]{78,80}… of type set"), ({3: 4}, "the key 3 of type int; allowed are texts as keys"),
                            ({None: 4}, "the key None of type NoneType"), ({b"a": 4}, "the key b'a' of type bytes"), ({"\ud800": 4}, "the text '.ud800', which is not"),
                            ("\ud800", "the text '.ud800', which is not Unicode"), (ring, "a list that contains itself"), (nested, "a list that contains itself|inside each"),
                            (deep, "lists and dicts inside each other at more than 100 levels; allowed are up to 100")):
            pointer = "/title" + {"a whole number": "/1/a", "a list that contains itself": "/0/a"}.get(said, "")
            with self.subTest(said=said):
                with self.assertRaisesRegex(grit.DescriptionError, f"^description: {pointer}[^:]*: found {said}") as raised:
                    grit.Simulation(scene(title=title))
                self.assertTrue(raised.exception.problems[0].pointer.startswith(pointer))
                with self.assertRaisesRegex(grit.DescriptionError, f"^sets: {pointer}[^:]*: found {said}"):
                    grit.Simulation(scene(), sets={"/title": title})
        with self.assertRaisesRegex(grit.DescriptionError, "^description: /walls/floor/motion: found a dict that contains itself; allowed are values that end"):
            grit.Simulation(endless)
        same = {"type": "gravity"}
        grit.Simulation(scene(engines={"gravity": same, "damping": {"type": "local-damping", "coefficient": numpy.longdouble("0.5")}}))

    def test_advice_on_plugins(self):
        with self.assertRaisesRegex(grit.DescriptionError, "plugin_path=DIR or GRIT_PLUGIN_PATH=DIR adds DIR/contacts") as raised:
            grit.Simulation(scene(), sets={"/contacts/type": "sticky"})
        self.assertEqual(raised.exception.problems[0].file, "sets")
        self.assertNotIn("--", str(raised.exception))

    def test_names_that_are_unknown(self):
        for name, said in (("lit", "there is no wall 'lit'; did you mean 'lid'? There are: floor, lid"), ("x", "there is no wall 'x'. There are: floor, lid")):
            with self.assertRaises(KeyError) as raised:
                grit.Simulation(scene()).walls[name]
            self.assertEqual(str(raised.exception), said)


if __name__ == "__main__":
    unittest.main()
