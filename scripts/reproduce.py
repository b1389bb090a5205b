#!/usr/bin/python3
"""Writes docs/evidence/reproduction.md: results of grit beside those of a reference work.

  reproduce.py [--run GLOB]… [--samples N] [--for SECONDS] [--threads N] [--results FOLDER] [--grit FILE]

docs/evidence/reproduction.json defines the figures. Each quick and full description of sims/ with a finished run in FOLDER/TEST/NAME
(results/reproduce unless given) gets its rows. Without a run, its section of docs/evidence/reproduction.md is kept as long as
docs/evidence/reproduction.json defines the same figures; other full descriptions are listed with their estimated times. All
sims/*/quick*.json have a line on how they ended, from FOLDER or, without a run there, from the existing page. --run runs the
descriptions that match GLOB and have no finished run, e.g. --run '*/quick*', --run interface-shear/full-rn-100. --samples runs N
packings of each: that of seed 2 is in FOLDER/TEST/NAME-sample-2. Rows of several samples show mean and standard deviation. --for
interrupts a run after so many core-seconds, to time it; running it again resumes it.
"""
import argparse
import fnmatch
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[1]
HEAD = '''# Reproduction
Written by `scripts/reproduce.py` from finished runs of [sims](../../sims); do not edit.

**Summary.** {within} of {all} values lie within the deviation that [reproduction.json](reproduction.json) allows from a reference work. The others are
explained below their table; [deviations](deviations.md) has what was tried. Most come from the small boxes of the quick descriptions.

The reference is A. Grabowski, doctoral dissertation, Gdańsk 2024 (YADE, full size). Its values are of one packing each.

- `full` descriptions have the reference's size. `quick` ones are smaller, and many are sheared at another rate.
- A value is of one packing, or a mean of several ± the standard deviation of one.
- "none": rotation is largest at the surface and has no inflection point.
- A section is kept until its test is run again, and names the commit of its runs.
- Triaxial tests of table 4.1 of the reference are in [studies](studies.md#triaxial-compression).

'''

UNFINISHED = 'Not run to their ends'
HEAD_OF_UNFINISHED = f'''## {UNFINISHED}
- Hours are those of `grit check` on two threads at 36 M particle-steps/s, with typical durations of stages and with their limits.
- Timed runs (`--for`) show the fraction done and the commit. They cover falling sand only, so that their core-hours are a lower bound.
- The last column uses the measured speed with resting sand, a quarter of that.

| description | hours by `grit check` | timed | M particle-steps/core-second | core-hours, at least | with resting sand |
| --- | --- | --- | --- | --- | --- |'''

IN_SECTION = 'see its section'
QUICK = 'All quick descriptions, run to their ends'
HEAD_OF_QUICK = f'''## {QUICK}
Each of `sims/*/quick*.json` once, with the seed of its description. Ends of curves are means of the last quarter; peaks are the highest samples.
Values of descriptions with a section above are in that section.

| description | ended | steps | core-seconds | commit | values |
| --- | --- | --- | --- | --- | --- |'''


def found(series, row, ends=None):
    """The figure that a row defines; `ends`: step at which each stage ended."""
    of, how = series[row['of']][:], row['how']
    if 'component' in row:
        of = of[:, row['component']]
    if how == 'maximum':
        figure = numpy.nanmax(of)
    elif how == 'minimum':
        figure = numpy.nanmin(of)
    elif how == 'last':
        figure = of[-1]
    elif how == 'mean of the last quarter':
        figure = of[-max(1, len(of) // 4):].mean()
    elif how == 'at the start':  # the last sample before the test moves
        figure = of[numpy.nonzero(series[row['before']][:] <= 0)[0][-1]]
    elif how == 'at the end of a stage':
        steps = series[f"{row['of'].rpartition('/')[0]}/step"][:]
        figure = of[numpy.nonzero(steps <= ends[row['stage']])[0][-1]]
    elif how == 'where largest':
        figure = series[row['against']][of.argmax()]
    else:
        sys.exit(f'docs/evidence/reproduction.json: found "how": "{how}"; allowed are maximum, minimum, last, mean of the last quarter, at the start, '
                 'at the end of a stage, where largest')
    return row.get('scale', 1) * float(figure) + row.get('plus', 0)


def state(folder):
    """The run.json of a run, or None."""
    try:
        return json.loads((folder / 'run.json').read_text(encoding='utf-8'))
    except (FileNotFoundError, json.JSONDecodeError):
        return None


def lacks(series, row):
    """The first channel of a row that a run did not record, or None."""
    return next((row[key] for key in ('of', 'against', 'before') if key in row and row[key] not in series), None)


def samples(results, name):
    """Folders of the finished runs of a description, first the packing with its own seed."""
    folders = [results / name, *sorted((results / name).parent.glob(f'{Path(name).name}-sample-*'),
                                       key=lambda folder: int(folder.name.rpartition('-')[2]))]
    return [folder for folder in folders if (state(folder) or {}).get('status') == 'done']


def asked(row):
    """The start of a figure's line."""
    return f"| {row['figure']} | {row['reference']:g} ± {row['allowed']:g} |"


def rows(name, folders, figures, older):
    """Lines of the table: a figure over all samples compared with the reference."""
    for row in figures:
        reference, allowed = row['reference'], row['allowed']
        values = []
        for folder in folders:
            with h5py.File(folder / 'series.h5') as series:
                if channel := lacks(series, row):
                    if not older:
                        sys.exit(f'docs/evidence/reproduction.json: {name}, "{row["figure"]}": found the channel "{channel}", which '
                                 f'{folder / "series.h5"} lacks; correct it, run {name} again, or list it under "older" if its '
                                 'run is older than that channel')
                    break
                values.append(found(series, row))
        if not values:
            yield f'{asked(row)} not recorded | | |'
            continue
        finite = [value for value in values if not numpy.isnan(value)]
        if not finite:
            yield f'{asked(row)} none | | |'
            continue
        mean = numpy.mean(finite)
        scatter = f' ± {numpy.std(finite, ddof=1):.2g}' if len(finite) > 1 else ''
        if len(finite) < len(values):
            scatter += f' in {len(finite)} of {len(values)}'
        verdict = 'within' if abs(mean - reference) <= allowed else 'outside'
        yield f'{asked(row)} {mean:.3g}{scatter} | {mean - reference:+.2g} | {verdict} |'


def commits(folders):
    """The commits of grit that made the runs."""
    names = dict.fromkeys(state(folder).get('grit', {}).get('revision') or 'unknown' for folder in folders)
    return f"by commit{'s' if len(names) > 1 else ''} {', '.join(names)}"


def table(name, folders, figures, older):
    run = state(folders[0])
    yield ''
    several = f'{len(folders)} packings; the first: ' if len(folders) > 1 else ''
    yield (f"{several}{run['bodies']:,} bodies, {run['steps']:,} steps, {run.get('cpu_s', run['wall_s']):.0f} core-seconds on {run['threads']} "
           f"thread{'s' if run['threads'] > 1 else ''}, {run['bodies'] * run['steps'] / run.get('cpu_s', run['wall_s']) / 1e6:.1f} M particle-steps per core-second, {commits(folders)}.\n")
    if not figures:
        return
    yield '| figure | reference | grit | deviation | |'
    yield '| --- | --- | --- | --- | --- |'
    yield from rows(name, folders, figures, older)


def sections(page):
    """{heading: text below it}"""
    return dict(text.split('\n', 1) for text in re.split('^## ', page, flags=re.MULTILINE)[1:])


def kept(section, figures):
    """The lines of a section that table() wrote earlier, if its figures are still the defined ones; else none."""
    lines = section.splitlines()
    if not figures:
        return lines[:next((i + 2 for i, line in enumerate(lines) if ' core-seconds on ' in line), 0)]
    at = [i for i, line in enumerate(lines) if line.startswith('| ')]
    old = [lines[i] for i in at[2:]]
    same = len(old) == len(figures) and all(line.startswith(asked(row)) for line, row in zip(old, figures))
    return lines[:at[-1] + 1] if at and same else []


def estimate(program, description):
    """(hours by `grit check`, usual and maximum; usual number of particle-steps)"""
    words = subprocess.run([program, 'check', description], capture_output=True, text=True, check=False).stdout
    match = re.search(r'^estimated time.* at ([0-9.]+) M particle-steps/s: ([0-9.]+) h \(.*?\)[^,\n]*(?:, at most ([0-9.]+) h)?', words, re.M)
    if not match:
        return 'refused', 0
    usual, most = float(match[2]), float(match[3] or 0)
    return f'{usual:.2f}' + (f' … {most:.1f}' if most else ''), 3600e6 * usual * float(match[1])


def part(run, all_of_it):
    """Columns of a timed run: the fraction done, the speed, and the core-hours of the whole at that speed; empty if it was not timed."""
    if not run or not run.get('cpu_s') or not run.get('particle_steps_per_s'):
        return ''
    done = run['particle_steps_per_s'] * run['wall_s']
    rate = done / run['cpu_s']
    words = run['message'].splitlines()[0] if run['status'] == 'failed' else f"{run['steps']:,} steps"
    words += f" by {run['grit'].get('revision') or 'unknown'}"
    if not all_of_it or run['status'] == 'failed':
        return f"{words} | {1e-6 * rate:.1f} | |"
    return f"{100 * done / all_of_it:.1f} %, {words} | {1e-6 * rate:.1f} | {all_of_it / rate / 3600:.1f} |"


def resting(columns, speed):
    """`columns` of part() and the core-hours at the `speed` of resting sand, in M particle-steps per core-second (None: unknown)."""
    timed = re.fullmatch(r'.*\| ([0-9.]+) \| ([0-9.]+) \|', columns)
    return f"{columns} {f'{float(timed[1]) * float(timed[2]) / speed:.0f} ' if timed and speed else ''}|"


def short(name, results, wanted, section, older, figures=()):
    """The line of a quick description: from its run, without the `figures` of its section, or else from the page or its section."""
    run = state(results / name) or {}
    if run.get('status') in ('done', 'failed'):
        ended = 'done' if run['status'] == 'done' else f"failed: {run['message'].splitlines()[0]}"
        words = [IN_SECTION] if section else []
        if run['status'] == 'done':
            above = {(row['of'], row['how']) for row in figures}
            ends = {stage['name']: stage['step'] for stage in run.get('stages', [])}
            with h5py.File(results / name / 'series.h5') as series:
                for row in (row for group in wanted if any(fnmatch.fnmatch(name, glob) for glob in group['descriptions'])
                            for row in group['figures'] if (row['of'], row['how']) not in above):
                    if channel := lacks(series, row):
                        sys.exit(f'docs/evidence/reproduction.json: {name}, "{row["figure"]}": found the channel "{channel}", which '
                                 f'{results / name / "series.h5"} lacks; correct it, or run {name} again')
                    words.append(f"{row['figure']}: {found(series, row, ends):#.3g}")
        return f"{ended} | {run['steps']:,} | {run.get('cpu_s', run['wall_s']):.0f} | {run['grit'].get('revision') or 'unknown'} | {'; '.join(words)} |"
    if older and (section or IN_SECTION not in older):
        return older
    if section:
        text = '\n'.join(section)
        steps, seconds = re.search(r'([0-9,]+) steps, (\d+) core-seconds', text).groups()
        commit = re.search(r'by commits? (.+)\.$', text, re.MULTILINE)
        return f"done | {steps} | {seconds} | {commit[1] if commit else 'unknown'} | {IN_SECTION} |"
    return 'not run | | | | |'


def start(words, most):
    """Runs a command and interrupts it after `most` core-seconds."""
    with subprocess.Popen(words) as process:
        while process.poll() is None:
            time.sleep(1)
            fields = Path(f'/proc/{process.pid}/stat').read_text(encoding='ascii').rpartition(')')[2].split()
            if most is not None and (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK') > most:
                process.send_signal(signal.SIGINT)
                process.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--run', action='append', default=[], metavar='GLOB')
    parser.add_argument('--samples', type=int, default=1, metavar='N')
    parser.add_argument('--for', type=float, dest='most', metavar='SECONDS')
    parser.add_argument('--threads', default='2')
    parser.add_argument('--results', default=ROOT / 'results' / 'reproduce', type=Path)
    parser.add_argument('--grit', default=ROOT / 'build' / 'bin' / 'grit')
    given = parser.parse_args()
    reference = json.loads((ROOT / 'docs' / 'evidence' / 'reproduction.json').read_text(encoding='utf-8'))
    of_size = {size: sorted(str(path.relative_to(ROOT / 'sims').with_suffix('')) for path in (ROOT / 'sims').glob(f'*/{size}*.json'))
               for size in ('quick', 'full')}
    names = list(dict.fromkeys([*(row['description'] for row in reference['figures']), *of_size['full'], *of_size['quick']]))

    for name in names:
        if not any(fnmatch.fnmatch(name, glob) for glob in given.run):
            continue
        for seed in range(1, given.samples + 1):
            folder = given.results / (name if seed == 1 else f'{name}-sample-{seed}')
            if (state(folder) or {}).get('status') != 'done':
                other = [] if seed == 1 else ['--set', f'/scenario/seed={seed}']
                start([given.grit, 'run', ROOT / 'sims' / f'{name}.json', '--out', folder, '--resume', '--threads', given.threads, *other],
                      given.most)

    page = ROOT / 'docs' / 'evidence' / 'reproduction.md'
    old = sections(page.read_text(encoding='utf-8'))
    timed = dict(re.findall(r'^\| (\S+) \| [^|]+\| ((?:[^|\n]*\|){3})', old.get(UNFINISHED, ''), re.MULTILINE))
    ended = dict(re.findall(r'^\| (\S+) \| (.*)$', old.get(QUICK, ''), re.MULTILINE))
    lines, missing, written = [], [], {}

    def rows_of(name):
        return [row for row in reference['figures'] if row['description'] == name]

    for name in names:
        figures = rows_of(name)
        if not figures and name in of_size['quick']:
            continue
        description = ROOT / 'sims' / f'{name}.json'
        if folders := samples(given.results, name):
            section = [*table(name, folders, figures, name in reference['older'])]
        else:
            section = kept(old.get(name, ''), figures) if description.exists() else []
        if section:
            written[name] = section
            note = reference['notes'].get(name)
            lines += [f'## {name}', *section, *(['', note] if note else []), '']
        else:
            hours, particle_steps = estimate(given.grit, description)
            run = state(given.results / name)
            speed = next((speed for glob, speed in reference['resting'].items() if fnmatch.fnmatch(name, glob)), None)
            missing.append(f"| {name} | {hours} | {resting(part(run, particle_steps) or timed.get(name, '| | |'), speed)}")
    if of_size['quick']:
        lines += [HEAD_OF_QUICK, *(f"| {name} | {short(name, given.results, reference['quick'], written.get(name), ended.get(name), rows_of(name))}"
                                   for name in of_size['quick']), '']
    if missing:
        note = reference['notes'].get(UNFINISHED)
        lines += [HEAD_OF_UNFINISHED, *missing, *(['', note] if note else [])]
    verdicts = [line.rpartition('| ')[2] for line in '\n'.join(lines).splitlines() if line.endswith(('| within |', '| outside |'))]
    head = HEAD.replace('{within}', str(verdicts.count('within |'))).replace('{all}', str(len(verdicts)))
    page.write_text(head + '\n'.join(lines) + '\n', encoding='utf-8')
    print(f'docs/evidence/reproduction.md: {len(written)} descriptions run, {len(missing)} not run')


if __name__ == '__main__':
    main()
