#!/usr/bin/env python3
"""Engines of simulations that are written in Python.

usage: test_engine.py GRIT     the module is that of GRIT's build folder
"""

import gc
import os
import pickle
import signal
import unittest
import weakref

from falling import long_scene, scene, state

import numpy

import grit

G = 9.81


def one_grain():
    """At rest, far from all others, without weight and damping."""
    grains = {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [{"position": [0, 0, 1], "radius": "1 mm"}]}}
    return scene(bodies={"grains": grains}, walls={}, engines={})


def weightless():
    description = scene()
    del description["engines"]["gravity"]
    return description


def drag(sim):
    return -1e-4 * sim.bodies.velocity


class Engines(unittest.TestCase):
    def test_weight_is_that_of_gravity(self):
        sim = grit.Simulation(one_grain())

        @sim.engine("weight")
        def weight():
            return sim.bodies.mass[:, None] * [0, 0, -G]
        sim.run(100)
        numpy.testing.assert_allclose(sim.bodies.position[0, 2] - 1, -0.5 * G * sim.time**2, rtol=1e-9)

    def test_results_are_those_of_any_number_of_threads_and_calls(self):
        states = []
        for threads, single in ((1, False), (2, False), (2, True)):
            sim = grit.Simulation(scene(), threads=threads)
            sim.engine("drag", damping=1.0)(drag)
            while single and not sim.done:
                sim.run(1)
            sim.run()
            states.append(state(sim))
        self.assertEqual(states[0], states[1])
        self.assertEqual(states[0], states[2])
        still = grit.Simulation(scene())
        still.run()
        self.assertNotEqual(states[0], state(still))

    def test_forces_and_moments_of_all_forms(self):
        sim = grit.Simulation(one_grain())
        sim.engine("push")(lambda: [0, 2e-3, 0])
        sim.engine("turn")(lambda: (None, numpy.tile([0, 0, 3e-6], (len(sim.bodies), 1))))
        sim.engine("nothing")(lambda: None)
        sim.run(1)
        mass, radius = sim.bodies.mass[0], sim.bodies.radius[0]
        numpy.testing.assert_allclose(sim.bodies.velocity[:, 1], 0.5 * sim.dt * 2e-3 / mass, rtol=1e-9)
        numpy.testing.assert_allclose(sim.bodies.spin[:, 2], 0.5 * sim.dt * 3e-6 / (0.4 * mass * radius**2), rtol=1e-9)

    def test_is_asked_for_forces_of_the_first_instant(self):
        sim = grit.Simulation(weightless())
        sim.engine("push")(lambda: [0, 2e-3, 0])
        self.assertEqual(sim.bodies.force[0, 1], 2e-3)
        sim.set("/materials/sand/friction_angle", "10 deg")
        self.assertEqual(sim.bodies.force[0, 1], 2e-3)

    def test_it_is_replaced_and_removed(self):
        sim = grit.Simulation(one_grain())
        speeds = []
        for force in (1e-3, -1e-3):
            @sim.engine("push")
            def push(force=force):
                return [0, force, 0]
            sim.run(10)
            speeds.append(sim.bodies.velocity[0, 1])
        self.assertGreater(speeds[0], speeds[1])
        sim.remove(push)
        sim.run(10)
        self.assertEqual(sim.bodies.velocity[0, 1], speeds[1])
        with self.assertRaisesRegex(grit.Error, "is no callback of this simulation"):
            sim.remove(push)

    def test_arrays_that_it_keeps_do_not_change(self):
        sim, kept = grit.Simulation(scene()), []

        @sim.engine("watch")
        def watch():
            kept.append((sim.bodies.position, sim.bodies.position.copy(), sim.bodies.velocity, sim.bodies.velocity.copy()))
        sim.run(20)
        for position, place, velocity, speed in kept:
            numpy.testing.assert_array_equal(position, place)
            numpy.testing.assert_array_equal(velocity, speed)
        reference = grit.Simulation(scene())
        reference.run(20)
        self.assertEqual(state(sim), state(reference))

    def test_the_time_step_knows_its_stiffness(self):
        plain, stiff = grit.Simulation(scene()), grit.Simulation(scene())
        critical = plain.check().critical_time_step
        stiff.engine("springs", stiffness=64 / critical**2)(lambda: None)
        self.assertLess(stiff.check().critical_time_step, 0.26 * critical)

    def test_a_checkpoint_needs_it(self):
        whole, first = grit.Simulation(scene()), grit.Simulation(scene())
        for sim in (whole, first):
            sim.engine("drag")(drag)
        first.run(250)
        saved = pickle.loads(pickle.dumps(first.save()))
        whole.run()
        rest = grit.Simulation(scene())
        rest.engine("drag")(drag)
        rest.resume(saved)
        rest.run()
        self.assertEqual(state(rest), state(whole))
        with self.assertRaisesRegex(grit.Error, 'engine "drag"'):
            grit.Simulation(scene()).resume(saved)


class Faults(unittest.TestCase):
    def test_an_exception_arrives_unchanged_and_ends_the_simulation(self):
        sim, thrown = grit.Simulation(scene()), LookupError("mine")

        @sim.engine("broken")
        def broken():
            if sim.step == 7:
                raise thrown
        with self.assertRaises(LookupError) as raised:
            sim.run()
        self.assertIs(raised.exception, thrown)
        self.assertTrue(sim.failed)
        for again in (lambda: sim.run(), lambda: sim.save(), lambda: sim.remove(broken)):
            with self.assertRaisesRegex(grit.Error, 'engine "broken" raised an exception in the middle of a step'):
                again()
        self.assertEqual(sim.step, 7)

    def test_an_exception_where_forces_are_looked_at(self):
        for look in (lambda sim: sim.bodies.force, lambda sim: (sim.every(steps=1)(lambda: None), sim.run())):
            sim = grit.Simulation(scene())
            sim.run(5)
            sim.engine("broken")(lambda: 1 / 0)
            with self.assertRaises(ZeroDivisionError):
                look(sim)
            self.assertTrue(sim.failed)
            with self.assertRaisesRegex(grit.Error, 'engine "broken" raised an exception in the middle of a step'):
                sim.run()
            self.assertEqual(sim.step, 5)

    def test_an_exception_at_the_first_instant(self):
        for call in (lambda sim: sim.check(), lambda sim: sim.bodies.force, lambda sim: sim.save(), lambda sim: sim.run(1),
                     lambda sim: sim.set("/materials/sand/friction_angle", 0.1)):
            sim = grit.Simulation(scene())
            sim.engine("broken")(lambda: 1 / 0)
            with self.assertRaises(ZeroDivisionError):
                call(sim)

    def test_ctrl_c_ends_the_run_after_the_step(self):
        sim = grit.Simulation(long_scene())
        calls = []

        @sim.engine("interrupted")
        def interrupted():
            calls.append(sim.step)
            if len(calls) == 20:
                os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            sim.run()
        self.assertFalse(sim.failed)
        self.assertEqual(calls[18:], [calls[19] - 1, calls[19], calls[19]], "it is asked again")
        self.assertEqual(sim.step, calls[19] + 1)
        sim.run(5)
        plain = grit.Simulation(long_scene())
        plain.run(sim.step)
        self.assertEqual(state(sim), state(plain))

    def test_what_it_may_not_return(self):
        for wrong, message in (([1, 2], r"engine 'wrong' returned an array of shape \(2,\); allowed are \(48, 3\)"),
                               (numpy.zeros((3, 48)), r"of shape \(3, 48\)"), ("far", "engine 'wrong' returned str"), (([0, 0, 1],) * 3, "returned 3 values"),
                               ([0, float("nan"), 0], 'force of the engine "wrong" that is not finite')):
            sim = grit.Simulation(scene())
            sim.engine("wrong")(lambda: wrong)
            with self.assertRaisesRegex(grit.Error, message):
                sim.run()

    def test_what_it_may_not_do(self):
        for call, message in ((lambda sim: sim.set("/materials/sand/friction_angle", 0.1), r"set\(\) cannot be called in an engine"),
                              (lambda sim: sim.run(1), r"run\(\) cannot be called in a callback"),
                              (lambda sim: sim.save(), r"save\(\) cannot be called in a callback"),
                              (lambda sim: sim.engine("more")(drag), r"engine\(\) cannot be called in an engine")):
            sim = grit.Simulation(scene())
            sim.engine("curious")(call)
            with self.assertRaisesRegex(grit.Error, message):
                sim.run()

    def test_arguments(self):
        sim = grit.Simulation(scene())
        for call, error, message in ((lambda: sim.engine("drag", damping=-1), ValueError, "damping: found -1; allowed is a finite number from 0"),
                                     (lambda: sim.engine("drag", stiffness="high"), TypeError, "stiffness: found 'high'"),
                                     (lambda: sim.engine(3), TypeError, "name: found 3"),
                                     (lambda: sim.engine("drag")(3), TypeError, "allowed is a function"),
                                     (lambda: sim.engine("gravity")(drag), grit.Error, 'found an engine "gravity" in /engines')):
            with self.assertRaisesRegex(error, message):
                call()
        sim.run(1)

    def test_no_cycle_keeps_the_simulation(self):
        sim = grit.Simulation(scene())

        @sim.engine("own")
        def own():
            return 0 * sim.bodies.velocity
        sim.run(2)
        gone = weakref.ref(sim)
        bodies = sim.bodies
        del sim, own
        gc.collect()
        self.assertIsNone(gone())
        self.assertEqual(len(bodies), 48)


if __name__ == "__main__":
    unittest.main()
