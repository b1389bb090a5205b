"""A Slurm of our own: munged, slurmctld and slurmd on this machine, with all their files in one folder."""
import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ('munged', 'slurmctld', 'slurmd', 'sbatch', 'squeue', 'scontrol', 'scancel', 'sinfo')

CONFIGURATION = """
ClusterName=grit
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName={host} NodeAddr=127.0.0.1 CPUs=4 RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Why there can be no Slurm here; empty if there can."""
    if os.geteuid() != 0:
        return 'only root starts the daemons of Slurm'
    absent = [name for name in PROGRAMS if shutil.which(name, path=search_path()) is None]
    return f'not installed: {", ".join(absent)}' if absent else ''


def search_path():
    return os.environ.get('PATH', '') + ':/usr/sbin:/sbin'


def free_port():
    with socket.socket() as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


class Slurm:
    """Started by `with`; ended, with its jobs, at the end."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.environment = dict(os.environ, PATH=search_path(), SLURM_CONF=str(self.folder / 'slurm.conf'))
        self.host = socket.gethostname().split('.')[0]

    def __enter__(self):
        for name in ('state', 'spool'):
            (self.folder / name).mkdir(parents=True)
        key = self.folder / 'munge.key'
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        (self.folder / 'slurm.conf').write_text(CONFIGURATION.format(
            host=self.host, folder=self.folder, controller_port=free_port(), node_port=free_port()))
        try:
            self.call('munged', f'--key-file={key}', f'--socket={self.folder}/munge.sock',
                      f'--pid-file={self.folder}/munged.pid', f'--log-file={self.folder}/munged.log',
                      f'--seed-file={self.folder}/munge.seed', '--force')
            self.call('slurmctld', '-f', self.folder / 'slurm.conf')
            self.call('slurmd', '-f', self.folder / 'slurm.conf', '-N', self.host)
            self.wait(lambda: 'idle' in self.call('sinfo', '--noheader', '--format=%T', check=False), 'a node')
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if (self.folder / 'slurmctld.pid').exists():
            self.call('scancel', '--user=root', check=False)
            deadline = time.monotonic() + 30
            while self.call('squeue', '--noheader', check=False) and time.monotonic() < deadline:
                time.sleep(0.2)
        daemons = [process for name in ('slurmd', 'slurmctld', 'munged') if (process := self.ended(name)) is not None]
        deadline = time.monotonic() + 15
        while any(Path(f'/proc/{process}').exists() for process in daemons) and time.monotonic() < deadline:
            time.sleep(0.02)

    def ended(self, name):
        """The process of a daemon, which is asked to end; None if there is none."""
        try:
            process = int((self.folder / f'{name}.pid').read_text())
            os.kill(process, 15)
        except (OSError, ValueError):
            return None
        return process

    def call(self, *words, check=True):
        outcome = subprocess.run([str(word) for word in words], env=self.environment, text=True, capture_output=True)
        if check and outcome.returncode != 0:
            raise RuntimeError(f'{words}: status {outcome.returncode}\n{outcome.stdout}{outcome.stderr}')
        return outcome.stdout.strip()

    def wait(self, holds, what, seconds=240):
        deadline = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > deadline:
                raise RuntimeError(f'after {seconds} s there is not {what}\n' + self.call('squeue', check=False))
            time.sleep(0.05)

    def state(self, task):
        """Of a task "JOB_INDEX": PENDING, RUNNING, COMPLETED, FAILED, …"""
        facts = self.call('scontrol', '--oneliner', 'show', 'job', task, check=False)
        return facts.partition('JobState=')[2].partition(' ')[0]
