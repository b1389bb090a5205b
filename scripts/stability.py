#!/usr/bin/env python3
"""Writes docs/evidence/stability.md and its maps: limits of the numerical methods, as found by the stability tests of a build.

  stability.py [BUILD]      BUILD is build unless given; exit status 1, and nothing written, if a test fails or does not
                            report a figure of the page

Maps are docs/evidence/stability/*.svg, with their numbers as *.csv.
"""
import csv
import html
import io
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
    'beverloo/slot': 'soft grains in free fall; the default guard passes as well, up to the onset of flow',
    'direct-shear/full-500kPa-e060': 'as in the small box at 500 kPa; the largest overlap was 50 µm',
    'direct-shear/quick-500kPa': 'a grain at the edges of the frames is pinched by a fifth of its radius or more',
    'interface-shear/base': 'the driving end wall wedges single grains against the teeth, with 90 times the mean force',
    'interface-shear/full-rn-025': 'a small grain between a tooth and a large grain slips off at 0.054 of its radius per step',
    'interface-shear/quick-rn-100': 'a grain is briefly pinched between a flank and the sand, by up to 0.3 of the smallest radius',
    'round-silo/quick': 'soft grains in free fall; the default guard passes as well',
    'studies/direct-shear': 'in the gap of so small a box one or two grains are pinched by a fifth of their radius or more',
    'studies/triaxial': 'contacts of 20 MPa overlap more; the hardening specimen still stops there in two of three samples',
    'triaxial/base': 'in so small a cell one grain may be pinched by a third of its radius, and leaves at a tenth of it per step',
}

# Figures are placeholders {name:format}; tests report them with figure() of tests/support/mapped.hpp.
HEAD = '''# Stability
Written by `scripts/stability.py` from the {tests} tests in [tests/stability](../../tests/stability). Do not edit.

**Summary.** Each numerical method was pushed until it failed. Each limit was approached from both sides and compared with a prediction.

| method | predicted limit | result |
| --- | --- | --- |
| [time step](#time-step) | 2/ω of the fastest mode | the bound is safe; grit takes {share of the bound that is chosen:.2g} of it |
| [impacts](#impacts) | energy error (π/n)²/4 for n steps | at most {two sizes, most that an impact gains at the chosen step:.1%} energy gain at the chosen step |
| [many impacts](#many-impacts) | mean gain (π/n)⁴/90 | found within {mean gain of impacts of seven steps or more, distance from what is predicted, of it:.0%} of it |
| [tunnelling](#speed) | one diameter per step at a thin wall | the travel guard stops at {way in a step that the travel guard allows, in radii:.2g} radii |
| [size, mass, stiffness ratios](#ratios) | none | bound safe at all ratios; conservative for mixed stiffness |
| [servo](#servo) | gain of {gain that a servo on a heavy specimen may have:.3g} | larger gains than {gain of a servo that is taken:.2g} are refused |
| [initial overlap](#initial-overlap) | guard of {deepest start that survives at most, in radii:.2g} radii | the overlap guard stops before the first step |
| [friction limit](#friction-limit) | tan of the slope | no creep below; sliding within {distance from the limit of friction, of it:.1%} above |
| [short period](#short-period) | {shortest period over the largest radius and skin:.2g} × (largest radius + skin) | refused |
| [fast body](#fast-bodies) | skin of {steps that a skin lasts:.0f} steps | no contact is missed |
| [stiffening springs](#stiffening-springs) | stiffness of the deepest contact | force error at most {error of the force of what is pressed from first touch on:.1%} |

## Time step
The bound is 2/ω of the fastest mode, with dashpots and rotation, estimated by body ([numerical method](../method.md#time-step)).

- An explicit time step above the bound is refused.
- Otherwise the step is {share of the bound that is chosen:.2g} of the bound, or shorter where impacts need it.
- With `allow_unstable` nothing is guaranteed. An `energy` probe makes the energy guard detect the instability, even if it is dissipated.
- Without the probe the guard detects only growth that exceeds dissipation. 300 grains under gravity at 1.8 times the bound (restitution 0.5,
  local damping 0.3) ended with exit status 0, vibrating. With the probe the run stopped after 2 ms with status 4 (one run).

## Impacts
The energy error of one impact of n steps is up to (π/n)²/4. Its sign depends on where in a step the impact begins.

- At the chosen step an impact of two bodies takes at least {pair, least steps of an impact at the chosen step:.3g} steps with linear springs.
- With friction and any springs the largest energy gain is {pair, most that an impact gains at the chosen step:.1%} for equal sizes
  and {two sizes, most that an impact gains at the chosen step:.1%} for a size ratio of 1 : 10.
- At a plane no angle, friction or restitution gains more than predicted.
- Where single impacts matter, use a tenth of the critical step. Velocities are then within {error of an oblique collision at a tenth of the critical step, of its speed:.1%} of the speed. The `energy` probe shows the error.

## Many impacts
Averaged over the phase within a step, an impact gains (π/n)⁴/90 of its energy with linear springs and 1.3/n⁵ with Hertz springs
([many_impacts.cpp](../../tests/stability/many_impacts.cpp)). Leap-frog conserves phase-space volume, so scattered energy must grow.
A gas of restitution 1 therefore heats. Its growth over the predicted sum of gains is
{growth of the energy of a gas over what its impacts are predicted to gain, linear-frictional:.2f} ± {chance in that, linear-frictional:.2f} (linear) and
{growth of the energy of a gas over what its impacts are predicted to gain, hertz-mindlin:.2f} ± {chance in that, hertz-mindlin:.2f} (Hertz).

N impacts of each body add about N/3 mean gains: an impact has two thirds of a body's energy on average, and two bodies share the gain.
To keep the sum below 1 %:

- **Linear springs** need `steps_per_impact` of 3 N^¼: 17 for 1 000 impacts, 53 for 100 000. The default of 7 allows about 30 in the worst case.
  Equal sizes gain only {mean gain of a frictionless impact at the usual safety, linear-frictional:.1g} per impact, since their impact takes almost exactly 7 steps. Other sizes gain more.
- **`hertz-mindlin`** needs a `safety` of 0.9 N^-⅕: 0.22 for 1 000 impacts, 0.09 for 100 000. `steps_per_impact` has almost no effect, since it uses the
  stiffness at first contact. The fastest frictionless impact takes {steps of a frictionless impact at the usual safety, hertz-mindlin:.2g} steps at the default safety. It gains {mean gain of a frictionless impact at the usual safety, hertz-mindlin:.1%} on average and
  {most that a frictionless impact gains at the usual safety, hertz-mindlin:.0%} at most. 216 grains at 0.3 m/s with 400 impacts per second gained 9 % energy at the default safety and 0.2 % at 0.27 (one run).
- Restitution of 0.99 or less, or friction, dissipates more than an impact of 7 or more steps gains.

## Speed
A contact is missed if a step is longer than a diameter at a thin wall, or than both diameters at another body.
The travel guard stops long before, at {way in a step that the travel guard allows, in radii:.2g} radii per step. Its message names the body, the time and what to do.

## Ratios
| ratio | result |
| --- | --- |
| sizes of a pair | no sticking up to 1 : 100; rebounds off by at most {error of the rebound of two sizes at the chosen step:.2g} of the speed |
| sizes of a mixture | no contact missed at 1 : {ratio of sizes up to which no contact is missed:.0f}, checked at every step |
| inertia of clumps | the bound is at least {bound of a clump over its longest stable step, at least:.2g} of the longest stable step |
| masses | the bound is at least {bound over the longest stable step, of heavier grains among light ones, at least:.2g} of the longest stable step |
| stiffnesses of bodies | conservative: the two stiffest may meet; {bound over the longest stable step, of grains 1e4 times as stiff among others:.2g} of the longest stable step at 10⁴ |
| stiffness of a wall | the bound is at least {bound over the longest stable step, of a grain between stiffer plates, at least:.2g} of the longest stable step |
| mass of a free wall | the bound is at least {bound over the longest stable step, of a free wall, at least:.2g} of the longest stable step |

Wall and bodies oscillate together at a free wall. The prediction uses the eigenvalues of both.

## Servo
- On a heavy specimen the largest stable gain is {gain that a servo on a heavy specimen may have:.3g}. On a stack the eigenvalues of bodies, wall and delay predict it; a single body is the worst case.
- Gains above {gain of a servo that is taken:.2g} are refused. At {share of the bound that is chosen:.2g} of the critical step every accepted gain is stable.
- Above {stable step over the critical one, of a servo of gain 1:.2g} of the critical step a gain of 1 shakes a single body until a guard trips. A gain of 0.3 is stable to {stable step over the critical one, of a servo of gain 0.3:.2g}.
- With dashpots the servo moves more slowly. It is stable to {stable step over the critical one, of a servo on dashpots:.2g} or more at restitutions of 0.05 … 0.95.
- A servo that closes a gap brakes. It moves no further than to where the contacts carry the missing force, or a quarter of the target force F.
  In all cases tried it exerted at most {peak of the force of a servo that closes, over the one that it keeps:.2g} F: 1, 16 and 25 grains, linear and Hertz springs, dashpots, v dt k / F from 0.03 to 300.
- Dashpots count by closing speed. A lid of 5 kPa pushes loose grains (20 MPa, restitution 0.4) steadily at 0.5 m/s.
  At 1.5 m/s, or at a restitution of 0.1, it moves in jerks and the energy guard may stop it. A `max_velocity` of 0.1 m/s cures that.
- The travel guard stops a wall that moves by more than {way in a step that the travel guard allows, in radii:.2g} radii of the smallest body per step.

## Initial overlap
Overlapping bodies fly apart with speeds of about δ ω / 2.

- At 0.8 of the critical step an overlap of {deepest start that survives at 0.8 of the critical step, in radii:.2g} radii moves a body by {way in a step that the travel guard allows, in radii:.2g} radii in one step: the travel guard stops.
- At a quarter of the critical step or less the overlap guard is the limit, {deepest start that survives at most, in radii:.2g} radii.
- What survives flies apart with the energy of its springs.

## Friction limit
On an incline a body sticks without creep below the limit of friction or rolling resistance. Above it, it slides by Coulomb's law, down to
{distance from the limit of friction, of it:.1%} from the limit.

## Short period
A periodic side shorter than {shortest period over the largest radius and skin:.2g} times the sum of largest radius and skin would let a body meet another twice.
It is refused before the first step. A cell that shrinks to this length stops with length, limit and advice.

## Fast bodies
A chunk's skin lasts {steps that a skin lasts:.0f} steps of its fastest body. It is at least {least skin, in mean diameters:.2g} and at most {most skin, in mean diameters:.2g} mean diameters.
The neighbour search runs again as soon as a skin is used up, so that no contact is missed.

## Stiffening springs
The time step follows the deepest contact and the deepest impact that present speeds allow. It is set again when either grows.

- Bodies pressed from first contact feel Hertz's force within {error of the force of what is pressed from first touch on:.1%}.
- A pressed packing agrees with a tenth of the step within {error of the force of a packing that is pressed:.2%}.
- A bouncing body rises by at most {height that is gained by a fall:.1%} of its height more than restitution gives.
- The energy balance of a poured heap closes within {closure error of what is poured:.1%}.
- Not detected: a packing pressed less deep than another contact was before.

## Guards of the shipped descriptions
Guards run with every simulation. None trips without cause:

- [false_alarms.cpp](../../tests/stability/false_alarms.cpp) runs the quick column and oedometer to their ends. It also shears dense and loose boxes of
  {grains in the box that is sheared:.0f} grains by {way that the box is sheared, in mm:.2g} mm.
- `tests/sims` runs each quick description for a while.
- All quick descriptions, and the full ones in [reproduction](reproduction.md), ran to their ends. So did those of [Beverloo's law](beverloo.md).

The defaults are an overlap of {overlap that the usual guard allows, in radii:.2g} of the smaller radius and a displacement of {way in a step that the travel guard allows, in radii:.2g} of a radius per step.
Plane silos allow [larger displacements](../../plugins/scenarios/silo.md#filling) while they are filled, 0.14 of the smallest radius in the full ones.
These descriptions, and those that extend them, have guards of their own:

| description | guards | why |
| --- | --- | --- |
{own guards}

## Order in the time step
Slopes of the errors of an [oblique collision](#error-of-an-oblique-collision-over-its-speed) against the time step; tests allow 0.2.
A smooth contact is of second order (Collision.ErrorIsOfSecondOrderInTheStep in [validation.csv](validation.csv)).

| law | predicted | found | first-order term |
| --- | --- | --- | --- |
| linear-frictional, slides at first | 2 | {order, linear-frictional, slides at first:.2f} | none |
| linear-frictional | 1 | {order, linear-frictional:.2f} | first step of the shear spring; small, as κ = 0.3 is near 2/7 |
| linear-frictional, restitution 0.5 | 1 | {order, linear-frictional, restitution 0.5:.2f} | dashpots, whose velocities are half a step old |
| linear-rolling | 1 | {order, linear-rolling:.2f} | first step of the rolling spring |
| hertz-mindlin | 1 | {order, hertz-mindlin:.2f} | shear stiffness, taken at the end of the step |
| hertz-mindlin, restitution 0.5 | 1 | {order, hertz-mindlin, restitution 0.5:.2f} | both |

## What the energy guard does not see
It samples at intervals, and trips only at gains. Each stage, and each increment of a ramp, starts a new balance.

- **Without an `energy` probe** it compares stored energy with the work of walls, so that dissipation hides an equal gain. It is off where bodies grow,
  a cell deforms, bodies are held, engines push them, or gravity acts along a periodic axis.
- **With an `energy` probe** it uses the closure error of the energy balance, relative to the largest energy and to the dissipated energy.
- **Known false alarms**: deep contacts sheared along curved walls and edges ([energy probe](../../plugins/probes/energy/README.md)),
  and [many impacts](#many-impacts) without dissipation. Use a shorter step there.

## Maps
Limits found by bisection are one limit each. Two Hertz bodies that start with an overlap have several, so that their curve goes up and down.

'''


class Axis:
    """An axis of a picture: logarithmic, but linear if values are angles or span less than a decade, so that small
    differences show."""

    def __init__(self, values, title, margin, begin, end):
        low, high = min(values), max(values)
        self.linear = '°' in title or 'degrees' in title or low > 0.1 * high
        self.begin, self.end = begin, end
        if self.linear:
            border = 0.05 * (high - low) or 0.5 * abs(high) or 1
            self.low, self.high = low - border, high + border
        else:
            self.low, self.high = low / margin, high * margin

    def place(self, value):
        along = ((value - self.low) / (self.high - self.low) if self.linear else
                 math.log(value / self.low) / math.log(self.high / self.low))
        return self.begin + along * (self.end - self.begin)

    def ticks(self):
        """Powers of ten, or 1, 2, 5 times these if they are few; steps of 1, 2 or 5 on a linear axis."""
        if self.linear:
            power = 10.0 ** math.floor(math.log10((self.high - self.low) / 4))
            step = next(lead * power for lead in (1, 2, 5, 10) if (self.high - self.low) / (lead * power) <= 6)
            return [round(k * step, 12) for k in range(math.ceil(self.low / step), math.floor(self.high / step) + 1)]
        first, last = math.floor(math.log10(self.low)), math.ceil(math.log10(self.high))
        leads = (1,) if last - first > 3 else (1, 2, 5)
        return [lead * 10.0 ** power for power in range(first, last + 1) for lead in leads
                if self.low * 0.999 <= lead * 10.0 ** power <= self.high * 1.001]


def picture(title, series):
    """Curves, each thinner than the one before, so that overlapping ones remain visible. Predicted curves are dashed, without
    marks, in the colour of the measured curve of the same name."""
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


def numbers(what, along, series):
    """The points of a map as CSV, without predicted curves, which are dense, but with predicted limits."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator='\n')
    rows.writerow(['series', along, what])
    for one, curve in series.items():
        if not one.startswith('predicted') or len(set(curve)) == 1:
            rows.writerows([one, f'{x:g}', f'{y:.3g}'] for x, y in sorted(set(curve)))
    return out.getvalue()


def filled(text, figures):
    """Fills in the figures. Exits if the tests report no figure of some name."""
    place = re.compile('{([^{}:]+):([^{}:]+)}')
    missing = sorted({name for name, _ in place.findall(text) if name not in figures})
    if missing:
        print('docs/evidence/stability.md is unchanged: no test reports\n' + '\n'.join(missing), file=sys.stderr)
        sys.exit(1)
    return place.sub(lambda found: format(figures[found[1]], found[2]), text)


def own_guards():
    """Rows of the descriptions and studies that set guards. Exits if one of them has no reason in WHY, or if WHY names
    another one."""
    sims, rows = reported.ROOT / 'sims', {}
    for file in sorted(sims.glob('*/*.json')):
        scene = json.loads(file.read_text(encoding='utf-8'))
        own = {f'/guards/{name}': value for name, value in scene.get('guards', {}).items()}
        own |= {pointer: value for pointer, value in scene.get('set', {}).items() if pointer.startswith('/guards/')}
        if own:
            name = file.relative_to(sims).with_suffix('').as_posix()
            values = ', '.join(f"{pointer.split('/')[-1]} {value:g}" for pointer, value in own.items())
            rows[name] = f'| [{name}](../../sims/{name}.json) | {values} | {WHY.get(name)} |'
    if rows.keys() != WHY.keys():
        print(f'docs/evidence/stability.md is unchanged: correct WHY for {sorted(rows.keys() ^ WHY.keys())}', file=sys.stderr)
        sys.exit(1)
    return '\n'.join(rows.values())


def main():
    tests, maps, figures = reported.tests('test_stability', 'docs/evidence/stability.md'), {}, {}
    for _, properties in tests:
        for key, value in properties.items():
            if key.startswith(FIGURE):
                figures[key[len(FIGURE):]] = max(float(value), figures.get(key[len(FIGURE):], -math.inf))
            if key.startswith(MAPPED):
                y_title, x_title, series, _ = key[len(MAPPED):].split('|')
                curves = maps.setdefault(f'{y_title}|{x_title}', {})
                curves.setdefault(series, []).append(tuple(map(float, value.split())))
    text = filled(HEAD.replace('{own guards}', own_guards()).replace('{tests}', str(len(tests))), figures)
    folder = reported.ROOT / 'docs' / 'evidence' / 'stability'
    folder.mkdir(exist_ok=True)
    for old in (*folder.glob('*.svg'), *folder.glob('*.csv')):
        old.unlink()
    for title, series in sorted(maps.items()):
        what, along = title.split('|')[:2]
        name = re.sub('[^a-z0-9]+', '-', what.lower()).strip('-')
        (folder / f'{name}.svg').write_text(picture(title, series), encoding='utf-8')
        (folder / f'{name}.csv').write_text(numbers(what, along, series), encoding='utf-8')
        text += f'### {what[0].upper()}{what[1:]}\n![{what}](stability/{name}.svg)\n\n[numbers](stability/{name}.csv)\n\n'
    text = text.rstrip('\n') + '\n'
    (reported.ROOT / 'docs' / 'evidence' / 'stability.md').write_text(text, encoding='utf-8')
    print(f'docs/evidence/stability.md: {len(tests)} tests, {len(maps)} maps')


main()
