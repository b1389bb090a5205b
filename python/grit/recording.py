"""Values that a function in Python records during a run."""

from collections.abc import Mapping

import numpy

from . import optional
from .errors import Error, UnknownName


class Recording(Mapping):
    """Values by name as arrays, one row per sample, with `time` [s] and `step`."""

    def __init__(self, name, units, is_unit):
        self.name, self._given = name, {} if units is None else units
        if not isinstance(self._given, Mapping):
            raise TypeError(f"units: found {units!r}; allowed is a dict {{\"value\": \"unit\"}}, such as {{\"pressure\": \"Pa\"}}")
        for value, unit in self._given.items():
            if not isinstance(unit, str) or not is_unit(unit):
                raise ValueError(f"units: found {unit!r} for {value!r}; allowed is a unit, such as \"Pa\", \"kN m\", \"1/s\", or \"1\" for a number without one")
        self._units = {"time": "s", "step": "1", **self._given}
        self._rows = {"time": [], "step": []}

    def add(self, time, step, values):
        if not isinstance(values, Mapping):
            raise Error(f"probe {self.name!r} returned {type(values).__name__}; allowed is a dict of numbers, such as {{\"pressure\": 1.0}}")
        try:
            row = {str(key): float(value) for key, value in values.items()}
        except (TypeError, ValueError, OverflowError) as error:
            raise Error(f"probe {self.name!r} returned a value that is no number: {error}; give one name to each component of a vector") from error
        known = self._rows.keys() - {"time", "step"}
        if self._rows["time"] and row.keys() != known:
            raise Error(f"probe {self.name!r} returned {sorted(row)}; allowed are the names of its first sample: {sorted(known)}")
        if wrong := row.keys() & {"time", "step"}:
            raise Error(f"probe {self.name!r} returned {sorted(wrong)}, which every sample has; choose other names")
        if unknown := [key for key in self._given if key not in row]:
            raise Error(f"probe {self.name!r} has a unit of {unknown[0]!r}, which it does not return; it returns {sorted(row)}")
        for key, value in {"time": time, "step": step, **row}.items():
            self._rows.setdefault(key, []).append(value)

    def __getitem__(self, name):
        if name not in self._rows:
            raise UnknownName("value", name, list(self))
        return numpy.array(self._rows[name])

    def __iter__(self):
        return iter(self._rows)

    def __len__(self):
        return len(self._rows)

    def __repr__(self):
        return f"<recording {self.name!r}: {len(self._rows['time'])} samples of {', '.join(self)}>"

    def units(self, name):
        """The unit that was given for a value; "" for none."""
        if name not in self._rows:
            raise UnknownName("value", name, list(self))
        return self._units.get(name, "")

    def to_pandas(self):
        """A pandas DataFrame, with `time` as its index."""
        return _by_time(self)


class Samples(Mapping):
    """What a probe of the description has sampled so far: channels by name as arrays, one row per sample, with `time` [s] and `step`."""

    def __init__(self, core, name):
        self.name, self._core = name, core
        self._about = {channel: (unit, about) for channel, unit, about in core.probes()[name]}

    def __getitem__(self, name):
        self._of(name)
        return self._core.samples(self.name, name)

    def _of(self, name):
        if name not in self._about:
            raise UnknownName("channel", name, list(self))
        return self._about[name]

    def __iter__(self):
        return iter(self._about)

    def __len__(self):
        return len(self._about)

    def __repr__(self):
        return f"<probe {self.name!r}: {len(self['time'])} samples of {', '.join(self)}>"

    def units(self, name):
        """Unit in UDUNITS notation, "1" if dimensionless."""
        return self._of(name)[0]

    def about(self, name):
        """Description of a channel."""
        return self._of(name)[1]

    def to_pandas(self):
        """A pandas DataFrame of the channels with one value a sample, with `time` as its index."""
        return _by_time({name: values for name, values in self.items() if values.ndim == 1})


def _by_time(columns):
    return optional.module("pandas", "python3-pandas", "to_pandas").DataFrame(dict(columns)).set_index("time")
