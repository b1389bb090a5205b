#!/usr/bin/env python3
"""State and results of simulations driven from Python.

usage: test_simulation.py GRIT     the module is that of GRIT's build folder
"""

import base64
import copy
import gc
import pathlib
import pickle
import re
import subprocess
import tempfile
import unittest
import weakref

from falling import GRIT, MM, InAFolder, scene, state

import grit
import numpy


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
                                       ({"steps": 1.5}, TypeError, "found 1.5; allowed"), ({"until": "1 s"}, TypeError, "simulated time in seconds"),
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
        shown = base64.b64decode(picture._repr_html_().partition("base64,")[2].partition('"')[0]).decode()
        self.assertEqual((shown, shown[:4], "48 bodies" in shown), (picture.svg, "<svg", True))
        self.assertIn("grains that fall", shown)
        with tempfile.TemporaryDirectory() as folder:
            picture.save(pathlib.Path(folder) / "grains.svg")
            self.assertEqual((pathlib.Path(folder) / "grains.svg").read_text(), picture.svg)
            picture.save(pathlib.Path(folder) / "grains.png")
            width = int(re.search(r'<svg[^>]* width="(\d+)', picture.svg)[1])
            png = (pathlib.Path(folder) / "grains.png").read_bytes()
            self.assertEqual((png[:8], int.from_bytes(png[16:20], "big")), (b"\x89PNG\r\n\x1a\n", 2 * width))
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


if __name__ == "__main__":
    unittest.main()
