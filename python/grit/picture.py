"""Pictures in notebooks."""

import base64
import pathlib
import subprocess

from . import optional
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
        """Writes an SVG, or a PNG of twice its size."""
        path = pathlib.Path(path)
        if path.suffix not in (".svg", ".png"):
            raise ValueError(f"path: found {str(path)!r}; allowed is a name that ends in .svg or .png")
        data = self.svg.encode()
        if path.suffix == ".png":
            draws = optional.program("rsvg-convert", "librsvg2-bin", "a picture as PNG")
            data = subprocess.run([draws, "--zoom", "2"], input=data, stdout=subprocess.PIPE, check=True).stdout
        try:
            path.write_bytes(data)
        except OSError as error:
            raise FileError(f"{path}: cannot be written: {error.strerror}") from error
