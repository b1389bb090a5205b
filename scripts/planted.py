#!/usr/bin/env python3
"""Plants errors in copies of the contact laws and of the kernel, one at a time, and writes which tests fail:
docs/evidence/planted.md.

  planted.py [--only PART] [BUILD]      BUILD is build unless given; exit status 1 if no test fails with an error, or if
                                        tests fail without one; --only updates the rows of one of the PARTS below

While it runs, a library of the build is replaced by a copy that has all errors and selects one by an environment variable.
Takes five minutes on one core. If it is killed, the next run restores the library.
tests/house/planted.py checks, without a build, that all errors can still be planted and that the page lists these.
"""
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[1]
LAWS = ROOT / 'plugins' / 'contacts'
# All tests except the slow ones take seconds; an error may keep a ball rolling for ever.
PATIENCE = 60                                            # s of CPU time
SLOW = ('PlaneSilo.*', 'Silo.*', 'DirectShear.*', 'InterfaceShear.*', 'Triaxial.*', 'GroovedVoidRatio.*', 'PackingStress.*')
OF_WALLS = ('*Seams.*', 'Faceted*.*', 'FacetingError.*')
# The missing part of a shear spring that is half a step late.
LATE = '(L(0.5) * ks * at.dt) * at.tangential(at.velocity)'
FRICTION = 'std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)))'
ROLLING_LIMIT = 'interface.rolling_limit.value_or(std::min(a.rolling_limit, b.rolling_limit))'


def at_each(what, text, factor='2'):
    """The same error at pairs and at walls, each alone."""
    return [(f'{what} of pairs', text, f'(wall ? 1 : {factor}) * ($)'), (f'{what} of walls', text, f'(wall ? {factor} : 1) * ($)')]


# Part: (folder, source, [(error, text of the source, replacement, in which $ is the text itself)])
PARTS = {
    'linear-frictional': (LAWS / 'linear-frictional', 'linear-frictional.hpp', [
        *at_each('shear stiffness × 2', '0.5 * (a.shear_to_normal_stiffness + stiff_b.shear_to_normal_stiffness)'),
        *at_each('friction + 1 %', FRICTION, '1.01'),
        ('dashpot × 2', 'dashpot(pair.damping, kn, inverse_mass)', 'L(2.0) * $'),
        ('dashpot in shear × 2', 'dashpot(pair.shear_damping, ks, L(3.5) * inverse_mass)', 'L(2.0) * $'),
        ('velocity of shear half a step late', 'response.shear = spring;', f'response.shear = spring + {LATE};'),
    ]),
    'linear-rolling': (LAWS / 'linear-rolling', 'linear-rolling.hpp', [
        *at_each('shear stiffness × 2', 'mean(a.shear_to_normal_stiffness, stiff_b.shear_to_normal_stiffness)'),
        *at_each('friction + 1 %', FRICTION, '1.01'),
        ('dashpot × 2', 'dashpot(pair.damping, kn, at.inverse_mass_a + at.inverse_mass_b)', 'L(2.0) * $'),
        ('velocity of shear half a step late',
         'state.shear = response.shear;',
         f'$ response.shear = response.shear + {LATE};'),
        ('rolling moment of the wrong sign',
         'stretched(at, state.rolling, pair.rolling * angular, at.spin)',
         'stretched(at, state.rolling, -(pair.rolling * angular), at.spin)'),
        *at_each('rolling stiffness × 2', 'mean(a.rolling_stiffness, stiff_b.rolling_stiffness)'),
        *at_each('rolling limit + 1 %', ROLLING_LIMIT, '1.01'),
        ('twisting moment of the wrong sign', 'twisted(at, state.twisting, pair.twisting * angular, pair.twisting_limit * arm)',
         'twisted(at, state.twisting, -(pair.twisting * angular), pair.twisting_limit * arm)'),
        *at_each('twisting stiffness × 2', 'mean(a.twisting_stiffness, stiff_b.twisting_stiffness)'),
        *at_each('twisting limit + 1 %', 'interface.twisting_limit.value_or(std::min(a.twisting_limit, b.twisting_limit))', '1.01'),
    ]),
    'hertz-mindlin': (LAWS / 'hertz-mindlin', 'hertz-mindlin.hpp', [
        *at_each('normal stiffness + 1 %', '1 / (plane_compliance(a) + plane_compliance(b))', '1.01'),
        *at_each('shear stiffness × 2', '1 / (shear_compliance(a) + shear_compliance(b))'),
        *at_each('friction + 1 %', FRICTION, '1.01'),
        ('dashpot × 2', 'dashpot(L(0.5) * pair.damping, kn, at.inverse_mass_a + at.inverse_mass_b)', 'L(2.0) * $'),
        ('springs keep their force as the contact is unloaded', 'contact_radius / max(state.contact_radius, L(tiny<L>))', 'L(1.0)'),
        ('velocity of shear half a step late',
         'state.shear = response.shear;',
         f'$ response.shear = response.shear + {LATE};'),
        ('rolling moment of the wrong sign', 'stretched(at, kept * state.rolling, stiffness, at.spin)',
         'stretched(at, kept * state.rolling, -stiffness, at.spin)'),
        *at_each('rolling stiffness × 2', '0.5 * (a.rolling_stiffness + b.rolling_stiffness)'),
        *at_each('rolling limit + 1 %', ROLLING_LIMIT, '1.01'),
    ]),
    'linear-cohesive': (LAWS / 'linear-cohesive', 'linear-cohesive.hpp', [
        ('pull-off force + 1 %', 'pair.strength * radius * radius', 'L(1.01) * $'),
        ('a bond before bodies touch', 'select(at.overlap > L(0.0), L(1.0), L(0.0))', 'L(1.0)'),
    ]),
    'jkr': (LAWS / 'jkr', 'jkr.hpp', [
        ('work of adhesion + 1 %', '2 * std::sqrt(a.surface_energy * b.surface_energy)', '1.01 * $'),
        ('a contact before bodies touch', 'select(at.overlap > L(0.0), L(1.0), L(0.0))', 'L(1.0)'),
    ]),
    'capillary': (LAWS / 'capillary', 'capillary.hpp', [
        ('force of a bridge + 1 %', 'std::cos(angle)', '1.01 * $'),
        ('rupture distance + 1 %', 'std::cbrt(volume)', '1.01 * $'),
        ('a bridge before bodies touch', 'select(at.overlap > none, L(1.0), none)', 'L(1.0)'),
    ]),
    'walls': (ROOT / 'core' / 'src' / 'contact', 'wall_contacts.cpp', [
        ('an edge that two faces share counts twice', '!work.found.empty()', 'false'),
        ('the friction of a turntable has no moment', 'load.surface_moment += Vec3(px, py, pz).cross(shear) + xyz(moment);', ';'),
    ]),
    'wall-motion': (ROOT / 'core' / 'src' / 'motion', 'walls.cpp', [
        ('a free rotation without the moment of its load', 'how.free_axis.dot(state.moment)', '0.0'),
        ('motor of a free rotation of the wrong sign', 'free->moment', '-$'),
    ]),
    'prescribed-motion': (ROOT / 'core' / 'src' / 'motion', 'motion.cpp', [
        ('spin of the wrong sign', 'own.prescribed->spin()', 'Vec3(-$)'),
        ('the velocity is that at the start of a step', 'own.prescribed->velocity_at(xyz(position[i]))',
         '(own.prescribed->spin().isZero(0.0) ? $ : Vec3(own.prescribed->spin().cross(xyz(position[i]))))'),
    ]),
    'groups': (ROOT / 'core' / 'src' / 'kernel', 'stepper.cpp', [
        ('sinks take bodies of all groups', 'if (!one.groups.empty() && !one.groups[state_.group[i]]) continue;', ';'),
        ('forces of engines act on all groups',
         'if (one.groups[state_.group[i]]) force[i] += own_force[i], moment[i] += own_moment[i];',
         'force[i] += own_force[i], moment[i] += own_moment[i];'),
    ]),
}
# Parts whose tests are not those of physics: program, tests.
ELSEWHERE = {'prescribed-motion': ('run', 'Groups.*'), 'groups': ('run', 'Groups.*:Sink.*')}
CHOICE = '''#include <cstdlib>
namespace {
const int planted_error = std::getenv("VARIABLE") != nullptr ? std::atoi(std::getenv("VARIABLE")) : 0;
}
'''
HEAD = '''# Planted errors
Written by `scripts/planted.py`. Do not edit.

**Summary.** Do the tests of physics detect errors in the code? Each error below was planted alone in a copy of a contact law or of the
kernel, and at least one test failed each time.

The last column has the tests of [tests/physics](../../tests/physics) that failed; for prescribed motions and groups those of
[tests/run](../../tests/run). Tests of whole specimens were not run, nor tests of curved surfaces for errors outside the walls.

| in | error | failing tests |
| --- | --- | --- |
'''


def variable(part):
    """The environment variable with the number of the error."""
    return 'GRIT_PLANTED_' + part.upper().replace('-', '_')


def with_errors(text, part):
    """A source with all errors of a part, each selected by its number."""
    places = {}
    for number, (_, old, new) in enumerate(PARTS[part][2], 1):
        places.setdefault(old, []).append((number, new.replace('$', old)))
    for old, news in places.items():
        if text.count(old) != 1:
            sys.exit(f'planted.py: found {text.count(old)} times in the source, not once: {old}')
        if old.endswith(';'):
            changed = ''.join(f'if (planted_error == {number}) {{ {new} }} else ' for number, new in news) + f'{{ {old} }}'
        else:
            changed = '(' + ''.join(f'planted_error == {number} ? ({new}) : ' for number, new in news) + f'({old}))'
        text = text.replace(old, changed)
    return CHOICE.replace('VARIABLE', variable(part)) + text.replace('#pragma once\n', '')


def command_of(build, words):
    """The shell command of the build that contains all the words."""
    for line in subprocess.run(['ninja', '-C', build, '-t', 'commands', 'grit', 'grit_plugins'], check=True, capture_output=True,
                               text=True).stdout.splitlines():
        if all(word in line for word in words):
            return line
    sys.exit(f'planted.py: {build} has no command with {words}')


def compiled_file(build, unit):
    """The file that the compiler gets: the unit, or a file of a unity build that includes it."""
    including = [path for path in build.glob('core/CMakeFiles/*/Unity/*.cxx') if f'"{unit}"' in path.read_text(encoding='utf-8')]
    return including[0] if including else unit


def is_law(part):
    return PARTS[part][0].parent == LAWS


def library_of(build, part):
    return build / 'lib' / 'grit' / (f'contacts/{part}.so' if is_law(part) else 'libgrit.so')


def tests_of(build, part):
    """The program with the tests of a part, and a filter of these; empty: all."""
    program, wanted = ELSEWHERE.get(part, ('physics', ''))
    return build / 'tests' / f'test_{program}', wanted


def built(build, part, folder):
    """The library of a part in the build, and its copy with errors."""
    source_folder, source, _ = PARTS[part]
    changed = with_errors((source_folder / source).read_text(encoding='utf-8'), part)
    library = library_of(build, part)
    unit = source_folder / (f'{part}.cpp' if is_law(part) else source)
    (folder / unit.name).write_bytes(unit.read_bytes())
    (folder / source).write_text(changed, encoding='utf-8')
    compiled = compiled_file(build, unit)
    if compiled != unit:
        (folder / compiled.name).write_text(compiled.read_text(encoding='utf-8').replace(f'"{unit}"', f'"{folder / unit.name}"'),
                                            encoding='utf-8')
    compile_one = command_of(build, [f' -c {compiled}'])
    made = re.search(r' -o (\S+\.o) ', compile_one).group(1)
    link = command_of(build, ['-shared', f' -o {library.relative_to(build)} '])
    subprocess.run(compile_one.replace(f' -c {compiled}', f' -c {folder / compiled.name}').replace(f' -o {made} ', f' -o {folder}/planted.o ')
                   .replace(f'-MF {made}.d', f'-MF {folder}/planted.d'), shell=True, check=True, cwd=build)
    subprocess.run(link.replace(f' {made} ', f' {folder}/planted.o ').replace(f' -o {library.relative_to(build)} ', f' -o {folder}/planted.so '),
                   shell=True, check=True, cwd=build)
    return library, folder / 'planted.so'


def failing(program, wanted, folder, excluded, errors):
    """Names of the tests that fail or do not end with an error planted; a parametrised test counts once."""
    tests = []
    patience = lambda: resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE))  # noqa: E731
    while True:
        done = subprocess.run([program, f'--gtest_filter={wanted}-' + ':'.join(excluded)], cwd=folder, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, preexec_fn=patience, env={**os.environ, **errors})
        lines = done.stdout.decode(errors='replace').splitlines()
        tests += [match.group(1) for match in map(re.compile(r'\[  FAILED  \] ([^\s,]+).* ms\)$').match, lines) if match]
        if done.returncode in (0, 1):
            break
        # The program crashed or was killed; run the remaining tests.
        begun = [line.split()[-1] for line in lines if line.startswith('[ RUN ')]
        tests.append(begun[-1])
        excluded = (*excluded, *begun)
    return sorted({re.sub(r'^\w+/(?=\w+\.)', '', re.sub(r'/\w+$', '', name)) for name in tests})


def tried(build, part):
    """Rows of the page: (part, error, tests)."""
    (program, wanted), excluded = tests_of(build, part), SLOW if part == 'walls' else SLOW + OF_WALLS
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library, planted = built(build, part, folder)
        kept = library.with_suffix('.unplanted')
        os.replace(library, kept)
        try:
            shutil.copy(planted, library)
            healthy = failing(program, wanted, folder, excluded, {})
            if healthy:
                sys.exit(f'planted.py: {part}: fail without an error: {", ".join(healthy)}')
            for number, (what, _, _) in enumerate(PARTS[part][2], 1):
                tests = failing(program, wanted, folder, excluded, {variable(part): str(number)})
                print(f'{part}: {what}: {", ".join(tests) or "no test failed"}', flush=True)
                yield part, what, tests
        finally:
            os.replace(kept, library)


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # restores the library
    words = sys.argv[1:]
    parts = list(PARTS)
    if words[:1] == ['--only']:
        parts, words = words[1:2], words[2:]
        if parts[:1] not in [[part] for part in PARTS]:
            print(f'planted.py: --only takes one of {", ".join(PARTS)}', file=sys.stderr)
            return 2
    build = Path(words[0] if words else ROOT / 'build').resolve()
    for part in parts:
        program, _ = tests_of(build, part)
        if not program.is_file():
            print(f'{program}: no such program; build it (cmake --build --preset release)', file=sys.stderr)
            return 2
    for part in parts:
        library = library_of(build, part)
        if library.with_suffix('.unplanted').is_file():
            os.replace(library.with_suffix('.unplanted'), library)
    page = ROOT / 'docs' / 'evidence' / 'planted.md'
    green = False
    for part in parts:
        found = list(tried(build, part))
        green |= not all(tests for _, _, tests in found)
        lines = page.read_text(encoding='utf-8').splitlines(True) if page.is_file() else []
        rows = {other: [line for line in lines if line.startswith(f'| {other} |')] for other in PARTS}
        rows[part] = [f'| {part} | {what} | {", ".join(tests) or "none"} |\n' for _, what, tests in found]
        page.write_text(HEAD + ''.join(line for other in PARTS for line in rows[other]), encoding='utf-8')
    return 1 if green else 0


if __name__ == '__main__':
    sys.exit(main())
