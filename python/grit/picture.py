"""Pictures in notebooks."""

import pathlib


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
        pathlib.Path(path).write_text(self.svg, encoding="utf-8")
