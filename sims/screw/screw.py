#!/usr/bin/env python3
"""Writes screw.stl: the flight of a right-handed screw along x, a closed surface, in mm."""
import math
import struct
from pathlib import Path

LENGTH, PITCH, INNER, OUTER, THICKNESS, STEPS = 70.0, 20.0, 3.0, 14.0, 2.0, 24  # mm; steps per turn


def section(i):
    """Corners of the cross-section after i steps: inner and outer edge of the front, then of the back."""
    turn = 2 * math.pi * i / STEPS
    x = 4.0 + PITCH * i / STEPS
    return [(x + dx, r * math.cos(turn), r * math.sin(turn))
            for r, dx in ((INNER, THICKNESS / 2), (OUTER, THICKNESS / 2), (OUTER, -THICKNESS / 2), (INNER, -THICKNESS / 2))]


def main():
    count = round((LENGTH - 8.0) / PITCH * STEPS)
    sections = [section(i) for i in range(count + 1)]
    triangles = []
    for here, there in zip(sections, sections[1:]):
        for k in range(4):
            a, b, c, d = here[k], here[(k + 1) % 4], there[(k + 1) % 4], there[k]
            triangles += [(a, b, c), (a, c, d)]
    (a, b, c, d), (e, f, g, h) = sections[0], sections[-1]
    triangles += [(a, c, b), (a, d, c), (e, f, g), (e, g, h)]
    with open(Path(__file__).parent / 'screw.stl', 'wb') as out:
        out.write(b'flight of a screw, mm'.ljust(80, b' ') + struct.pack('<I', len(triangles)))
        for triangle in triangles:
            out.write(struct.pack('<12fH', 0, 0, 0, *(v for corner in triangle for v in corner), 0))


main()
