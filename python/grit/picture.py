"""Pictures in notebooks."""

import base64
import pathlib

from .errors import FileError


class Picture:
    """An SVG picture, which notebooks show."""

    def __init__(self, svg):
        self.svg = svg

    def _repr_html_(self):
        """As an image: notebooks that are shared or exported drop most elements of an SVG that is part of the page."""
        data = base64.b64encode(self.svg.encode()).decode()
        return f'<img alt="grains" src="data:image/svg+xml;base64,{data}">'

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
