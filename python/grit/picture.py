"""Pictures in notebooks."""

import pathlib

from .errors import FileError


class Picture:
    """An SVG picture, which notebooks show."""

    def __init__(self, svg):
        self.svg = svg

    def _repr_svg_(self):
        return self.svg

    def __repr__(self):
        return "<picture; notebooks show it, save(path) writes it>"

    def save(self, path):
        """Writes the SVG."""
        path = pathlib.Path(path)
        if path.suffix != ".svg":
            raise ValueError(f"path: found {str(path)!r}; allowed is a name that ends in .svg")
        try:
            path.write_text(self.svg, encoding="utf-8")
        except OSError as error:
            raise FileError(f"{path}: cannot be written: {error.strerror}") from error
