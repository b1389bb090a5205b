#!/usr/bin/env python3
"""Writes docs/stability.md and its maps: where methods fail, as the stability tests of a build find it.

  stability.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, and nothing is written

Maps are docs/stability/*.svg.
"""
import html
import math
import re
import sys

sys.dont_write_bytecode = True
import reported  # noqa: E402

MAPPED = 'mapped: '
COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#8a6d00', '#56b4e9']
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 830, 430, 78, 500, 30, 370

HEAD = '''# Where methods fail
Written by `scripts/stability.py` from what the tests in [tests/stability](../tests/stability) find. Do not edit. Each limit is looked for from both
sides; beside it stands what is predicted, and what grit does beyond it.

| what | predicted limit | what grit does there |
| --- | --- | --- |
| time step | 2/ω of the fastest mode, dashpots and spins included; bound by body ([definitions](definitions.md#time-step)) | refuses an explicit step above it; chooses 0.8 of the bound else; the energy guard trips where a scene defeats both |
| undamped collisions at a long step | the contact lasts π/(ω dt) steps: 2 at 0.8 of the critical step, and where in a step it begins is chance, so that each rebound is off by a share of the order of the step over the contact's time | nothing: energy is right in the mean of dense packings only. Take a safety of 0.1 or less where single collisions count; the `energy` probe tells |
| speed: tunnelling | a contact is missed when a step is longer than the sum of what lies on both sides of the middle: a diameter at a thin wall, both diameters at a grain | the travel guard stops at 0.05 radii a step, with body, time and advice |
| ratio of sizes | none: velocities and forces of both bodies are of the same instants | nothing to do |
| mixture of sizes | none: sizes are searched for class by class | nothing is missed at 1 : 100, counted at every step |
| inertia of clumps | 2/ω of a clump that is held at one end, ω² = k (1/m + a²/I) with a from its middle | reckons with mass and inertia; the bound is at most half too short |
| ratio of masses | Q_a + Q_b of the contact that asks most; light grains alone set it | the bound stays within 0.7 of the longest stable step |
| ratio of stiffnesses | springs in line: the soft one counts | the bound takes it that two of the stiffest may meet: too short by the root of the ratio where they never do. A stiff wall costs nothing with linear springs, which are the grain's |
| free wall | grain and wall swing together: less than 2 √(m/2k) of the grain between fixed walls and than 2 √(M/k) of the wall on a fixed grain; which, the eigenvalues of both say | adds what springs and dashpots ask of the wall to what they ask of the grains; refuses, chooses, guards as for the time step |
| servo | on a heavy specimen a gain of 2.07; on a stack the eigenvalues of grains, wall and delay: the lone grain is worst | takes no gain above 1; 0.8 of the critical step is stable with any gain. Above 0.82 of it a gain of 1 shakes a lone grain until the travel or overlap guard trips: take 0.8, or a gain of 0.3, which holds to 0.95 |
| overlap at the start | speeds of δ ω / 2: at 0.8 of the critical step 0.08 radii move a grain 0.05 radii in a step; below a safety of 0.25 the guard's own 0.2 radii | the overlap guard stops before the first step, the travel guard in it; what survives flies apart with the energy of its springs |
| friction on the edge | tan of the slope equal to the coefficient of friction, or of rolling resistance | sticks below without creep, slides above as Coulomb has it |
| short period | four times the largest radius and skin: below, one body would meet another twice | refuses before the first step, and stops a cell that shrinks to it, with length, limit and advice |
| fast grain among slow ones | a search when it has used up a skin of 100 steps, at least 0.03 and at most 0.4 mean diameters | seeks neighbours as often as that takes; no contact is missed |
| energy of impacts | what the parting step makes of it, (π/n)²/4 where the contact lasts n steps | nothing is gained beyond that at any angle, friction or restitution, at given steps and at those that grit chooses |
| springs that stiffen | those of the deepest contact, and of the deepest that an impact at the present speeds will make | sets the step anew when either has grown by a fifth, and an impact's before it begins: what is pressed from first touch on feels Hertz's force within 1 %, a packing that of a tenth of the step within 0.1 %, what falls or is poured gains no more than with linear springs. Not seen: a packing pressed less deep than some contact was before; a face-centred one (40 k_s/m against 7 of a pair) swung beside a lone grain that had been pressed deeper, for 2 % of the walls' work, until it was as deep itself. A safety of 0.4 is below that |

Guards run with every simulation. [false_alarms.cpp](../tests/stability/false_alarms.cpp) runs the quick column and oedometer to their ends, and the
quick direct shear, dense and loose, as boxes of 650 grains sheared by 0.1 mm: no guard trips. The quick descriptions that
[reproduction](reproduction.md) lists were run to their ends by `scripts/reproduce.py`; tests/sims runs all others for a while.

Where limits are looked for by halving, what is found is one limit. Two Hertz grains that begin inside each other have several, since
the step in which they are fastest is another one at another safety; their curve goes up and down, and nothing is predicted.

'''


def ticks(low, high):
    """Powers of ten, or 1, 2, 5 where there are few."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    leads = (1,) if last - first > 3 else (1, 2, 5)
    return [lead * 10.0 ** power for power in range(first, last + 1) for lead in leads
            if low * 0.999 <= lead * 10.0 ** power <= high * 1.001]


def picture(title, series):
    """Curves over logarithmic axes; those that are predicted are dashed and have no marks. Where there are more than
    colours, the others are dotted with open marks, so that no two look alike, and one below another shows."""
    y_title, x_title = title.split('|')
    points = [p for curve in series.values() for p in curve if p[1] > 0]
    own = [p for name, curve in series.items() if not name.startswith('predicted') or name.startswith('predicted bound')
           for p in curve if p[1] > 0]
    low_x, high_x = min(p[0] for p in points) / 1.15, max(p[0] for p in points) * 1.15
    low_y, high_y = min(p[1] for p in own) / 2, max(p[1] for p in own) * 2
    across = lambda x: LEFT + math.log(x / low_x) / math.log(high_x / low_x) * (RIGHT - LEFT)
    down = lambda y: BOTTOM - math.log(y / low_y) / math.log(high_y / low_y) * (BOTTOM - TOP)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">',
           f'<title>{html.escape(y_title)}</title>',
           '<style>text{font:12px "Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif;fill:#222}'
           '.m{text-anchor:middle}.e{text-anchor:end}.g{stroke:#e4e4e0}.f{stroke:#8a8a86}'
           '.c{fill:none;stroke-width:1.8}.o{stroke-dasharray:2 3}.p{fill:none;stroke:#8a8a86;stroke-dasharray:5 4}</style>',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
           f'<clipPath id="frame"><rect x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{BOTTOM - TOP}"/></clipPath>']
    for x in ticks(low_x, high_x):
        out.append(f'<line class="g" x1="{across(x):.1f}" x2="{across(x):.1f}" y1="{TOP}" y2="{BOTTOM}"/>'
                   f'<text class="m" x="{across(x):.1f}" y="{BOTTOM + 18}">{x:g}</text>')
    for y in ticks(low_y, high_y):
        out.append(f'<line class="g" y1="{down(y):.1f}" y2="{down(y):.1f}" x1="{LEFT}" x2="{RIGHT}"/>'
                   f'<text class="e" x="{LEFT - 8}" y="{down(y) + 4:.1f}">{y:g}</text>')
    out.append(f'<line class="f" x1="{LEFT}" x2="{RIGHT}" y1="{BOTTOM}" y2="{BOTTOM}"/>'
               f'<line class="f" x1="{LEFT}" x2="{LEFT}" y1="{TOP}" y2="{BOTTOM}"/>'
               f'<text x="{LEFT - 60}" y="{TOP - 12}">{html.escape(y_title)}</text>'
               f'<text class="m" x="{(LEFT + RIGHT) / 2}" y="{BOTTOM + 42}">{html.escape(x_title)}</text>')
    colour, row = 0, 0
    for name, curve in series.items():
        curve = sorted(set(p for p in curve if p[1] > 0))
        line = ' '.join(f'{across(x):.1f},{down(y):.1f}' for x, y in curve)
        predicted = name.startswith('predicted')
        tint, again = COLOURS[colour % len(COLOURS)], colour >= len(COLOURS)
        look = 'class="p"' if predicted else f'class="c{" o" if again else ""}" stroke="{tint}"'
        out.append(f'<polyline {look} clip-path="url(#frame)" points="{line}"/>')
        if not predicted:
            mark = f'r="5.5" fill="none" stroke="{tint}" stroke-width="1.4"' if again else f'r="3.5" fill="{tint}"'
            out += [f'<circle cx="{across(x):.1f}" cy="{down(y):.1f}" {mark}/>' for x, y in curve]
            colour += 1
        y = TOP + 14 + 20 * row
        out.append(f'<line {look} x1="{RIGHT + 16}" x2="{RIGHT + 40}" y1="{y - 4}" y2="{y - 4}"/>'
                   f'<text x="{RIGHT + 46}" y="{y}">{html.escape(name)}</text>')
        row += 1
    return '\n'.join(out + ['</svg>', ''])


def main():
    tests, maps = reported.tests('test_stability', 'docs/stability.md'), {}
    for _, properties in tests:
        for key, value in properties.items():
            if key.startswith(MAPPED):
                y_title, x_title, series, _ = key[len(MAPPED):].split('|')
                curves = maps.setdefault(f'{y_title}|{x_title}', {})
                curves.setdefault(series, []).append(tuple(map(float, value.split())))
    folder = reported.ROOT / 'docs' / 'stability'
    folder.mkdir(exist_ok=True)
    for old in folder.glob('*.svg'):
        old.unlink()
    text = HEAD
    for title, series in sorted(maps.items()):
        name = re.sub('[^a-z0-9]+', '-', title.split('|')[0].lower()).strip('-') + '.svg'
        (folder / name).write_text(picture(title, series), encoding='utf-8')
        text += f"## {title[0].upper()}{title.split('|')[0][1:]}\n![{title.split('|')[0]}](stability/{name})\n\n"
        what, along = title.split('|')[:2]
        text += f'<details><summary>figures</summary>\n\n| | {along} | {what} |\n| --- | --- | --- |\n'
        for one, curve in series.items():
            if not one.startswith('predicted') or len(set(curve)) == 1:
                text += ''.join(f'| {one} | {x:g} | {y:.3g} |\n' for x, y in sorted(set(curve)))
        text += '\n</details>\n\n'
    text += '## What is tested\n' + ''.join(f'- {name}\n' for name in sorted(name for name, _ in tests))
    (reported.ROOT / 'docs' / 'stability.md').write_text(text, encoding='utf-8')
    print(f'docs/stability.md: {len(tests)} tests, {len(maps)} maps')


main()
