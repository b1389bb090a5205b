#!/usr/bin/env python3
"""Writes docs/stability.md and its maps: where methods fail, as the stability tests of a build find it.

  stability.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, or tells a figure of the table
                            no more, and nothing is written

Maps are docs/stability/*.svg.
"""
import html
import json
import math
import re
import sys

sys.dont_write_bytecode = True
import reported  # noqa: E402

MAPPED, FIGURE = 'mapped: ', 'figure: '
COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#8a6d00', '#56b4e9']
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 830, 430, 78, 500, 30, 370

# Why a description of sims/ has guards of its own.
WHY = {
    'beverloo/slot': 'room alone, for soft grains that fall: it fills with the usual guard too, and begins to flow',
    'direct-shear/full-500kPa-e060': 'as in the small box under as much; the largest overlap was 50 µm',
    'direct-shear/quick-500kPa': 'under so much a grain at the edges of the frames is pinched by a fifth of its radius and more',
    'interface-shear/base': 'the end wall that drives the sand wedges single grains against the teeth, with ninety times the mean force',
    'interface-shear/full-rn-025': 'a small grain between a tooth and a large one jumps out at 0.054 of its radius in a step when it slips off',
    'interface-shear/quick-rn-100': 'a grain may for an instant be pinched between a flank and the sand, by up to 0.3 of the smallest radius',
    'round-silo/quick': 'room alone, for soft grains that fall: it ends as well with the usual guard',
    'studies/direct-shear': 'in the gap between the frames of so small a box a grain or two is pinched by a fifth of its radius and more',
    'studies/triaxial': 'soft grains, of 20 MPa, overlap more; those that only harden still stop there in two of three samples',
    'triaxial/base': 'of so few grains one may be pinched by a third of its radius, and leaves at a tenth of it in a step when it slips out',
}

# Where a figure stands, {its name:its format}: tests tell it (figure() of tests/support/mapped.hpp).
HEAD = '''# Where methods fail
Written by `scripts/stability.py` from what the tests in [tests/stability](../tests/stability) find. Do not edit. Each limit is looked for from both
sides; beside it stands what is predicted, and what grit does beyond it.

| what | predicted limit | what grit does there |
| --- | --- | --- |
| time step | 2/ω of the fastest mode, dashpots and spins included; bound by body ([definitions](definitions.md#time-step)) | refuses an explicit step above it; chooses {share of the bound that is chosen:.2g} of the bound else, or what impacts ask for where that is shorter; beyond both nothing is certain. **With an `energy` probe** in the stage the energy guard trips once an instability has made more than its share, also where it is dissipated again. **Without**, it sees what grows faster than contacts and local damping take it: 300 grains under gravity with a restitution of 0.5 and a local damping of 0.3 at 1.8 times the bound (`allow_unstable`) ended with exit status 0, shivering, and with the probe with 4, after 2 ms (taken once) |
| energy of impacts | what the parting step makes of it, (π/n)²/4 where the contact lasts n steps; where in a step it begins is chance. In the mean of all parts of a step an impact gains, (π/n)⁴/90 of its energy with linear springs and 1.3/n⁵ with Hertz's ([many_impacts.cpp](../tests/stability/many_impacts.cpp)): leap-frog keeps volumes of phase space, so that what scatters must grow | nothing is gained beyond that at a plane, at any angle, friction or restitution. At the step that grit chooses, an impact of two that are alone takes {pair, least steps of an impact at the chosen step:.3g} steps or more with linear springs. With friction it gains, with any springs, at most {pair, most that an impact gains at the chosen step:.1%} of its energy where the two are alike, and {two sizes, most that an impact gains at the chosen step:.1%} where their sizes differ, at 1 : 10 of those tried. Where single impacts count, take a tenth of the critical step: their velocities are off by {error of an oblique collision at a tenth of the critical step, of its speed:.1%} of the speed; the `energy` probe tells. **Many impacts at a restitution of 1 heat**: mean gains of impacts of seven steps or more are within {mean gain of impacts of seven steps or more, distance from what is predicted, of it:.0%} of what is predicted, and the energy of a gas grows by {growth of the energy of a gas over what its impacts are predicted to gain, linear-frictional:.2f} ± {chance in that, linear-frictional:.2f} (linear) and {growth of the energy of a gas over what its impacts are predicted to gain, hertz-mindlin:.2f} ± {chance in that, hertz-mindlin:.2f} (Hertz) times their sum. See [many impacts](#many-impacts) for what to choose |
| speed: tunnelling | a contact is missed when a step is longer than the sum of what lies on both sides of the middle: a diameter at a thin wall, both diameters at a grain | the travel guard stops at {way in a step that the travel guard allows, in radii:.2g} radii a step, with body, time and advice |
| ratio of sizes | none: velocities and forces of both bodies are of the same instants | none sticks up to 1 : 100, and rebounds at the step that grit chooses are off by at most {error of the rebound of two sizes at the chosen step:.2g} of the speed |
| mixture of sizes | none: sizes are searched for class by class | nothing is missed at 1 : {ratio of sizes up to which no contact is missed:.0f}, counted at every step |
| inertia of clumps | 2/ω of a clump that is held at one end, ω² = k (1/m + a²/I) with a from its middle | reckons with mass and inertia; the bound is {bound of a clump over its longest stable step, at least:.2g} of the longest stable step or more |
| ratio of masses | Q_a + Q_b of the contact that asks most; light grains alone set it | the bound is {bound over the longest stable step, of heavier grains among light ones, at least:.2g} of the longest stable step or more |
| ratio of stiffnesses | springs in line: the soft one counts | the bound takes it that two of the stiffest may meet: too short by the root of the ratio where they never do, {bound over the longest stable step, of grains 1e4 times as stiff among others:.2g} of the longest stable step at a ratio of 10⁴. A stiff wall costs nothing: {bound over the longest stable step, of a grain between stiffer plates, at least:.2g} or more |
| free wall | grain and wall swing together: less than 2 √(m/2k) of the grain between fixed walls and than 2 √(M/k) of the wall on a fixed grain; which, the eigenvalues of both say | adds what springs and dashpots ask of the wall to what they ask of the grains: {bound over the longest stable step, of a free wall, at least:.2g} of the longest stable step or more; refuses, chooses, guards as for the time step |
| servo | on a heavy specimen a gain of {gain that a servo on a heavy specimen may have:.3g}; on a stack, with and without dashpots, the eigenvalues of grains, wall and delay: the lone grain is worst | takes no gain above {gain of a servo that is taken:.2g}; {share of the bound that is chosen:.2g} of the critical step is stable with any gain. Above {stable step over the critical one, of a servo of gain 1:.2g} of it a gain of 1 shakes a lone grain until the travel or overlap guard trips: take less, or a gain of 0.3, which holds to {stable step over the critical one, of a servo of gain 0.3:.2g}. Where contacts damp it moves more slowly, as if their dashpots were three times what they are, and is stable to {stable step over the critical one, of a servo on dashpots:.2g} or more at restitutions of 0.05 … 0.95 |
| servo that closes | n grains of stiffness k and one height bear n k v dt after the step in which a wall comes to touch them at `max_velocity` v: more than the force F that it keeps where v is above F / (n k dt) | brakes before: it goes no further in a step than to where they bear what is wanting of F, or a quarter of F. With one grain, 16, even and uneven, and 25 of which one stands out, with springs of both kinds and dashpots, and v dt k / F from 0.03 to 300, it pressed with {peak of the force of a servo that closes, over the one that it keeps:.2g} F at most; where all would bear less after a whole step it closes as fast as it may. Dashpots count by how fast grains and wall near each other: a lid of 5 kPa that drives loose grains of 20 MPa and a restitution of 0.4 before it at 0.5 m/s does so steadily. At 1.5 m/s, or at a restitution of 0.1, it goes by fits and starts, of which dashpots, half a step late, lose more than it puts in, and the energy guard may stop it: a `max_velocity` of 0.1 m/s cures that. The travel guard stops a wall whose way in a step is more than {way in a step that the travel guard allows, in radii:.2g} radii of the smallest |
| overlap at the start | speeds of δ ω / 2: at 0.8 of the critical step {deepest start that survives at 0.8 of the critical step, in radii:.2g} radii move a grain {way in a step that the travel guard allows, in radii:.2g} radii in a step; at a quarter of it or less the overlap guard's own {deepest start that survives at most, in radii:.2g} radii | the overlap guard stops before the first step, the travel guard in it; what survives flies apart with the energy of its springs |
| friction on the edge | tan of the slope equal to the coefficient of friction, or of rolling resistance | sticks below without creep, slides above as Coulomb has it, at {distance from the limit of friction, of it:.1%} from the limit too |
| short period | {shortest period over the largest radius and skin:.2g} times the largest radius and skin: below, one body would meet another twice | refuses before the first step, and stops a cell that shrinks to it, with length, limit and advice |
| fast grain among slow ones | a search when it has used up a skin of {steps that a skin lasts:.0f} steps, at least {least skin, in mean diameters:.2g} and at most {most skin, in mean diameters:.2g} mean diameters | seeks neighbours as often as that takes; no contact is missed |
| springs that stiffen | those of the deepest contact, and of the deepest that an impact at the present speeds will make | sets the step anew as either grows, and an impact's before it begins: what is pressed from first touch on feels Hertz's force within {error of the force of what is pressed from first touch on:.1%}, a packing that of a tenth of the step within {error of the force of a packing that is pressed:.2%}; what falls rises by at most {height that is gained by a fall:.1%} of its height more than restitution says, and the ledger of what is poured closes within {closure error of what is poured:.1%}. Not seen: a packing pressed less deep than some contact was before, until it is as deep itself |

Guards run with every simulation. [false_alarms.cpp](../tests/stability/false_alarms.cpp) runs the quick column and oedometer to their ends, and the
quick direct shear, dense and loose, as boxes of some {grains in the box that is sheared:.0f} grains sheared by {way that the box is sheared, in mm:.2g} mm: no guard trips. tests/sims runs every
quick description for a while at each change. To their ends ran, and no guard tripped, all quick ones and those full ones that [reproduction](reproduction.md) has figures of, by
`scripts/reproduce.py`, and those of [Beverloo's law](beverloo.md), by `scripts/beverloo.py`. The other full ones were not: they are listed there, as not run or as timed for a while.

These descriptions have guards of their own, and what extends them has theirs; all others run with the usual ones, an overlap of {overlap that the usual guard allows, in radii:.2g} of the
smaller radius and a way of {way in a step that the travel guard allows, in radii:.2g} of a radius in a step, but for the plane silos, whose scenario lets grains
that are thrown up go as far as [they may](../plugins/scenarios/silo.md#filling), 0.14 of the smallest radius in the full ones:

| description | guards | why |
| --- | --- | --- |
{own guards}

## Many impacts
Where nothing damps, each grain's N impacts add some N/3 mean gains to its energy: an impact's energy is, in the mean, two thirds of a grain's, and two share what it
gains. For N impacts to add no more than 1 %,

- **linear springs** want `steps_per_impact` of 3 N^¼: 17 for a thousand impacts of each grain, 53 for a hundred thousand. The usual 7 allow some thirty in the worst case. Two alike are better
  off by far: their impact takes so nearly 7 steps that it ends as it began, and gains {mean gain of a frictionless impact at the usual safety, linear-frictional:.1g} in the mean; grains of several sizes are not.
- **`hertz-mindlin`** wants a `safety` of 0.9 N^-⅕: 0.22 for a thousand, 0.09 for a hundred thousand. `steps_per_impact` does next to nothing there, as it goes by the stiffness at
  first touch, which is next to none. Without friction an impact of the fastest takes {steps of a frictionless impact at the usual safety, hertz-mindlin:.2g} steps at the usual safety, and gains {mean gain of a frictionless impact at the usual safety, hertz-mindlin:.1%} in the mean and {most that a frictionless impact gains at the usual safety, hertz-mindlin:.0%} at most; slower ones take more
  steps, by the fifth root of their speed, and gain less. Of 216 such grains at 0.3 m/s, which hit each other some four hundred times in a second, the energy grew by 9 % in it at
  the usual safety, and by 0.2 % at 0.27 (taken once).

Restitutions of 0.99 or less take more out of an impact than a step of 7 or more to it puts in. Friction takes out too.

## Order in the time step
Slopes of least-squares lines through the errors of an oblique collision [below](#error-of-an-oblique-collision-over-its-speed), where they are straight. The middle of a smooth contact is of second order
([validation](validation.md), Collision.ErrorIsOfSecondOrderInTheStep); tests allow 0.2.

| law | predicted | found | of first order is |
| --- | --- | --- | --- |
| linear-frictional, slides at first | 2 | {order, linear-frictional, slides at first:.2f} | nothing |
| linear-frictional | 1 | {order, linear-frictional:.2f} | the shear spring's first step, stretched as if it touched all the time; little, and seen in short steps alone, since κ = 0.3 is near 2/7 |
| linear-frictional, restitution 0.5 | 1 | {order, linear-frictional, restitution 0.5:.2f} | dashpots, which see velocities half a step old |
| linear-rolling | 1 | {order, linear-rolling:.2f} | the rolling spring's first step |
| hertz-mindlin | 1 | {order, hertz-mindlin:.2f} | the shear spring, as stiff in a step as at its end |
| hertz-mindlin, restitution 0.5 | 1 | {order, hertz-mindlin, restitution 0.5:.2f} | both |

## What the energy guard does not see
It looks now and then, not at every step, and trips at gains alone: a loss of any size passes. Each stage, and each change of a ramp, starts
its account anew.

- **Without an `energy` probe** it holds what is stored against the work of walls, so that dissipation hides as much as it takes. It does not
  look where bodies grow, a cell deforms, bodies are held, engines push them, or gravity acts along a periodic axis.
- **With one**, from its first sample on, it takes the error of the ledger's closure, and its limit is a share of the largest energy and of what was
  dissipated. All of these are reckoned with. A ledger is kept only where a description asks for the probe, as a quick one of each
  test does; its README says what it costs.
- **It may also take for wrong what is known**: shear of deep contacts along curved walls and edges (see the [probe](../plugins/probes/energy/README.md)), and [many impacts](#many-impacts) without damping,
  which heat, with friction too. Over long times such a scene may trip it: take a shorter step there, or something that dissipates.

## Limits found by halving
Where limits are looked for by halving, what is found is one limit. Two Hertz grains that begin inside each other have several, since
the step in which they are fastest is another one at another safety; their curve goes up and down, and nothing is predicted.

'''


class Axis:
    """Along one of the picture's sides: logarithmic, but linear where values span less than a decade, so that small
    differences show, or are angles."""

    def __init__(self, values, title, margin, begin, end):
        low, high = min(values), max(values)
        self.linear = '°' in title or 'degrees' in title or low > 0.1 * high
        self.begin, self.end = begin, end
        if self.linear:
            room = 0.05 * (high - low) or 0.5 * abs(high) or 1
            self.low, self.high = low - room, high + room
        else:
            self.low, self.high = low / margin, high * margin

    def place(self, value):
        along = ((value - self.low) / (self.high - self.low) if self.linear else
                 math.log(value / self.low) / math.log(self.high / self.low))
        return self.begin + along * (self.end - self.begin)

    def ticks(self):
        """Powers of ten, or 1, 2, 5 where there are few; steps of 1, 2 or 5 where it is linear."""
        if self.linear:
            power = 10.0 ** math.floor(math.log10((self.high - self.low) / 4))
            step = next(lead * power for lead in (1, 2, 5, 10) if (self.high - self.low) / (lead * power) <= 6)
            return [round(k * step, 12) for k in range(math.ceil(self.low / step), math.floor(self.high / step) + 1)]
        first, last = math.floor(math.log10(self.low)), math.ceil(math.log10(self.high))
        leads = (1,) if last - first > 3 else (1, 2, 5)
        return [lead * 10.0 ** power for power in range(first, last + 1) for lead in leads
                if self.low * 0.999 <= lead * 10.0 ** power <= self.high * 1.001]


def picture(title, series):
    """Curves, each thinner than the one before, so that one below another shows. Those that are predicted are dashed and
    have no marks; they have the colour of what was found of the same name."""
    y_title, x_title = title.split('|')
    points = [p for curve in series.values() for p in curve if p[1] > 0]
    own = [p for name, curve in series.items() if not name.startswith('predicted') or name.startswith('predicted bound')
           for p in curve if p[1] > 0]
    x_axis = Axis([p[0] for p in points], x_title, 1.15, LEFT, RIGHT)
    y_axis = Axis([p[1] for p in own], y_title, 2, BOTTOM, TOP)
    across, down = x_axis.place, y_axis.place
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">',
           f'<title>{html.escape(y_title)}</title>',
           '<style>text{font:12px "Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif;fill:#222}'
           '.m{text-anchor:middle}.e{text-anchor:end}.g{stroke:#e4e4e0}.f{stroke:#8a8a86}'
           '.c{fill:none}.o{stroke-dasharray:2 3}.p{fill:none;stroke-dasharray:5 4}</style>',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
           f'<clipPath id="frame"><rect x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{BOTTOM - TOP}"/></clipPath>']
    for x in x_axis.ticks():
        out.append(f'<line class="g" x1="{across(x):.1f}" x2="{across(x):.1f}" y1="{TOP}" y2="{BOTTOM}"/>'
                   f'<text class="m" x="{across(x):.1f}" y="{BOTTOM + 18}">{x:g}</text>')
    for y in y_axis.ticks():
        out.append(f'<line class="g" y1="{down(y):.1f}" y2="{down(y):.1f}" x1="{LEFT}" x2="{RIGHT}"/>'
                   f'<text class="e" x="{LEFT - 8}" y="{down(y) + 4:.1f}">{y:g}</text>')
    out.append(f'<line class="f" x1="{LEFT}" x2="{RIGHT}" y1="{BOTTOM}" y2="{BOTTOM}"/>'
               f'<line class="f" x1="{LEFT}" x2="{LEFT}" y1="{TOP}" y2="{BOTTOM}"/>'
               f'<text x="{LEFT - 60}" y="{TOP - 12}">{html.escape(y_title)}</text>'
               f'<text class="m" x="{(LEFT + RIGHT) / 2}" y="{BOTTOM + 42}">{html.escape(x_title)}</text>')
    found = [name for name in series if not name.startswith('predicted')]
    tints = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(found)}
    for row, (name, curve) in enumerate(series.items()):
        curve = sorted(set(p for p in curve if p[1] > 0))
        line = ' '.join(f'{across(x):.1f},{down(y):.1f}' for x, y in curve)
        tint = tints.get(name.removeprefix('predicted').lstrip(', '), '#8a8a86')
        if name in found:
            order = found.index(name)
            size, dots = max(2.5, 7 - 1.2 * order), order >= len(COLOURS)
            look = f'class="c{" o" if dots else ""}" stroke="{tint}" stroke-width="{0.6 * size:.1f}"'
            mark = f'fill="none" stroke="{tint}" stroke-width="1.4"' if dots else f'fill="{tint}"'
            marks = [f'<circle cx="{across(x):.1f}" cy="{down(y):.1f}" r="{size:.1f}" {mark}/>' for x, y in curve]
        else:
            look, marks = f'class="p" stroke="{tint}"', []
        out += [f'<polyline {look} clip-path="url(#frame)" points="{line}"/>'] + marks
        y = TOP + 14 + 20 * row
        out.append(f'<line {look} x1="{RIGHT + 16}" x2="{RIGHT + 40}" y1="{y - 4}" y2="{y - 4}"/>'
                   f'<text x="{RIGHT + 46}" y="{y}">{html.escape(name)}</text>')
    return '\n'.join(out + ['</svg>', ''])


def filled(text, figures):
    """Ends the process where the tests tell no figure of such a name."""
    place = re.compile('{([^{}:]+):([^{}:]+)}')
    missing = sorted({name for name, _ in place.findall(text) if name not in figures})
    if missing:
        print('docs/stability.md is as it was: no test tells\n' + '\n'.join(missing), file=sys.stderr)
        sys.exit(1)
    return place.sub(lambda found: format(figures[found[1]], found[2]), text)


def own_guards():
    """Rows of the descriptions and studies that set guards themselves. Ends the process where one is not told why, or one
    that is told of sets none."""
    sims, rows = reported.ROOT / 'sims', {}
    for file in sorted(sims.glob('*/*.json')):
        scene = json.loads(file.read_text(encoding='utf-8'))
        own = {f'/guards/{name}': value for name, value in scene.get('guards', {}).items()}
        own |= {pointer: value for pointer, value in scene.get('set', {}).items() if pointer.startswith('/guards/')}
        if own:
            name = file.relative_to(sims).with_suffix('').as_posix()
            values = ', '.join(f"{pointer.split('/')[-1]} {value:g}" for pointer, value in own.items())
            rows[name] = f'| [{name}](../sims/{name}.json) | {values} | {WHY.get(name)} |'
    if rows.keys() != WHY.keys():
        print(f'docs/stability.md is as it was: WHY is wrong about {sorted(rows.keys() ^ WHY.keys())}', file=sys.stderr)
        sys.exit(1)
    return '\n'.join(rows.values())


def main():
    tests, maps, figures = reported.tests('test_stability', 'docs/stability.md'), {}, {}
    for _, properties in tests:
        for key, value in properties.items():
            if key.startswith(FIGURE):
                figures[key[len(FIGURE):]] = max(float(value), figures.get(key[len(FIGURE):], -math.inf))
            if key.startswith(MAPPED):
                y_title, x_title, series, _ = key[len(MAPPED):].split('|')
                curves = maps.setdefault(f'{y_title}|{x_title}', {})
                curves.setdefault(series, []).append(tuple(map(float, value.split())))
    text = filled(HEAD.replace('{own guards}', own_guards()), figures)
    folder = reported.ROOT / 'docs' / 'stability'
    folder.mkdir(exist_ok=True)
    for old in folder.glob('*.svg'):
        old.unlink()
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
