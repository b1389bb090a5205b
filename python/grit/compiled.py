"""Finds and loads the compiled module: of this processor's best installed instruction set, or of the one that GRIT_ISA names."""

import importlib.machinery
import importlib.util
import os
import pathlib
import platform
import sysconfig

_PACKAGE = pathlib.Path(__file__).absolute().parent
_FILE = "_grit" + (sysconfig.get_config_var("EXT_SUFFIX") or ".so")

# As in the launcher: each level is tested by its newest instructions, in the words of /proc/cpuinfo.
_LEVELS = {
    "x86-64-v2": {"sse4_2", "popcnt"},
    "x86-64-v3": {"avx2", "bmi2", "fma"},
    "x86-64-v4": {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
}


def _flags():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return set()
    return {flag for line in lines if line.startswith("flags") for flag in line.partition(":")[2].split()}


def runs_here(level, flags):
    """Whether a processor with these flags supports a level. Other names are builds for a specific processor and cannot be tested."""
    if platform.machine() != "x86_64" or level not in _LEVELS:
        return True
    return all(needed <= flags for name, needed in _LEVELS.items() if name <= level)


def best_first(levels):
    """Builds for a specific processor, then the levels in descending order."""
    return sorted(sorted(levels, reverse=True), key=lambda level: level.startswith("x86-64"))


def choose(installed, flags, wanted):
    """The folder to load from, by the rules of the launcher. Raises ImportError."""
    possible = [level for level in best_first(installed) if runs_here(level, flags)]
    remedy = (f"; installed: {', '.join(best_first(installed)) or 'none'}; supported by this processor: {', '.join(possible) or 'none'}. "
              "Set GRIT_ISA to a supported one, unset it to use the best, or install another with scripts/package.sh")
    if wanted and wanted not in installed:
        raise ImportError(f"GRIT_ISA={wanted}: this instruction set is not installed with the Python module" + remedy)
    if wanted and wanted not in possible:
        raise ImportError(f"GRIT_ISA={wanted}: this processor does not support this instruction set" + remedy)
    if not possible:
        raise ImportError("this processor supports none of the installed instruction sets" + remedy)
    return wanted or possible[0]


def _file():
    try:
        from ._place import LIBRARY
    except ImportError:
        raise ImportError(f"{_PACKAGE} reads results only; simulations need the compiled module: build grit with pybind11 and Python's development "
                          "files (Debian: pybind11-dev, python3-dev), then add build/python, or share/grit/python of an installation, to PYTHONPATH") from None
    folder = pathlib.Path(os.path.normpath(_PACKAGE / LIBRARY))
    wanted = os.environ.get("GRIT_ISA", "")
    if (folder / _FILE).exists():  # a build folder has one instruction set
        return folder / _FILE
    levels = [path.parent.name for path in folder.glob(f"*/{_FILE}")]
    if not levels:
        others = sorted({path.name for path in [*folder.glob("_grit*.so"), *folder.glob("*/_grit*.so")]})
        raise ImportError(f"there is no {_FILE} in {folder}" + (f", but {', '.join(others)}: use the Python that grit was built with" if others
                          else "; build grit with pybind11 and Python's development files (Debian: pybind11-dev, python3-dev)"))
    return folder / choose(levels, _flags(), wanted) / _FILE


def load():
    """The compiled module. Raises ImportError."""
    path = _file()
    loader = importlib.machinery.ExtensionFileLoader("grit._grit", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("grit._grit", loader))
    loader.exec_module(module)
    wanted = os.environ.get("GRIT_ISA", "")
    if wanted and wanted != module.instruction_set:
        raise ImportError(f"GRIT_ISA={wanted}: this build has one instruction set, {module.instruction_set!r}; unset GRIT_ISA, or build with -DGRIT_ARCH={wanted}")
    return module
