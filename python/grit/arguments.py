"""Arguments of calls, checked and converted. Errors say what was found and what is allowed."""

import json
import math
import numbers
import operator
import os
import sys
from collections.abc import Mapping

import numpy

from .errors import DescriptionError, Problem

_MOST_STEPS = 2**63 - 1
_LARGEST = sys.float_info.max
_MOST_LEVELS = 100  # as in files
_ALLOWED = "allowed are dicts, lists, finite numbers, texts, True, False and None"


def shown(value):
    """A value in a message."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return f"a whole number of about {round(value.bit_length() * math.log10(2))} digits"
    try:
        text = repr(value)
    except ValueError:  # of integers with thousands of digits
        return "one that is too long to be shown"
    return text if len(text) <= 80 else text[:80] + "…"


def _refuse(name, value, allowed, error=TypeError):
    found = shown(value) if isinstance(value, (bool, numbers.Number, str)) else f"a value of type {type(value).__name__}"
    raise error(f"{name}: found {found}; allowed is {allowed}") from None


def whole(name, value, least, most=math.inf):
    """A whole number."""
    allowed = f"a whole number from {least}" + (f" to {most}" if most < math.inf else "")
    try:
        number = operator.index(value)
    except TypeError:
        _refuse(name, value, allowed)
    if isinstance(value, bool):
        _refuse(name, value, allowed)
    if not least <= number <= most:
        _refuse(name, value, allowed, ValueError)
    return min(number, _MOST_STEPS)


def positive(name, value):
    """A finite number above 0."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        _refuse(name, value, "a number above 0")
    if not 0 < value <= _LARGEST:
        _refuse(name, value, "a finite number above 0", ValueError)
    return float(value)


def not_negative(name, value):
    """A finite number from 0."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        _refuse(name, value, "a number from 0")
    if not 0 <= value <= _LARGEST:
        _refuse(name, value, "a finite number from 0", ValueError)
    return float(value)


def text(name, value, example):
    """A text that is not empty."""
    if not isinstance(value, str):
        _refuse(name, value, f"a text such as {example!r}")
    if not value:
        _refuse(name, value, f"a text such as {example!r}", ValueError)
    return value


def path(name, value, allowed="the path of a file"):
    """A path, as a text."""
    if not isinstance(value, (str, os.PathLike)):
        _refuse(name, value, allowed)
    value = os.fsdecode(value)
    if not value or "\0" in value:
        _refuse(name, value, allowed, ValueError)
    return value


def several(name, value, allowed):
    """What can be iterated over, as a list."""
    try:
        return list(value)
    except TypeError:
        _refuse(name, value, allowed)


def folders(name, value):
    """One path or several, as texts."""
    allowed = "the path of a folder, or a list of them"
    values = [value] if isinstance(value, (str, os.PathLike)) else several(name, value, allowed)
    return [path(name, one, allowed) for one in values]


def box(low, high):
    """The corners of a box; None for none."""
    if (low is None) != (high is None):
        raise TypeError("give both low and high, or none for the specimen")
    if low is None:
        return None
    corners = []
    for name, corner in (("low", low), ("high", high)):
        values = several(name, corner, "a list of three numbers")
        if len(values) != 3 or not all(isinstance(one, numbers.Real) for one in values):
            raise TypeError(f"{name}: found {shown(values)}; allowed is a list of three numbers")
        if not all(-_LARGEST <= one <= _LARGEST for one in values):
            raise ValueError(f"{name}: found {shown(values)}; allowed is a list of three finite numbers")
        corners.append([float(one) for one in values])
    if not all(below < above for below, above in zip(*corners)):
        raise ValueError(f"low, high: found {corners[0]} and {corners[1]}; allowed is a low corner below the high one along each axis")
    return tuple(corners)


def _refuse_value(source, pointer, message):
    at = pointer if len(pointer) <= 80 else pointer[:80] + "…"
    raise DescriptionError(f"{source}: {at or '/'}: {message}", [Problem(source, None, at, message)]) from None


def _plain_text(value, pointer, source):
    if any("\ud800" <= character <= "\udfff" for character in value):
        _refuse_value(source, pointer, f"found the text {shown(value)}, which is not Unicode; allowed are texts that can be written as UTF-8")
    return value


def _plain_number(value, pointer, source):
    if isinstance(value, numbers.Integral) and not -_LARGEST <= value <= _LARGEST:
        _refuse_value(source, pointer, f"found {shown(value)}; allowed are whole numbers up to {_LARGEST:.3g} in amount")
    if not isinstance(value, numbers.Integral) and not math.isfinite(value):
        _refuse_value(source, pointer, f"found {shown(value)} of type {type(value).__name__}; {_ALLOWED}")
    return value


def _plain(value, pointer, source, around=()):
    """`around`: the dicts and lists that the value is in."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        listed = value.tolist()
        value = float(listed) if isinstance(listed, numpy.floating) else listed  # of more than double precision
    if isinstance(value, (Mapping, list, tuple)):
        if any(one is value for one in around):
            _refuse_value(source, pointer, f"found a {type(value).__name__} that contains itself; allowed are values that end")
        if len(around) >= _MOST_LEVELS:
            _refuse_value(source, pointer, f"found lists and dicts inside each other at more than {_MOST_LEVELS} levels; allowed are up to {_MOST_LEVELS} levels")
        around = (*around, value)
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                _refuse_value(source, pointer, f"found the key {shown(key)} of type {type(key).__name__}; allowed are texts as keys")
            _plain_text(key, pointer, source)
        return {str(key): _plain(one, f"{pointer}/{str(key).replace('~', '~0').replace('/', '~1')}", source, around) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one, f"{pointer}/{i}", source, around) for i, one in enumerate(value)]
    if isinstance(value, os.PathLike):
        value = os.fsdecode(value)
    if isinstance(value, str):
        return _plain_text(value, pointer, source)
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        return _plain_number(value, pointer, source)
    return _refuse_value(source, pointer, f"found {shown(value)} of type {type(value).__name__}; {_ALLOWED}")


def as_json(value, pointer="", source="description"):
    """A value as JSON; numbers, arrays and paths of Python and numpy are converted. Raises DescriptionError."""
    return json.dumps(_plain(value, pointer, source))


def assignments(sets):
    """Changes of a description, as "/pointer=value"."""
    if isinstance(sets, Mapping):
        return [f"{text('sets', pointer, '/seed')}={as_json(value, pointer, 'sets')}" for pointer, value in sets.items()]
    allowed = 'a dict {"/pointer": value}, or a list of "/pointer=value"'
    if isinstance(sets, str):
        raise TypeError(f"sets: found a text; allowed is {allowed}")
    return [text("sets", one, "/seed=3") for one in several("sets", sets, allowed)]
