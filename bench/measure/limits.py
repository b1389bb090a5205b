"""Measured limits of one core, and data and arithmetic of a step of the dense box."""
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

from . import disassembly, machine
from .machine import Complaint, DISTURBED

LINE = 64  # bytes
TRIAL_SECONDS = 0.01  # of a kernel
# A body's rows of position, velocity and spin; its sum of forces and moments.
BODY, SUM = 3 * 32, LINE
# Two indices of a contact, and a bit for contact.
INDICES = 2 * 4 + 1 / 8
# Index of a row, and of its body.
LETTER = 2 * 4


class Law(NamedTuple):
    kernel: int  # features of its loop in bench_kernels, as bits
    scene: int   # and in the dense box
    fields: int  # numbers of the contact history


# Shear and rolling; shear and damping, in the box damping of shear too; shear and damping.
LAWS = {'linear-rolling': Law(3, 3, 6), 'linear-frictional': Law(3, 7, 3), 'hertz-mindlin': Law(3, 3, 4)}


def plugins_of(program):
    return Path(program).parent.parent / 'lib' / 'grit' / 'contacts'


def flops(law, plugins, scene=False):
    """Arithmetic of one contact in a law's loop over pairs, from its disassembly."""
    objdump = shutil.which('objdump')
    if objdump is None:
        raise Complaint('there is no `objdump` to count flops; install binutils')
    file = plugins / f'{law}.so'
    if not file.is_file():
        raise Complaint(f'{file}: no such plugin; build it (cmake --build --preset release --target grit_plugins)')
    features, periodic = (LAWS[law].scene, 'true') if scene else (LAWS[law].kernel, 'false')
    name = f'pair_loop<grit::{law.title().replace("-", "")}, {features}u, grit::Pack<'
    for whole, instructions in disassembly.functions(objdump, file, name).items():
        if found := re.search(rf'Pack<(\d+)u?l?, double>, {periodic}, true, false>', whole):
            return disassembly.flops(instructions, int(found.group(1)))
    raise Complaint(f'{file}: has no loop {name}…, double>, {periodic}, true, false>; was it built from this tree?')


def contact_cost(law, contacts_per_grain, across, each):
    """Flops and bytes of one contact, with one load and one store of all data; `across` is the fraction of contacts between
    chunks, which write a row that the second body gathers; `each` is the number of flops."""
    grains = 2 / contacts_per_grain
    return each, INDICES + 2 * 8 * LAWS[law].fields + across * 2 * LINE + grains * (BODY + 2 * SUM)


def motion_cost(contacts_per_grain, across):
    """Flops and bytes of one body."""
    gathered = across * contacts_per_grain / 2
    return 90 + 8 * gathered, 2 * BODY + SUM + gathered * (LETTER + LINE)


class Limits(NamedTuple):
    memory: float  # bytes/s
    cache: float
    flops: float   # 1/s
    across: float  # fraction of contacts between chunks, in the dense kernels
    disturbed: bool

    def line(self):
        return (f'{self.memory * 1e-9:.0f} GB/s of memory, {self.cache * 1e-9:.0f} GB/s of caches, '
                f'{self.flops * 1e-9:.0f} Gflop/s' + (' !' if self.disturbed else ''))

    def share(self, law, each, window):
        """Speed of one thread in the dense box over its limit by arithmetic, caches or memory; as text."""
        contacts = window.contacts_per_grain / 2
        pair, body = contact_cost(law, window.contacts_per_grain, self.across, each), \
            motion_cost(window.contacts_per_grain, self.across)
        work, size = (contacts * pair[i] + body[i] for i in (0, 1))
        cached = window.facts['model']['bytes'] <= _last_cache()
        speed = window.particle_steps_per_second()
        allowed = min(self.flops / work, (self.cache if cached else self.memory) / size)
        return f"{speed / allowed:.0%}, {'caches' if cached else 'memory'} or arithmetic"


class Shares:
    """Speeds of a program in the dense box over the limits of the machine."""

    def __init__(self, program, allowed):
        self.program, self.allowed, self._flops = program, allowed, {}

    def of(self, law, threads, window):
        """As text; empty with more than one thread, as limits are those of a core."""
        if self.allowed is None or threads > 1:
            return ''
        try:
            if law not in self._flops:
                self._flops[law] = flops(law, plugins_of(self.program), scene=True)
        except Complaint as complaint:
            machine.say(f'no fraction of the limit: {complaint}')
            self.allowed = None
            return ''
        return self.allowed.share(law, self._flops[law], window)


def _last_cache():
    """Bytes; 16 MiB if unknown."""
    try:
        said = Path('/sys/devices/system/cpu/cpu0/cache/index3/size').read_text(encoding='ascii').strip()
        return int(said.rstrip('K')) << 10
    except (OSError, ValueError):
        return 16 << 20


def of_kernels(kernels):
    """Limits from the results of bench_kernels, by name."""
    across = [one['across_fraction'] for name, one in kernels.items() if name.startswith('contacts/') and 'across_fraction' in one]
    if not across:
        raise KeyError('across_fraction')
    return Limits(kernels['machine/triad/629145600']['bytes_per_s'], kernels['machine/triad/4194304']['bytes_per_s'],
                  kernels['machine/multiply-add']['flops_per_s'], across[-1], False)


def read(path):
    """Name → result, without statistics of repetitions."""
    return {one['name']: one for one in json.loads(Path(path).read_text(encoding='utf-8'))['benchmarks']
            if one.get('run_type') != 'aggregate'}


def kernels(program, pattern, cores=1, short=False):
    """(name → result, cores used by others) of the kernels that match `pattern`, on `cores` cores."""
    built = Path(program).parent / 'bench_kernels'
    if not built.is_file():
        raise Complaint(f'{built}: no such program; build it (scripts/install-deps.sh installs Google Benchmark, then cmake '
                        '--build --preset release --target bench_kernels)')
    with tempfile.TemporaryDirectory(prefix='grit-kernels-') as folder:
        out = Path(folder) / 'kernels.json'
        try:
            done = machine.run([built, f'--benchmark_filter={pattern}', f'--benchmark_min_time={TRIAL_SECONDS if short else 0.5}',
                                f'--benchmark_out={out}'], cores,
                               folder)
        except subprocess.CalledProcessError as error:
            raise Complaint(f'{built}: {machine.reason(error)}') from error
        times = read(out)
    for name, one in times.items():
        if one.get('error_occurred'):
            raise Complaint(f"{built}: {name} {one['error_message']}")
    return times, done.others


def measured(program, short=False):
    """(limits, their text for the head of the table); None if the kernels are not built beside the program, fail, or have no
    time left."""
    kernels = Path(program).parent / 'bench_kernels'
    if not kernels.is_file():
        return None, f'not measured: no {kernels} (scripts/install-deps.sh installs Google Benchmark)'
    with tempfile.TemporaryDirectory(prefix='grit-limits-') as folder:
        out = Path(folder) / 'kernels.json'
        try:
            done = machine.run([kernels, '--benchmark_filter=^machine/|^contacts/linear-rolling/10000$',
                                f'--benchmark_min_time={TRIAL_SECONDS if short else 0.2}', f'--benchmark_out={out}'], 1, folder)
            limits = of_kernels(read(out))
        except (subprocess.CalledProcessError, machine.OutOfTime, OSError, ValueError, KeyError) as error:
            if isinstance(error, KeyError):
                reason = f'measures no {error}; build it again (--target bench_kernels)'
            else:
                told = isinstance(error, (subprocess.CalledProcessError, machine.OutOfTime))
                reason = machine.reason(error) if told else repr(error)
            return None, f'not measured: {kernels}: {reason}'
    limits = limits._replace(disturbed=done.others > DISTURBED)
    return limits, limits.line()
