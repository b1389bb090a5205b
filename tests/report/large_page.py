#!/usr/bin/env python3
"""Measures the page of many grains: time to make it, size, speed of opening and moving in Chromium.

usage: large_page.py GRIT [GRAINS [FRAMES]]     200 000 grains and 20 frames unless given; not among the tests
"""

import pathlib
import subprocess
import sys
import tempfile
import time

from browser import GRAINS, Browser, find_chromium, h5py_or_skip, skip

h5py = h5py_or_skip()
import numpy  # comes with h5py

CHROMIUM = find_chromium()


def write_frames(folder, grains, frames):
    """A random sheared box, with three contacts per grain."""
    (folder / "frames").mkdir(parents=True)
    random = numpy.random.default_rng(1)
    low = random.random((grains, 3)) * [0.06, 0.02, 0.04]
    radius = random.uniform(1e-4, 3e-4, grains)
    a = numpy.sort(random.integers(0, grains, 3 * grains))
    for number in range(frames):
        share = number / max(1, frames - 1)
        moved = numpy.zeros((grains, 3))
        moved[:, 0] = 0.006 * share / (1 + numpy.exp(-(low[:, 2] - 0.02) / 1e-3))
        moved += random.normal(0, 2e-5, (grains, 3))
        with h5py.File(folder / f"frames/{number:06}.h5", "w", libver="v110") as file:
            file.attrs["time"], file.attrs["step"], file.attrs["stage"] = 1e-3 * number, 1000 * number, numpy.bytes_("shear")
            for name, values in {"id": numpy.arange(grains), "position": low + moved, "radius": radius, "velocity": random.normal(0, 0.01, (grains, 3)),
                                 "rotation": random.normal(0, 0.3 * share + 1e-9, (grains, 3)), "displacement": moved}.items():
                file[f"bodies/{name}"] = values
            file["contacts/body_a"] = a
            file["contacts/normal_force"] = random.exponential(1, len(a))
            file["contacts/branch"] = random.normal(0, 2e-4, (len(a), 3))
            file.create_group("walls")


def make_page(grit, folder):
    began = time.monotonic()
    subprocess.run([grit, "report", str(folder)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    page = folder / "report.html"
    print(f"made in {time.monotonic() - began:.1f} s, {page.stat().st_size / 1e6:.1f} MB")
    return page


def measure(page):
    with Browser(CHROMIUM, timeout=120) as browser:
        began = time.monotonic()
        browser.open(page)
        browser.wait(f"{GRAINS}?.painted")
        print(f"open, grains drawn: {time.monotonic() - began:.1f} s")
        unpack, move, fine, play = browser.evaluate(f"""(async () => {{ const view = {GRAINS}, mean = async (count, act) => {{
                const began = performance.now();
                for (let i = 0; i < count; ++i) await act(i);
                return (performance.now() - began) / count; }};
            const unpack = await mean(5, (i) => view.frames.read(i));
            const move = await mean(10, (i) => view.change({{pan: [1e-4 * i, 0]}}));
            const fine = await mean(3, () => view.paint(true));
            const play = await mean(view.frames.count, (i) => view.player.go(i));
            return [unpack, move, fine, play]; }})()""")
        print(f"a frame: {unpack:.0f} ms to unpack, {1000 / move:.1f} a second while dragged, {1000 / play:.1f} while played as fast as can be, {fine:.0f} ms "
              f"when it rests, by {browser.evaluate(f'{GRAINS}.painter.constructor.name')}; heap {browser.evaluate('performance.memory.usedJSHeapSize') / 1e6:.0f} MB")
        print("console:", browser.complaints() or "silent")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if CHROMIUM is None:
        skip("there is no Chromium to open the page with (Debian: chromium)")
    grains, frames = (int(word) for word in (sys.argv[2:] + ["200000", "20"][len(sys.argv) - 2:]))
    with tempfile.TemporaryDirectory(prefix="grit-large-") as place:
        folder = pathlib.Path(place) / "large"
        write_frames(folder, grains, frames)
        measure(make_page(sys.argv[1], folder))
