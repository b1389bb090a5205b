"""The dense box in YADE: `yade -jT -n -x dense-box.yade.py`; values come from bench/compare in DENSE_BOX, as JSON."""
import json
import os
import time
from math import atan

from yade import *
from yade import utils
from yade.minieigenHP import Matrix3, Vector3

given = json.loads(os.environ['DENSE_BOX'])


def along_curve(row, step=1e-3):
    """Index on a space-filling curve. The other codes sort grains themselves; YADE keeps the order of the input."""
    whole = [int(x / step) for x in row[:3]]
    return sum((whole[axis] >> bit & 1) << (3 * bit + axis) for bit in range(10) for axis in range(3))


with open(given['grains']) as lines:
    rows = sorted((tuple(map(float, line.split())) for line in lines), key=along_curve)

O.periodic = True
a, b, c = given['sides']
O.cell.hSize = Matrix3(a, 0, 0, 0, b, 0, 0, 0, c)
common = dict(density=given['density'], frictionAngle=atan(given['mu']))
if given['law'] == 'rolling':
    # always_use_moment_law: otherwise there is no rolling resistance without cohesion.
    sand = CohFrictMat(young=given['modulus'], poisson=given['shear_to_normal'], isCohesive=False,
                       momentRotationLaw=True, alphaKr=0.7, alphaKtw=0, etaRoll=0.4, etaTwist=0, **common)
    loop = [[Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
            [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True, always_use_moment_law=True)]]
elif given['law'] == 'no-rolling':
    sand = FrictMat(young=given['modulus'], poisson=given['shear_to_normal'], **common)
    loop = [[Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]]
else:
    sand = FrictMat(young=given['young'], poisson=given['poisson'], **common)
    loop = [[Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_MindlinPhys(en=given['restitution'], es=given['restitution'])],
            [Law2_ScGeom_MindlinPhys_Mindlin()]]
O.materials.append(sand)
for x, y, z, r in rows:
    O.bodies.append(utils.sphere(Vector3(x, y, z), r, material=sand))
# A quarter of the smallest radius is the fastest of 0.15 to 1.2; the default, a half, is about 10 % slower here.
collider = InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=-0.25)
O.engines = [ForceResetter(), collider, InteractionLoop(*loop),
             NewtonIntegrator(damping=0 if given['law'] == 'hertz' else 0.08)]
O.dt = given['dt']
rate = given['rate']
O.cell.velGrad = Matrix3(rate / 2, 0, 0, 0, rate / 2, 0, 0, 0, -rate)


def contacts_per_grain():
    return 2 * sum(1 for one in O.interactions if one.isReal) / len(rows)


O.run(given['warm'], True)
before = contacts_per_grain()
start = time.perf_counter()
O.run(given['steps'], True)
seconds = time.perf_counter() - start
print('RESULT', json.dumps([seconds, before, contacts_per_grain()]), flush=True)
