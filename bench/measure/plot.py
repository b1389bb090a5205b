"""Pictures with logarithmic axes, as SVG or PNG."""
import math
import shutil
import subprocess

from .machine import Complaint


class Plot:
    """A picture with logarithmic axes."""
    WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 1000, 640, 90, 30, 30, 70

    def __init__(self, low, high, along, up):
        self.low, self.high, self.along, self.up = low, high, along, up
        self.parts = []

    def place(self, x, y):
        wide, tall = self.WIDTH - self.LEFT - self.RIGHT, self.HEIGHT - self.TOP - self.BOTTOM
        along = [math.log(value / low) / math.log(high / low)
                 for value, low, high in zip((x, y), self.low, self.high)]
        return self.LEFT + along[0] * wide, self.HEIGHT - self.BOTTOM - along[1] * tall

    def text(self, x, y, words, size=17, anchor='start', turn=''):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}"{turn}>{words}</text>')

    def line(self, ends, colour, width=1.0, dashes=''):
        path = ' '.join('%.1f,%.1f' % self.place(*end) for end in ends)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"'
                          + (f' stroke-dasharray="{dashes}"' if dashes else '') + '/>')

    def axes(self):
        for axis in (0, 1):
            low, high = self.low[axis], self.high[axis]
            # Powers of ten alone are too few on a short axis.
            steps = range(1, 10) if high < 4 * low else (1, 2, 5) if high < 100 * low else (1,)
            values = [step * 10.0 ** power for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
                      for step in steps]
            for value in [*values, 10.0 ** math.ceil(math.log10(high))]:
                if not low <= value <= high:
                    continue
                ends = [(value, y) for y in (self.low[1], self.high[1])] if axis == 0 else \
                    [(x, value) for x in (self.low[0], self.high[0])]
                self.line(ends, '#ccc')
                x, y = self.place(*ends[0])
                self.text(x if axis == 0 else x - 8, y + 22 if axis == 0 else y + 6, f'{value:,.12g}'.replace(',', ' '), 16,
                          'middle' if axis == 0 else 'end')
        self.text(self.WIDTH / 2, self.HEIGHT - 18, self.along, anchor='middle')
        x, y = 28, self.HEIGHT / 2
        self.text(x, y, self.up, anchor='middle', turn=f' transform="rotate(-90 {x} {y})"')

    def svg(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.WIDTH}" height="{self.HEIGHT}" '
                'font-family="DejaVu Sans, sans-serif">\n<rect width="100%" height="100%" fill="white"/>\n'
                + '\n'.join(self.parts) + '\n</svg>\n')


def write(svg, out):
    """As .svg or PNG."""
    if out.suffix == '.svg':
        out.write_text(svg, encoding='utf-8')
    elif shutil.which('rsvg-convert'):
        subprocess.run(['rsvg-convert', '--output', out], input=svg, text=True, check=True)
    else:
        raise Complaint('there is no rsvg-convert for a PNG; install librsvg2-bin, or give an .svg (--out)')
