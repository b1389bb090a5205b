"""Modules and programs that only some functions need."""

import importlib
import shutil


def module(name, package, use):
    """A module; an ImportError that names its package if it is missing."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{use} needs {name.partition('.')[0]}: {error}; install it: apt install {package}", name=name) from error


def program(name, package, use):
    """The path of a program; a FileNotFoundError that names its package if it is missing."""
    found = shutil.which(name)
    if found is None:
        raise FileNotFoundError(f"{use} needs {name}, which is not there; install it: apt install {package}")
    return found
