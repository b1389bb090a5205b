"""Bounds and goals, as in docs/evidence/performance.md."""

# Speed of grit over that of another code: (law, grains, threads, code) → (bound, goal)
RATIOS = {
    ('rolling', 10000, 1, 'liggghts'): (4.5, 6),
    ('rolling', 10000, 1, 'lammps'): (4.5, 6),
    ('rolling', 10000, 1, 'yade'): (25, None),
    ('rolling', 50000, 1, 'liggghts'): (4, 6),
    ('rolling', 50000, 1, 'lammps'): (4, 6),
    ('no-rolling', 50000, 1, 'lammps'): (2.5, 4),
    ('hertz', 10000, 1, 'lammps'): (3, 5),
    ('hertz', 50000, 1, 'lammps'): (3, 5),
}

# The same of a flow: (scene, threads) → (bound, goal), against any code
FLOWS = {('drum', 1): (4, 5), ('silo', 1): (4, 5)}


def ratio(scene, law, grains, threads, code):
    """Bound and goal, None without."""
    return RATIOS.get((law, grains, threads, code), (None, None)) if scene == 'dense' else FLOWS.get((scene, threads), (None, None))


MISSES = '**misses**'


def verdict(figure, promised, wanted, at_most=False):
    """A text: whether a value meets its bound and goal; at_most: they are upper limits."""
    if promised is None:
        return ''
    holds = (lambda bound: figure <= bound) if at_most else (lambda bound: figure >= bound)
    if wanted is not None and holds(wanted):
        return 'as wanted'
    return 'holds' if holds(promised) else MISSES


def in_words(promised, wanted, at_most=False):
    if promised is None:
        return ''
    sign = '≤' if at_most else '≥'
    return f'{sign} {promised:g}' + (f', wanted {wanted:g}' if wanted is not None else '')
