"""Results of grit as numpy arrays.

    import grit
    run = grit.open("results/box")
    run.status, run.bodies, run.description["title"]
    run.series["packing/coordination_number"]         # numpy array; run.series.units(...) returns its unit
    run.frames[-1].bodies["position"]                 # n × 3, m

Units are SI; names are those of docs/results.md. No file is kept open, so that a running simulation can be read repeatedly.
Damaged files, and files that grit did not write, raise ResultsError: the HDF5 library may crash at them, so that they are
checked first.
"""

import fcntl
import json
import pathlib
import stat
import struct
import time
import zlib
from collections.abc import Mapping, Sequence

import h5py
import numpy

from . import optional
from .errors import ResultsError, UnknownResult


def open(folder):
    """The run in a results folder. Raises ResultsError if the folder holds no results."""
    return Run(folder)


# Seconds. A run flushes its series every second, which takes some milliseconds; in between its file rests. _REST is longer than the
# resolution of file times.
_REST, _PATIENCE = 0.02, 5


_KINDS = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a named pipe", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device", stat.S_IFSOCK: "a socket"}


def _stamp(path):
    """Time and length of a regular file. Others are refused before they are opened: reading a pipe may never end."""
    try:
        state = path.stat()
    except FileNotFoundError as error:
        raise ResultsError(f"{path}: there is no such file") from error
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror}") from error
    if not stat.S_ISREG(state.st_mode):
        kind = _KINDS.get(stat.S_IFMT(state.st_mode), "something else")
        raise ResultsError(f"{path}: is {kind}, not a file that grit wrote; restore it, or run the description again")
    return state.st_mtime_ns, state.st_size


def _is_being_written(path):
    """Whether a run has marked the file: a lock that readers query but never take."""
    lock = struct.pack("hhqqi0q", fcntl.F_RDLCK, 0, 0, 0, 0)  # struct flock: type, whence, start, length, process
    try:
        with path.open("rb") as file:
            return struct.unpack("hhqqi0q", fcntl.fcntl(file, fcntl.F_OFD_GETLK, lock))[0] != fcntl.F_UNLCK
    except OSError:  # a file system without locks, or a file that cannot be read
        return False


# The last line of a complete series.h5: its length and CRC-32, see storage/seal.hpp.
_SEAL = b"\ngrit seal "
_SEAL_LENGTH = len(_SEAL) + 26
_sealed = {}  # stamps of files whose seals were right


def _check_seal(path):
    """Raises ResultsError if the file was complete and has been changed since."""
    stamp = _stamp(path)
    if _sealed.get(path) == stamp:
        return
    with path.open("rb") as file:
        file.seek(-min(_SEAL_LENGTH, stamp[1]), 2)
        end = file.read()
        if not end.startswith(_SEAL):
            # The seal was the last that a run that is done wrote to its series.
            if path.name == "series.h5" and _run_json(path.parent)["status"] == "done":
                raise ResultsError(f"{path}: is damaged: its run is done, and the checksum at its end is missing; copy it again, or run the description again")
            return
        file.seek(0)
        left, checksum = stamp[1] - _SEAL_LENGTH, 0
        while left and (piece := file.read(min(left, 1 << 20))):
            checksum, left = zlib.crc32(piece, checksum), left - len(piece)
    if end != _SEAL + b"%016x %08x\n" % (stamp[1] - _SEAL_LENGTH, checksum):
        raise ResultsError(f"{path}: is damaged, or was changed by another program: its checksum differs")
    _sealed[path] = stamp


def _check_frame(path):
    """Raises ResultsError for a frame whose metadata have no checksums."""
    with path.open("rb") as file:
        first = file.read(9)
    if first.startswith(b"\x89HDF\r\n\x1a\n") and first[8:] < b"\x03":
        raise ResultsError(f"{path}: is of an earlier version of grit, without checksums; run the description again")


def _refuse(thing, what):
    raise ResultsError(f"{thing.file.filename}{thing.name}: {what}; the file is damaged or not of grit")


def _attribute(thing, name):
    """An attribute, of a number or a text. Texts of variable length are refused: the library crashes at damaged ones."""
    if name not in thing.attrs:
        _refuse(thing, f"lacks the attribute {name!r}")
    found = thing.attrs.get_id(name)
    if found.dtype.kind not in "iufS" or found.shape != ():
        _refuse(thing, f"its attribute {name!r} is neither a number nor a text of fixed length")
    value = thing.attrs[name]
    return value.decode() if isinstance(value, bytes) else value


def _number(thing, name):
    value = _attribute(thing, name)
    if isinstance(value, str):
        _refuse(thing, f"its attribute {name!r} is a text, not a number")
    return value


def _text(thing, name):
    value = _attribute(thing, name)
    if not isinstance(value, str):
        _refuse(thing, f"its attribute {name!r} is a number, not a text")
    return value


def _member(group, name, kind):
    """A group or dataset, but no link to another file."""
    link = group.get(name, getlink=True)
    if link is None:
        _refuse(group, f"lacks {name!r}")
    if not isinstance(link, h5py.HardLink):
        _refuse(group, f"{name!r} is a link")
    if not isinstance(group[name], kind):
        _refuse(group, f"{name!r} is no {kind.__name__.lower()}")
    return group[name]


def _group(group, path):
    """A group inside groups, by the names on the way to it."""
    for name in path.split("/"):
        group = _member(group, name, h5py.Group)
    return group


def _dataset(group, name):
    return _member(group, name, h5py.Dataset)


def _numbers(dataset):
    """All numbers of a dataset, if the file is long enough for them."""
    properties = dataset.id.get_create_plist()
    filters = [properties.get_filter(i)[0] for i in range(properties.get_nfilters())]
    if dataset.dtype.kind not in "iuf" or dataset.external or dataset.is_virtual or set(filters) - {h5py.h5z.FILTER_FLETCHER32}:
        _refuse(dataset, "does not hold plain numbers")
    length = dataset.file.id.get_filesize()
    if dataset.nbytes > length:
        _refuse(dataset, f"has more numbers than a file of {length} bytes can hold")
    return dataset[()]


def _read(path, act, check=_check_seal):
    """The result of `act` on the open file, repeated until the file was not written meanwhile. `check` comes before the library."""
    until = time.monotonic() + _PATIENCE
    while True:
        before, failure = _stamp(path), None
        rested = not 0 <= time.time_ns() - before[0] < _REST * 1e9 and not _is_being_written(path)
        try:
            check(path)
            with h5py.File(path, "r") as file:
                found = act(file)
        except (ArithmeticError, LookupError, OSError, RuntimeError, TypeError, ValueError, ResultsError) as error:
            failure = error
        if rested and not _is_being_written(path) and _stamp(path) == before:
            break
        if time.monotonic() > until:
            raise ResultsError(f"{path}: has been written to for {_PATIENCE} s; try again, or check whether its run is suspended")
        time.sleep(_REST)
    if isinstance(failure, ResultsError):
        raise failure
    if failure:
        raise ResultsError(f"{path}: cannot be read: {failure}; the file is damaged") from failure
    return found


class Table(Mapping):
    """The datasets of a group by name, as arrays whose first dimension is the row. Read on access."""

    def __init__(self, path, group, what):
        self._path, self._group, self._what = path, group, what

    def _use(self, act):
        return _read(self._path, lambda file: act(_group(file, self._group) if self._group in file else {}), _check_frame)

    def _of(self, name, act):
        def get(group):
            if name not in list(group):
                raise UnknownResult(self._what, name, sorted(group))
            return act(_dataset(group, name))
        return self._use(get)

    def __getitem__(self, name):
        return self._of(name, _numbers)

    def __iter__(self):
        return iter(self._use(lambda group: sorted(group)))

    def __len__(self):
        return self._use(len)

    def __repr__(self):
        return f"<{self._what}s of {self._path}: {', '.join(self)}>"

    def units(self, name):
        """Unit in UDUNITS notation, "1" if dimensionless."""
        return self._of(name, lambda dataset: _text(dataset, "units"))

    def about(self, name):
        """Description of the dataset."""
        return self._of(name, lambda dataset: _text(dataset, "long_name"))

    def all(self):
        """All datasets, read at one instant: {name: array}. They have equal lengths even while the run continues."""
        return self._use(lambda group: {name: _numbers(_dataset(group, name)) for name in sorted(group)})

    def records(self):
        """All datasets as one structured array, one record per row."""
        columns = self.all()
        rows = {column.shape[:1] for column in columns.values()}
        if () in rows or len(rows) > 1:
            raise ResultsError(f"{self._path}/{self._group}: its {self._what}s have different numbers of rows; read them with all()")
        kinds = [(name, column.dtype, column.shape[1:]) for name, column in columns.items()]
        records = numpy.empty(len(next(iter(columns.values()), ())), dtype=kinds)
        for name, column in columns.items():
            records[name] = column
        return records


def _channels(file):
    return [f"{probe}/{channel}" for probe in file for channel in _group(file, probe)]


class Series(Mapping):
    """Channels of all probes, as "probe/channel": arrays whose rows are samples."""

    def __init__(self, path):
        self._path = path

    def __getitem__(self, name):
        return self._of(name, _numbers)

    def _of(self, name, act):
        def get(file):
            probe, _, channel = str(name).partition("/")
            if probe not in list(file) or channel not in list(_group(file, probe)):
                raise UnknownResult("channel", name, _channels(file))
            return act(_dataset(_group(file, probe), channel))
        return _read(self._path, get)

    def __iter__(self):
        return iter(_read(self._path, _channels))

    def __len__(self):
        return len(list(iter(self)))

    def __repr__(self):
        return f"<series of {self._path}: {', '.join(self)}>"

    def units(self, name):
        return self._of(name, lambda dataset: _text(dataset, "units"))

    def about(self, name):
        return self._of(name, lambda dataset: _text(dataset, "long_name"))

    def probe(self, name):
        """All channels of a probe, read at one instant: {channel: array}. They have equal lengths even while the run continues."""
        def get(file):
            if name not in list(file):
                raise UnknownResult("probe", name, list(file))
            probe = _group(file, name)
            return {channel: _numbers(_dataset(probe, channel)) for channel in probe}
        return _read(self._path, get)


class Wall:
    """A wall in one frame: `triangles` t × 3 × 3 corners [m], `index`, `pressure` [Pa], `displacement` [m], `force` [N]."""

    def __init__(self, dataset):
        self.triangles = _numbers(dataset)
        self.index, self.pressure = int(_number(dataset, "index")), float(_number(dataset, "pressure"))
        self.displacement, self.force = (numpy.array([_number(dataset, f"{name}_{axis}") for axis in "xyz"]) for name in ("displacement", "force"))


class Frame:
    """The world at one instant: `time` [s], `step`, `stage`; tables `bodies`, `contacts`, `clumps`; `walls` and `probes` by name."""

    def __init__(self, path):
        self.path = path
        def get(file):
            walls = _group(file, "walls")
            return (float(_number(file, "time")), int(_number(file, "step")), _text(file, "stage"),
                    {name: Wall(_dataset(walls, name)) for name in walls}, list(_group(file, "probes")))
        self.time, self.step, self.stage, self.walls, probes = _read(path, get, _check_frame)
        self.probes = {name: Table(path, f"probes/{name}", "field") for name in probes}
        self.bodies, self.contacts, self.clumps = (Table(path, group, "array") for group in ("bodies", "contacts", "clumps"))

    def __repr__(self):
        return f"<frame {self.path}: {self.time:g} s, stage {self.stage!r}>"


class Frames(Sequence):
    """The frames of a run in order, including those written after the run was opened."""

    def __init__(self, folder):
        self._folder = folder

    def _files(self):
        try:
            return sorted(path for path in self._folder.iterdir() if path.suffix == ".h5")
        except FileNotFoundError:  # a run without frames
            return []
        except OSError as error:
            raise ResultsError(f"{self._folder}: cannot be read: {error.strerror}; restore the folder") from error

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


def _run_json(folder):
    """The facts in run.json: an object with a status."""
    path = folder / "run.json"
    try:
        _stamp(path)
        facts = json.loads(path.read_bytes())
    except ResultsError as error:
        if isinstance(error.__cause__, (FileNotFoundError, NotADirectoryError)):
            raise ResultsError(f"{folder}: holds no run (no run.json); give a folder that 'grit run' has written") from None
        raise
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise ResultsError(f"{path}: not JSON: {error}") from error
    if not isinstance(facts, dict) or not isinstance(facts.get("status"), str):
        raise ResultsError(f"{path}: is no JSON object with a text 'status'; the file is damaged or not of grit")
    return facts


class Run:
    """The results of a finished or continuing run. Keys of run.json are attributes, such as `status`, `time`, `bodies`, `description`."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.json = _run_json(self.folder)
        self.series = Series(self.folder / "series.h5")
        self.frames = Frames(self.folder / "frames")

    def plot(self, *names, against=None, axes=None):
        """Draws channels of single numbers, "probe/channel", over time or over the channel `against`, with matplotlib. Returns its axes."""
        axes = axes or optional.module("matplotlib.pyplot", "python3-matplotlib", "run.plot").subplots()[1]
        for name in names:
            x = against or f"{name.partition('/')[0]}/time"
            axes.plot(self.series[x], self.series[name], label=name)
            axes.set_xlabel(f"{x} [{self.series.units(x)}]")
            axes.set_ylabel(f"{name} [{self.series.units(name)}]" if len(names) == 1 else "")
        if len(names) > 1:
            axes.legend()
        return axes

    def show(self):
        """The grains of the last frame as `grit report --png` draws them, as a picture, which notebooks show. Needs the compiled module."""
        from .picture import Picture
        from .simulation import _grit
        return Picture(_grit.picture_of_run(str(self.folder)))

    def __getattr__(self, name):
        if name.startswith("_") or "json" not in self.__dict__:
            raise AttributeError(name)
        try:
            return self.json[name]
        except KeyError:
            raise AttributeError(str(UnknownResult("key of run.json", name, list(self.json)))) from None

    def __dir__(self):
        return [*super().__dir__(), *self.json]

    def __repr__(self):
        return f"<run {self.folder}: {self.status}>"
