"""Runs of grit in several processes."""
import os
import shutil
from pathlib import Path

# Open MPI refuses to run as root otherwise, as in a container. Ranks on fewer cores let others compute while they wait.
ENVIRONMENT = ({'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1'} if os.geteuid() == 0 else {}) | {
    'OMPI_MCA_mpi_yield_when_idle': '1'}


def is_there(grit):
    """Whether this grit runs in several processes, and mpirun is there."""
    return shutil.which('mpirun') is not None and (Path(grit).parents[1] / 'lib/grit/mpi.so').is_file()


def words(ranks, command):
    """The command on so many ranks; one rank needs no MPI."""
    return ['mpirun', '--bind-to', 'none', '--oversubscribe', '-n', str(ranks), *command] if ranks > 1 else list(command)


def _stat(process):
    """Its state and its parent; neither if it has ended."""
    try:
        fields = Path(f'/proc/{process}/stat').read_text(encoding='ascii', errors='replace').rpartition(')')[2].split()
    except OSError:
        return None, None
    return fields[0], int(fields[1])


def processes_of(mpirun):
    """Process ids of the ranks that an mpirun has started on this machine."""
    return [int(folder.name) for folder in Path('/proc').glob('[0-9]*') if _stat(folder.name)[1] == mpirun]


def is_running(process):
    return _stat(process)[0] not in (None, 'Z')
