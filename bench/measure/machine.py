"""The machine, and timed processes."""
import contextlib
import datetime
import os
import platform
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

# A run is disturbed if other processes take more than this fraction of one core.
DISTURBED = 0.05


class Complaint(Exception):
    """An error that the caller can correct: where, what was found, what is allowed, what to do."""


class Run(NamedTuple):
    output: str
    seconds: float
    others: float  # cores that all other processes kept busy meanwhile


def facts():
    cpu = next((line.split(':', 1)[1].strip() for line in Path('/proc/cpuinfo').read_text().splitlines()
                if line.startswith('model name')), platform.processor() or 'unknown')
    return {'cpu': cpu, 'cores': os.cpu_count(), 'system': platform.platform(),
            'load_average': [round(x, 2) for x in os.getloadavg()],
            'date': datetime.datetime.now(datetime.timezone.utc).strftime('%Y-%m-%dT%H:%M:%SZ'),
            'command': ' '.join([os.path.relpath(sys.argv[0]), *sys.argv[1:]])}


def head(state):
    """The lines above a table: machine, date and command."""
    lines = [f"`{state['command']}`, {state['date']}",
             f"{state['cpu']}, {state['cores']} cores, {state['system']}; load at the start "
             + ' '.join(map(str, state['load_average']))]
    lines += [f'{key}: {value}' for key, value in state.items()
              if key not in ('cpu', 'cores', 'system', 'load_average', 'date', 'command')]
    return '\n'.join(f'- {line}' for line in lines) + '\n'


def cores(threads):
    """The cores to which so many threads are pinned."""
    mine = sorted(os.sched_getaffinity(0))
    if threads > len(mine):
        raise Complaint(f'found {threads} threads; this process may use {len(mine)} cores; use fewer threads, or allow more cores '
                        '(taskset, cgroups)')
    return mine[:threads]


def _all_busy():
    # user, nice, system, irq, softirq; time taken by the host of a virtual machine is not included
    ticks = [int(word) for word in Path('/proc/stat').read_text().split('\n', 1)[0].split()[1:]]
    return (ticks[0] + ticks[1] + ticks[2] + ticks[5] + ticks[6]) / os.sysconf('SC_CLK_TCK')


def _own_busy():
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _busy_of(pid):
    """CPU time of a running process [s]."""
    # After the name, which may have spaces: state is field 3, user and system time 14 and 15.
    words = Path(f'/proc/{pid}/stat').read_text(encoding='ascii', errors='replace').rpartition(')')[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf('SC_CLK_TCK')


class Watch:
    """Elapsed time, and the number of cores that others keep busy meanwhile: without this process, its children, and
    `friends` (process ids), which must outlive the watch."""

    def __init__(self, friends=()):
        self.friends = friends
        self.begin, self.busy, self.own = time.perf_counter(), _all_busy(), self._ours()

    def _ours(self):
        return _own_busy() + sum(map(_busy_of, self.friends))

    def seconds(self):
        return time.perf_counter() - self.begin

    def others(self):
        return max(0.0, (_all_busy() - self.busy) - (self._ours() - self.own)) / self.seconds()


def pinned(command, threads):
    taskset = shutil.which('taskset')
    if taskset is None:
        raise Complaint('there is no `taskset` to pin threads; install util-linux')
    return [taskset, '-c', ','.join(map(str, cores(threads))), *map(str, command)]


@contextlib.contextmanager
def started(command, threads, folder, environment=None, **streams):
    """A running command, pinned to as many cores as it has threads. It and its children are killed at the end of the block."""
    environment = os.environ | {'OMP_NUM_THREADS': '1'} | (environment or {})
    # A separate session, so that its children can be killed with it.
    with subprocess.Popen(pinned(command, threads), cwd=folder, env=environment, text=True, errors='replace',
                          start_new_session=True, **streams) as process:
        try:
            yield process
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


class OutOfTime(Complaint):
    """A run exceeded its time limit."""


_deadline = None


def end_within(seconds):
    """Limits the total time of all runs from now on."""
    global _deadline
    _deadline = time.monotonic() + seconds


def time_left():
    return float('inf') if _deadline is None else _deadline - time.monotonic()


def run(command, threads, folder, environment=None, timeout=1800, friends=()):
    """Runs a command pinned to as many cores as it has threads. Raises CalledProcessError if it fails."""
    timeout = min(timeout, time_left())
    if timeout <= 0:
        raise OutOfTime('there is no time left')
    watch = Watch(friends)
    with started(command, threads, folder, environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        try:
            output, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            raise OutOfTime(f'did not end within {timeout:.0f} s, and was stopped: '
                            + ' '.join(map(str, command))) from None
    seconds, others = watch.seconds(), watch.others()
    if process.returncode != 0:
        raise subprocess.CalledProcessError(process.returncode, command, output)
    return Run(output, seconds, others)


def reason(error):
    """Message of a Complaint, or of a CalledProcessError with the last lines of its output."""
    if isinstance(error, Complaint):
        return str(error)
    said = (error.output or error.stderr or '').splitlines()[-20:]
    return '\n'.join([f'exit status {error.returncode} of: ' + ' '.join(map(str, error.cmd)), *said])


def say(line):
    print(line, file=sys.stderr, flush=True)


def main(work):
    """Calls work() and turns exceptions into a line on standard error and an exit status."""
    name = os.path.relpath(sys.argv[0])
    # Both signals stop started processes and clean up.
    for stop in (signal.SIGINT, signal.SIGTERM):
        signal.signal(stop, signal.default_int_handler)
    try:
        sys.exit(work())
    except (Complaint, subprocess.CalledProcessError) as error:
        say(f'{name}: {reason(error)}')
        sys.exit(2 if isinstance(error, Complaint) else 1)
    except KeyboardInterrupt:
        sys.exit(130)
