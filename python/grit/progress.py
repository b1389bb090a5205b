"""Progress of a run: a line on standard error, or a bar of tqdm in a notebook."""

import functools
import sys
import time
import warnings

_LOG_EVERY = 10  # s, where standard error is no terminal


def in_notebook():
    return "ipykernel" in sys.modules


@functools.lru_cache(maxsize=None)
def is_seen():
    """Whether someone watches. Cached: a call of run() may take a few microseconds."""
    return in_notebook() or sys.stderr.isatty()


def _duration(seconds):
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


class Line:
    """One line that is rewritten on a terminal and in a notebook, or a line every ten seconds in a log."""

    def __init__(self):
        self._rewrites, self._shown, self._width = is_seen(), None, 0

    def show(self, stage, number, stages, fraction, left, now, speed):
        text = f"{number}/{stages} {stage}: "
        text += f"t = {now:.4g} s" if fraction is None else f"{100 * fraction:.0f} %" + (f", {_duration(left)} left" if left is not None else "")
        text += f", {1e-6 * speed:.2f} M particle-steps/s"
        if self._rewrites:
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        elif self._shown is None or time.monotonic() - self._shown >= _LOG_EVERY:
            sys.stderr.write(text + "\n")
            self._shown = time.monotonic()
        sys.stderr.flush()

    def close(self):
        if self._width:
            sys.stderr.write("\n")


class Bar:
    """A bar of tqdm per stage."""

    def __init__(self, tqdm):
        self._tqdm, self._bar, self._number = tqdm, None, None

    def show(self, stage, number, stages, fraction, left, now, speed):
        if number != self._number:
            self.close()
            self._bar, self._number = self._tqdm(total=100, unit="%", bar_format="{desc} {bar} {n:.0f} % [{elapsed}{postfix}]"), number
            self._bar.set_description(f"{number}/{stages} {stage}")
        if fraction is not None:
            self._bar.n = 100 * fraction
        self._bar.set_postfix_str((f"{_duration(left)} left, " if left is not None else f"t = {now:.4g} s, ") + f"{1e-6 * speed:.2f} M particle-steps/s")

    def close(self):
        if self._bar is not None:
            self._bar.close()


def make():
    if in_notebook():
        try:
            with warnings.catch_warnings():  # of tqdm, that ipywidgets is missing: it draws a bar of text then
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm
            return Bar(tqdm)
        except ImportError:
            pass
    return Line()
