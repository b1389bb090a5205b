"""Values of options: numbers and words, checked on reading."""
import argparse
import math
from pathlib import Path


def _refuse(text, allowed):
    raise argparse.ArgumentTypeError(f'found "{text}"; {allowed}')


def count(text):
    try:
        number = int(text)
    except ValueError:
        number = 0
    return number if number >= 1 else _refuse(text, 'it must be a whole number, at least 1')


def positive(text):
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    return number if 0 < number < math.inf else _refuse(text, 'it must be a number above 0')


def _list(text, one, allowed):
    try:
        found = [one(word) for word in text.split(',')]
    except argparse.ArgumentTypeError:
        found = []
    return found if found and len(set(found)) == len(found) else _refuse(text, allowed)


def counts(text):
    return _list(text, count, 'it must be whole numbers of at least 1, each once, separated by commas')


def words(allowed):
    """A reader of words in `allowed`."""
    def word(text):
        return text if text in allowed else _refuse(text, '')
    return lambda text: _list(text, word, f'allowed are {", ".join(allowed)}, each once, separated by commas')


def output(text):
    """A file that can be written; checked before any measurement."""
    path = Path(text)
    new = not path.exists()
    try:
        with open(path, 'a', encoding='utf-8'):
            pass
    except OSError as error:
        _refuse(text, f'it cannot be written: {error.strerror}; give another, or make its folder')
    if new:
        path.unlink()
    return path
