#!/usr/bin/env python3
"""Measures discharge rates through round holes and slots and compares them with Beverloo's law: writes docs/evidence/beverloo.md.

  beverloo.py [BUILD]      BUILD is build unless given; runs are in results/beverloo; finished ones are not run again

Runs of sims/beverloo, a minute or two each on one core, one after the other. Needs python3-h5py.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[1]
# Diameter or width [mm]; side of the bin [mm], number of grains, height of their cloud [mm], discharged fraction, samples.
OUTLETS = {'hole': ((8, 24, 21100, 55, 0.12, 2), (10, 26, 24800, 55, 0.18, 2), (12, 28, 28700, 55, 0.25, 2), (16, 32, 46900, 69, 0.3, 2)),
           'slot': ((8, 38, 19600, 77, 0.25, 2), (12, 42, 21700, 77, 0.35, 2), (16, 46, 26400, 86, 0.38, 2), (24, 54, 41000, 113, 0.4, 2))}
EXPONENTS = {'hole': 2.5, 'slot': 1.5}
BOUND = 0.1
BEVERLOO = 1.4                                           # his own k
STEADY_FROM = 0.25                                       # of the discharged mass

HEAD = '''# Beverloo's law
Written by `scripts/beverloo.py` from runs of [sims/beverloo](../../sims/beverloo). Do not edit.

'''
SETUP = '''
## Setup
- Grains have diameters of 0.9 to 1.1 mm (d = 1 mm), friction of 25° and no rolling resistance.
- The bin is flat-bottomed. The outlet is a round hole, or a slot that is periodic over 10 mm.
- The bin is wider than a slot by 30 d, as Nedderman recommends, and wider than a hole by 16 d.
- It is filled to the larger of 45 d and 2.7 slot widths, or of 32 d and 2.5 hole diameters.
- A rate is the slope of the discharged mass, without the first quarter. Each sample has its own.

'''


def settings(kind, outlet, seed):
    size, side, count, height, fraction, _ = outlet
    half, edge, over, gate = (f'{1e-3 * x:.9g}' for x in (0.5 * size, 0.5 * side, 0.5 * side + 2, 0.5 * size + 2))
    length = f'{1e-3 * (size + 4):.9g}'
    of = [f'/domain/low/0=-{over}', f'/bodies/sand/source/low/0=-{edge}', f'/bodies/sand/source/high/0={edge}',
          f'/walls/left/point/0=-{edge}', f'/walls/right/point/0={edge}', f'/walls/gate/corner/0=-{gate}',
          f'/walls/gate/edge_a/0={length}', f'/bodies/sand/source/high/2={1e-3 * height:.9g}',
          f'/bodies/sand/source/count={count}', f'/stages/1/until/fraction={fraction:g}', f'/seed={seed}']
    if kind == 'hole':
        return of + [f'/domain/low/1=-{over}', f'/domain/high=[{over},{over},0.2]', f'/bodies/sand/source/low/1=-{edge}',
                     f'/bodies/sand/source/high/1={edge}', f'/walls/front/point/1=-{edge}', f'/walls/back/point/1={edge}',
                     f'/walls/gate/corner/1=-{gate}', f'/walls/gate/edge_b/1={length}', f'/walls/bottom/start_radius={half}',
                     f'/walls/bottom/end_radius={0.75e-3 * side:.9g}']
    beyond = 0.5 * side + 5                              # where the bottom ends
    return of + [f'/domain/high/0={over}', f'/walls/bottom-left/corner/0=-{1e-3 * beyond:.9g}', f'/walls/bottom-right/corner/0={half}',
                 *(f'/walls/bottom-{side_of}/edge_a/0={1e-3 * (beyond - 0.5 * size):.9g}' for side_of in ('left', 'right'))]


def run(grit, kind, outlet, seed):
    """The results folder of one outlet."""
    folder = ROOT / 'results' / 'beverloo' / f'{kind}-{outlet[0]}-{seed}'
    try:
        if json.loads((folder / 'run.json').read_text())['status'] == 'done':
            return folder
    except FileNotFoundError:
        pass
    sets = [word for one in settings(kind, outlet, seed) for word in ('--set', one)]
    subprocess.run([grit, 'run', ROOT / 'sims' / 'beverloo' / f'{kind}.json', '--threads', '1', '--overwrite', '--no-report', '--out',
                    folder, *sets], check=True)
    return folder


def line(points):
    """(slope, intercept, standard error of the slope, residual sum of squares) of the least-squares line through points."""
    n = len(points)
    x, y = (sum(p[k] for p in points) / n for k in (0, 1))
    spread = sum((p[0] - x) ** 2 for p in points)
    slope = sum((p[0] - x) * (p[1] - y) for p in points) / spread
    residual = sum((p[1] - y - slope * (p[0] - x)) ** 2 for p in points)
    return slope, y - slope * x, math.sqrt(residual / (n - 2) / spread), residual


def rate(folder):
    """Steady rate of discharge [g/s]."""
    import h5py
    with h5py.File(folder / 'series.h5') as series:
        flow = {name: series['flow'][name][:] for name in ('time', 'mass')}
    return 1e3 * line([(t, m) for t, m in zip(flow['time'], flow['mass']) if m > STEADY_FROM * flow['mass'][-1]])[0]


def logs(rates, k):
    """Points (ln(D − k d), ln W), d = 1 mm."""
    return [(math.log(size - k), math.log(w)) for size, w in rates]


def misfit(found, k):
    """Sum of squared errors of Beverloo's law with his exponents and a separate constant for each kind of outlet."""
    total = 0
    for kind, rates in found.items():
        constants = [y - EXPONENTS[kind] * x for x, y in logs(rates, k)]
        mean = sum(constants) / len(constants)
        total += sum((one - mean) ** 2 for one in constants)
    return total


CANDIDATES = [0.01 * n for n in range(0, 500)]           # k


def best_k(found):
    """The k with which his law fits the rates of all outlets best."""
    return min(CANDIDATES, key=lambda k: misfit(found, k))


def best_of_both(rates):
    """The free k and n that fit the rates of one kind best."""
    k = min(CANDIDATES, key=lambda k: line(logs(rates, k))[3])
    return k, line(logs(rates, k))[0]


def verdict(kind, n):
    return 'holds' if abs(n - EXPONENTS[kind]) <= BOUND else 'misses'


def exponent(found, kind, k):
    """The exponent of one kind at a given k, and whether the law holds, as text."""
    n, _, error, _ = line(logs(found[kind], k))
    return f'{n:.2f} ± {error:.3f}', verdict(kind, n)


def page(found):
    fitted = best_k(found)
    sizes = {kind: {size: [w for s, w in rates if s == size] for size, _ in rates} for kind, rates in found.items()}
    (holes, holes_hold), (slots, slots_hold) = (exponent(found, kind, fitted) for kind in ('hole', 'slot'))
    text = (f"**Summary.** Rates of discharge follow W = C (D − k d)^n with k = {fitted:.2f}, n = {holes} for holes (law: 2.5, {holes_hold})\n"
            f"and n = {slots} for slots (law: 1.5, {slots_hold}). An exponent holds if it is within {BOUND} of the law's.\n")
    text += SETUP + '## Rates\n| outlet | D/d | rate, g/s | law with k = %.2f |\n| --- | --- | --- | --- |\n' % fitted
    for kind, of_size in sizes.items():
        constant = sum(y - EXPONENTS[kind] * x for x, y in logs(found[kind], fitted)) / len(found[kind])
        for size, samples in of_size.items():
            law = math.exp(constant) * (size - fitted) ** EXPONENTS[kind]
            text += f'| {kind} | {size} | {", ".join(f"{one:.2f}" for one in samples)} | {law:.2f} |\n'
    text += ('\n## Exponents\n'
             f'k = {fitted:.2f} is fitted to all outlets, with the exponents of the law and a constant C for each kind (least squares of ln W).\n'
             'The exponents below are fitted to each kind at a given k. ± is the standard error of that fit.\n\n'
             '| k | holes, 2.5 ± 0.1 | | slots, 1.5 ± 0.1 | |\n| --- | --- | --- | --- | --- |\n')
    for k, name in ((fitted, 'fitted'), (BEVERLOO, "Beverloo's"), (1.6, ''), (1.8, ''), (2.0, ''), (2.4, '')):
        text += f'| {k:.2f}{", " + name if name else ""} | {" | ".join(word for kind in ("hole", "slot") for word in exponent(found, kind, k))} |\n'
    text += '\nThis k is biased towards the exponents of the law. A k that was fitted to the other kind alone is not:\n\n'
    for kind, other in (('slot', 'hole'), ('hole', 'slot')):
        k = best_k({other: found[other]})
        text += f'- k = {k:.2f} from {other}s: exponent of {kind}s {", ".join(exponent(found, kind, k))}\n'
    free = ', '.join(f'k = {k:.2f} and n = {n:.2f} for {kind}s' for kind, (k, n) in
                     ((kind, best_of_both(rates)) for kind, rates in found.items()))
    return text + f'\nWith k and n both free, and each kind fitted alone: {free}.\n'


def main():
    grit = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / 'build').resolve() / 'bin' / 'grit'
    found = {kind: [(outlet[0], rate(run(grit, kind, outlet, seed))) for outlet in outlets for seed in range(1, outlet[-1] + 1)]
             for kind, outlets in OUTLETS.items()}
    text = HEAD + page(found)
    (ROOT / 'docs' / 'evidence' / 'beverloo.md').write_text(text, encoding='utf-8')
    print(text)


if __name__ == '__main__':
    main()
