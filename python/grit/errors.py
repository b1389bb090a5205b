"""Errors of grit. str() is a text for users: where, what was found, what is allowed, what to do."""

import difflib
from typing import NamedTuple, Optional


class Error(Exception):
    """The base of all errors of grit."""


class Problem(NamedTuple):
    """One problem in a description."""

    file: str            # path, or "description", "sets" or "set" for what was made in Python
    line: Optional[int]  # from 1; None for a description without lines
    pointer: str         # JSON pointer
    message: str         # what was found and what is allowed


class DescriptionError(Error):
    """A description that cannot be run, or a value that cannot be set; `problems` has all of them."""

    def __init__(self, message, problems=()):
        super().__init__(message)
        self.problems = list(problems)


class NumericsError(Error):
    """A guard stopped the simulation, or a stage failed: the simulation has failed, and run() raises the error again."""

    def __init__(self, message, cause="", guard="none", pointer=""):
        super().__init__(message)
        self.cause = cause      # the message without the instant
        self.guard = guard      # "overlap", "travel", "energy", "finite", "domain", "period", "arrival", "critical_step", or "none"
        self.pointer = pointer  # of the part of the description that caused it


class PluginError(Error):
    """A plugin that cannot be loaded or violates its interface."""


class FileError(Error):
    """A file that cannot be read or written."""


class UnknownName(Error, KeyError):
    """An unknown name; the message lists the known ones."""

    def __init__(self, what, name, names):
        super().__init__(name)
        near = difflib.get_close_matches(str(name), names, 1)
        listed = ", ".join(names) if names else "none"
        self.message = f"there is no {what} {name!r}" + (f"; did you mean {near[0]!r}?" if near else ".") + f" There are: {listed}"

    def __str__(self):
        return self.message


class ResultsError(Error):
    """A folder or a file that `grit run` has not written, or not yet."""


class UnknownResult(UnknownName, ResultsError):
    """A name that results do not have."""
