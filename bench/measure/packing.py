"""Periodic packings as text, lines `x y z r` in m: made by grit, repeated, and read for other codes."""
import hashlib
import json
import math
import os
import re
import statistics
from pathlib import Path
from typing import NamedTuple

from . import grit
from .machine import Complaint, say

ROOT = Path(__file__).resolve().parents[2]
# Folder of packings and runs.
STORE = Path(os.environ.get('GRIT_BENCH_STORE') or ROOT / 'results' / 'bench').resolve()
PACK, PRESS = (ROOT / 'bench' / 'scenes' / name for name in ('pack.json', 'press.json'))
PRESSURE = 150e3  # Pa

UNIFORM = {'type': 'uniform', 'smallest': 0.25e-3, 'largest': 0.75e-3}
# Equal mass in each of ten classes that grow by a constant factor: grains of all sizes, most of them small.
_SIEVES = [0.25e-3 * 10 ** (i / 10) for i in range(11)]
WIDE = {'type': 'sieve', 'diameters': _SIEVES, 'passing': [i / 10 for i in range(11)]}


class Cell(NamedTuple):
    low: tuple
    high: tuple

    def sides(self):
        return tuple(high - low for low, high in zip(self.low, self.high))


class Packing(NamedTuple):
    path: Path
    cell: Cell
    grains: int
    digest: str  # first letters of the file's SHA-256

    def settings(self, cell=True):
        """Settings that make a scene of bench/scenes use this packing and its cell."""
        grains = {'/bodies/sand/source/path': str(self.path)}
        if not cell:
            return grains
        return grains | {'/domain/low': list(self.cell.low), '/domain/high': list(self.cell.high)}

    def rows(self):
        """x, y, z, r of each grain, from the cell's lower corner."""
        with open(self.path, encoding='utf-8') as lines:
            for line in lines:
                words = line.partition('#')[0].split()
                if words:
                    x, y, z, r = map(float, words)
                    yield x - self.cell.low[0], y - self.cell.low[1], z - self.cell.low[2], r

    def __str__(self):
        return f'{self.path.parent.name if self.path.name == "packing.txt" else self.path.name} (sha256 {self.digest})'


def read(path, side=None):
    """A packing of any origin. Its cell is given in a comment, or is a cube from the origin with the given side."""
    path = Path(path).resolve()
    if not path.is_file():
        raise Complaint(f'{path}: no such packing; give a file of lines `x y z r` in m, or omit --packing to make '
                        'one')
    grains, cell, digest = 0, None, hashlib.sha256()
    number = r'([-+0-9.eE]+)'
    with open(path, 'rb') as lines:
        for count, raw in enumerate(lines, 1):
            digest.update(raw)
            line = raw.decode('utf-8', 'replace')
            if line.startswith('#'):
                if match := re.match(rf'# cell {number} {number} {number} to {number} {number} {number}', line):
                    ends = tuple(map(float, match.groups()))
                    cell = Cell(ends[:3], ends[3:])
            elif words := line.partition('#')[0].split():
                try:
                    fine = len(words) == 4 and all(math.isfinite(float(word)) for word in words)
                except ValueError:
                    fine = False
                if not fine:
                    raise Complaint(f'{path}:{count}: found "{line.strip()[:60]}"; a grain is four numbers: x y z r, '
                                    'in m')
                grains += 1
    if side is not None:
        cell = Cell((0.0,) * 3, (side,) * 3)
    if cell is None:
        raise Complaint(f'{path}: has no cell; allowed is a comment `# cell x y z to x y z, m`, or give its side in m: '
                        '--side 0.0109')
    return Packing(path, cell, grains, digest.hexdigest()[:12])


def made(program, name, count, sizes, void_ratio, seed=1):
    """A dense packing under PRESSURE, made once by grit; the folder name has a digest of its recipe. It is compacted to
    `void_ratio` in one stage."""
    recipe = json.dumps([PACK.read_text(), PRESS.read_text(), PRESSURE, count, sizes, void_ratio, seed], sort_keys=True)
    folder = STORE / f'{name}-{count}-seed{seed}-{hashlib.sha256(recipe.encode()).hexdigest()[:8]}'
    if not folder.is_dir():
        say(f'making {folder} …')
        # With 70 % of the volume empty, grains of a cloud are placed quickly.
        side = (_solids(sizes, count) / 0.3) ** (1 / 3)
        part = folder.with_name(folder.name + '.part')
        done = grit.run(program, PACK, part, threads=None, settings={
            '/seed': seed, '/domain/high': [side] * 3, '/bodies/sand/source/high': [side] * 3,
            '/bodies/sand/source/count': count, '/bodies/sand/source/sizes': sizes,
            '/stages/0/until/below': 1.2 * void_ratio, '/stages/1/until/below': void_ratio})
        _press(program, part, _pressure(done))
        _into_cell(part / 'packing.txt')
        part.rename(folder)
    return read(folder / 'packing.txt')


def _into_cell(path):
    """Moves grains back into the cell that have crossed a side since the last neighbour search."""
    lines = path.read_text(encoding='utf-8').splitlines()
    cell = read(path).cell
    with open(path, 'w', encoding='utf-8') as out:
        for line in lines:
            if not line.startswith('#'):
                *place, radius = map(float, line.split())
                place = [low + (x - low) % (high - low) for x, low, high in zip(place, *cell)]
                line = ' '.join(map(repr, [*map(min, place, cell.high), radius]))
            out.write(line + '\n')


def _press(program, folder, pressure):
    """Compresses or expands the cell repeatedly until its grains are at rest under PRESSURE."""
    # Pa per volumetric strain, first guess; then as measured.
    stiffness = 8e7
    for _ in range(20):
        say(f'  {pressure / 1e3:.0f} kPa')
        if abs(pressure / PRESSURE - 1) < 0.05:
            return
        # Small steps: a loose packing is soft.
        strain = max(-0.005, min(0.005, (pressure - PRESSURE) / stiffness)) if pressure > 0.1 * PRESSURE else -0.01
        before = pressure
        rate = math.copysign(5.0, strain)
        # A run does not read what it writes.
        start = (folder / 'packing.txt').rename(folder / 'before.txt')
        _into_cell(start)
        done = grit.run(program, PRESS, folder, threads=None, settings=read(start).settings() | {
            '/domain/strain_rate': [rate] * 3, '/stages/0/until/value': abs(strain / (3 * rate))})
        pressure = _pressure(done)
        if (found := (before - pressure) / strain) > 0:
            stiffness = min(3e8, max(1e7, found))
    raise Complaint(f'{folder}: the packing does not come to {PRESSURE / 1e3:g} kPa; found {pressure / 1e3:.0f} kPa; '
                    'try another seed')


def _pressure(done):
    """The final mean stress of a run [Pa]."""
    return done.final('packing/mean_stress', 'Pa')


def _solids(sizes, count):
    """Volume of the grains [m³], from the moments of their distribution."""
    if sizes['type'] == 'uniform':
        a, b = sizes['smallest'], sizes['largest']
        mean_cube = (b**4 - a**4) / (4 * (b - a))
    else:
        # In a class with mass uniform over the diameter, numbers are proportional to 1/d³.
        number = mass = 0.0
        for a, b, low, high in zip(sizes['diameters'], sizes['diameters'][1:], sizes['passing'], sizes['passing'][1:]):
            fraction = high - low
            mass += fraction
            number += fraction * (a + b) / (2 * a * a * b * b)
        mean_cube = mass / number
    return count * math.pi / 6 * mean_cube


def repeated(packing, times):
    """The packing repeated along each axis."""
    nx, ny, nz = times
    count = packing.grains * nx * ny * nz
    folder = STORE / f'repeated-{count}-{packing.digest}-{nx}x{ny}x{nz}'
    path = folder / 'packing.txt'
    if not path.is_file():
        say(f'making {folder} …')
        folder.mkdir(parents=True, exist_ok=True)
        a, b, c = packing.cell.sides()
        rows = list(packing.rows())
        part = folder / 'packing.txt.part'
        with open(part, 'w', encoding='utf-8') as out:
            out.write(f'# {packing}, {nx} x {ny} x {nz} times\n# cell 0 0 0 to {a * nx!r} {b * ny!r} {c * nz!r}, m\n')
            for i in range(nx):
                for j in range(ny):
                    for k in range(nz):
                        out.writelines(
                            f'{min(x + i * a, nx * a)!r} {min(y + j * b, ny * b)!r} {min(z + k * c, nz * c)!r} {r!r}\n'
                            for x, y, z, r in rows)
        part.rename(path)
    return read(path)


def dense(program, grains):
    """The packing of the dense box: diameters 0.25 … 0.75 mm in equal numbers, void ratio about 0.58, 150 kPa."""
    return made(program, 'dense', grains, UNIFORM, 0.59)


def wide(program, grains):
    """Diameters 0.25 … 2.5 mm, with equal mass in classes that grow by a constant factor."""
    return made(program, 'wide', grains, WIDE, 0.4)


def _fill(program, scene, settings):
    """Folder of the results of SCENE-fill.json with `settings`, run once; the folder is renamed when complete."""
    own, fill = PACK.with_name(f'{scene}.json'), PACK.with_name(f'{scene}-fill.json')
    digest = hashlib.sha256((fill.read_text() + own.read_text() + (json.dumps(settings) if settings else '')).encode()).hexdigest()[:8]
    folder = STORE / f'{scene}-{digest}'
    if not folder.is_dir():
        say(f'making {folder} …')
        part = folder.with_name(folder.name + '.part')
        grit.run(program, fill, part, threads=None, settings=settings)
        part.rename(folder)
    return folder


def filled(program, scene, settings=None):
    """The grains for bench/scenes/SCENE.json, made by SCENE-fill.json with `settings`."""
    return read(_fill(program, scene, settings or {}) / 'packing.txt')


class Flow(NamedTuple):
    """Grains in motion, as a data file of LAMMPS, which LIGGGHTS and grit read too."""
    path: Path
    grains: int
    radii: tuple  # smallest and mean [m]
    digest: str   # first letters of the file's SHA-256

    def __str__(self):
        return f'{self.path.parent.name} (sha256 {self.digest})'


def flowing(program, scene, settings=None):
    """The same as `filled`, with velocities and spins."""
    folder = _fill(program, scene, settings or {})
    data = folder / 'grains.data'
    given = json.loads(PACK.with_name(f'{scene}.json').read_text(encoding='utf-8'))
    sides = list(zip('xyz', given['domain']['low'], given['domain']['high']))
    # grit removes grains that have passed an open side at its next search; the other codes refuse them.
    grains = [one for one in _dumped(folder / 'frames' / '000000.dump')
              if all(low < float(one[axis]) < high for axis, low, high in sides)]
    if not data.is_file():
        part = folder / 'grains.data.part'
        with open(part, 'w', encoding='utf-8') as out:
            out.write(f'{scene}\n\n{len(grains)} atoms\n1 atom types\n\n')
            out.writelines(f'{low!r} {high!r} {axis}lo {axis}hi\n'
                           for axis, low, high in sides)
            density = given['materials']['sand']['density']
            out.write('\nAtoms\n\n')
            out.writelines(f"{i} 1 {2 * float(one['radius'])!r} {density!r} {one['x']} {one['y']} {one['z']}\n"
                           for i, one in enumerate(grains, 1))
            out.write('\nVelocities\n\n')
            out.writelines(' '.join([str(i), *(one[name] for name in ('vx', 'vy', 'vz', 'omegax', 'omegay', 'omegaz'))]) + '\n'
                           for i, one in enumerate(grains, 1))
        part.rename(data)
    radii = [float(one['radius']) for one in grains]
    return Flow(data, len(grains), (min(radii), statistics.mean(radii)),
                hashlib.sha256(data.read_bytes()).hexdigest()[:12])


def _dumped(path):
    """Grains of a dump as dictionaries of texts."""
    with open(path, encoding='utf-8') as lines:
        names = next(line for line in lines if line.startswith('ITEM: ATOMS')).split()[2:]
        return [dict(zip(names, line.split())) for line in lines]
