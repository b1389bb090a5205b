"""Results of grit as numpy arrays.

    import grit
    run = grit.open("results/box")
    run.status, run.bodies, run.description["title"]
    run.series["packing/coordination_number"]         # numpy array; run.series.units(...) returns its unit
    run.frames[-1].bodies["position"]                 # n × 3, m

Units are SI; names are those of docs/results.md. No file is kept open, so that a running simulation can be read repeatedly.
"""

import difflib
import fcntl
import json
import pathlib
import struct
import time
from collections.abc import Mapping, Sequence

import h5py
import numpy

__all__ = ["open", "Run", "Series", "Frames", "Frame", "Table", "Wall", "ResultsError"]


class ResultsError(Exception):
    """A folder or a file that `grit run` has not written, or not yet."""


class UnknownName(KeyError):
    """An unknown name; the message lists the known ones."""

    def __init__(self, what, name, names):
        super().__init__(name)
        near = difflib.get_close_matches(str(name), names, 1)
        listed = ", ".join(names) if names else "none"
        self.message = f"there is no {what} {name!r}" + (f"; did you mean {near[0]!r}?" if near else "") + f" There are: {listed}"

    def __str__(self):
        return self.message


def open(folder):
    """The run in a results folder. Raises ResultsError if the folder holds no results."""
    return Run(folder)


# Seconds. A run flushes its series every second, which takes some milliseconds; in between its file rests. _REST is longer than the
# resolution of file times.
_REST, _PATIENCE = 0.02, 5


def _stamp(path):
    try:
        state = path.stat()
    except FileNotFoundError:
        raise ResultsError(f"{path}: there is no such file") from None
    return state.st_mtime_ns, state.st_size


def _is_being_written(path):
    """Whether a run has marked the file: a lock that readers query but never take."""
    with path.open("rb") as file:
        lock = struct.pack("hhqqi0q", fcntl.F_RDLCK, 0, 0, 0, 0)  # struct flock: type, whence, start, length, process
        try:
            return struct.unpack("hhqqi0q", fcntl.fcntl(file, fcntl.F_OFD_GETLK, lock))[0] != fcntl.F_UNLCK
        except OSError:  # file system without locks
            return False


def _read(path, act):
    """The result of `act` on the open file, repeated until the file was not written meanwhile."""
    until = time.monotonic() + _PATIENCE
    while True:
        before, failure = _stamp(path), None
        rested = not 0 <= time.time_ns() - before[0] < _REST * 1e9 and not _is_being_written(path)
        try:
            with h5py.File(path, "r") as file:
                found = act(file)
        except (OSError, RuntimeError, KeyError) as error:
            failure = error
        if rested and not _is_being_written(path) and _stamp(path) == before:
            break
        if time.monotonic() > until:
            raise ResultsError(f"{path}: has been written to for {_PATIENCE} s; try again, or check whether its run is suspended")
        time.sleep(_REST)
    if isinstance(failure, KeyError):
        raise failure
    if failure:
        raise ResultsError(f"{path}: cannot be read: {failure}; the file is damaged") from failure
    return found


class Table(Mapping):
    """The datasets of a group by name, as arrays whose first dimension is the row. Read on access."""

    def __init__(self, path, group, what):
        self._path, self._group, self._what = path, group, what

    def _use(self, act):
        return _read(self._path, lambda file: act(file[self._group] if self._group in file else {}))

    def _of(self, name, act):
        def get(group):
            if name not in group or not isinstance(group[name], h5py.Dataset):
                raise UnknownName(self._what, name, sorted(group))
            return act(group[name])
        return self._use(get)

    def __getitem__(self, name):
        return self._of(name, lambda dataset: dataset[()])

    def __iter__(self):
        return iter(self._use(lambda group: sorted(group)))

    def __len__(self):
        return self._use(len)

    def __repr__(self):
        return f"<{self._what}s of {self._path}: {', '.join(self)}>"

    def units(self, name):
        """Unit in UDUNITS notation, "1" if dimensionless."""
        return self._of(name, lambda dataset: dataset.attrs["units"])

    def about(self, name):
        """Description of the dataset."""
        return self._of(name, lambda dataset: dataset.attrs["long_name"])

    def all(self):
        """All datasets, read at one instant: {name: array}. They have equal lengths even while the run continues."""
        return self._use(lambda group: {name: group[name][()] for name in sorted(group)})

    def records(self):
        """All datasets as one structured array, one record per row."""
        columns = self.all()
        kinds = [(name, column.dtype, column.shape[1:]) for name, column in columns.items()]
        records = numpy.empty(len(next(iter(columns.values()), ())), dtype=kinds)
        for name, column in columns.items():
            records[name] = column
        return records


def _channels(file):
    return [f"{probe}/{channel}" for probe in file for channel in file[probe]]


class Series(Mapping):
    """Channels of all probes, as "probe/channel": arrays whose rows are samples."""

    def __init__(self, path):
        self._path = path

    def __getitem__(self, name):
        return self._of(name, lambda dataset: dataset[()])

    def _of(self, name, act):
        def get(file):
            probe, _, channel = str(name).partition("/")
            if probe not in file or channel not in file[probe]:
                raise UnknownName("channel", name, _channels(file))
            return act(file[probe][channel])
        return _read(self._path, get)

    def __iter__(self):
        return iter(_read(self._path, _channels))

    def __len__(self):
        return len(list(iter(self)))

    def __repr__(self):
        return f"<series of {self._path}: {', '.join(self)}>"

    def units(self, name):
        return self._of(name, lambda dataset: dataset.attrs["units"])

    def about(self, name):
        return self._of(name, lambda dataset: dataset.attrs["long_name"])

    def probe(self, name):
        """All channels of a probe, read at one instant: {channel: array}. They have equal lengths even while the run continues."""
        def get(file):
            if name not in file:
                raise UnknownName("probe", name, list(file))
            return {channel: dataset[()] for channel, dataset in file[name].items()}
        return _read(self._path, get)


class Wall:
    """A wall in one frame: `triangles` t × 3 × 3 corners [m], `index`, `pressure` [Pa], `displacement` [m], `force` [N]."""

    def __init__(self, dataset):
        self.triangles = dataset[()]
        self.index = int(dataset.attrs["index"])
        self.pressure = float(dataset.attrs["pressure"])
        self.displacement, self.force = (numpy.array([dataset.attrs[f"{name}_{axis}"] for axis in "xyz"]) for name in ("displacement", "force"))


class Frame:
    """The world at one instant: `time` [s], `step`, `stage`; tables `bodies`, `contacts`, `clumps`; `walls` and `probes` by name."""

    def __init__(self, path):
        self.path = path
        attributes, self.walls, probes = _read(path, lambda file: (dict(file.attrs), {name: Wall(wall) for name, wall in file["walls"].items()}, list(file["probes"])))
        self.time, self.step, self.stage = float(attributes["time"]), int(attributes["step"]), str(attributes["stage"])
        self.probes = {name: Table(path, f"probes/{name}", "field") for name in probes}
        self.bodies, self.contacts, self.clumps = (Table(path, group, "array") for group in ("bodies", "contacts", "clumps"))

    def __repr__(self):
        return f"<frame {self.path}: {self.time:g} s, stage {self.stage!r}>"


class Frames(Sequence):
    """The frames of a run in order, including those written after the run was opened."""

    def __init__(self, folder):
        self._folder = folder

    def _files(self):
        return sorted(self._folder.glob("*.h5"))

    def __len__(self):
        return len(self._files())

    def __getitem__(self, index):
        files = self._files()
        if isinstance(index, slice):
            return [Frame(path) for path in files[index]]
        try:
            return Frame(files[index])
        except IndexError:
            raise IndexError(f"{self._folder}: there is no frame {index} of {len(files)}") from None


class Run:
    """The results of a finished or continuing run. Keys of run.json are attributes, such as `status`, `time`, `bodies`, `description`."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        path = self.folder / "run.json"
        try:
            self.json = json.loads(path.read_text())
        except (FileNotFoundError, NotADirectoryError):
            raise ResultsError(f"{self.folder}: holds no run (no run.json); give a folder that 'grit run' has written") from None
        except ValueError as error:
            raise ResultsError(f"{path}: not JSON: {error}") from error
        self.series = Series(self.folder / "series.h5")
        self.frames = Frames(self.folder / "frames")

    def __getattr__(self, name):
        if name.startswith("_") or "json" not in self.__dict__:
            raise AttributeError(name)
        try:
            return self.json[name]
        except KeyError:
            raise AttributeError(str(UnknownName("key of run.json", name, list(self.json)))) from None

    def __dir__(self):
        return [*super().__dir__(), *self.json]

    def __repr__(self):
        return f"<run {self.folder}: {self.status}>"
