"""An engine whose forces a function in Python returns."""

import numpy

from .errors import Error


class Engine:
    """`function` as it was given, `acts` as one that takes the simulation."""

    def __init__(self, name, function, acts):
        self.name, self.function, self._acts = name, function, acts

    def act(self, simulation, bodies):
        """Forces and moments: arrays with one row per body, or None."""
        result = self._acts(simulation)
        if isinstance(result, tuple):
            if len(result) != 2:
                raise Error(f"engine {self.name!r} returned {len(result)} values; allowed are forces, or a pair of forces and moments")
            return self._rows(result[0], bodies), self._rows(result[1], bodies)
        return self._rows(result, bodies), None

    def _rows(self, values, bodies):
        if values is None:
            return None
        try:
            given = numpy.asarray(values, dtype=float)
        except (TypeError, ValueError, OverflowError) as error:
            raise Error(f"engine {self.name!r} returned {type(values).__name__}, which is no array of numbers: {error}") from error
        if given.shape not in ((3,), (bodies, 3)):
            raise Error(f"engine {self.name!r} returned an array of shape {given.shape}; allowed are ({bodies}, 3), a row for each body, and (3,), the same for all")
        return numpy.ascontiguousarray(numpy.broadcast_to(given, (bodies, 3)))
