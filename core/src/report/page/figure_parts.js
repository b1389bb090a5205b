// What figures in metres share: ways to look, units that read well, a bar of length, a scale of colours.
"use strict";

// Axis to the right, upwards, along the line of sight with its sign away from the reader; as in picture.svg.
const views = {
  xz: { label: "front (x, z)", right: 0, up: 2, depth: 1, away: 1 },
  yz: { label: "side (y, z)", right: 1, up: 2, depth: 0, away: -1 },
  xy: { label: "above (x, y)", right: 0, up: 1, depth: 2, away: -1 },
};
const letter = (axis) => "xyz"[axis];

const prefixes = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];
/** A unit with the prefix that reads best for numbers up to `largest`. */
function prefixed(unit, largest) {
  if (unit !== "m" && unit !== "m/s") return [1, unit];
  const [size, prefix] = prefixes.find(([one]) => largest >= one) ?? prefixes.at(-1);
  return [1 / size, prefix + unit];
}
/** 1, 2 or 5 times a power of ten, at most `most`. */
function niceBelow(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((lead) => lead * power).find((one) => one <= most * 1.0001) ?? power;
}

/** Where metres go on a stage, so that a box fills it; `zoom` and `pan` [m] go closer. Sets the stage's height. */
class Layout {
  constructor(stage, view, low, high, zoom = 1, pan = [0, 0]) {
    const margin = (this.margin = { left: 14, right: 92, top: 14, bottom: 44 });
    const across = Math.max(high[view.right] - low[view.right], 1e-9), upward = Math.max(high[view.up] - low[view.up], 1e-9);
    this.width = stage.clientWidth;
    const inner = Math.max(80, this.width - margin.left - margin.right);
    this.height = Math.round(Math.min(Math.max((inner * upward) / across + margin.top + margin.bottom, 240), Math.max(300, 0.78 * innerHeight), 900));
    if (stage.style.height !== `${this.height}px`) stage.style.height = `${this.height}px`;
    this.metresPerPixel = Math.max(across / inner, upward / (this.height - margin.top - margin.bottom)) / zoom;
    this.centre = [
      (low[view.right] + high[view.right]) / 2 + pan[0] + (this.metresPerPixel * (margin.right - margin.left)) / 2,
      (low[view.up] + high[view.up]) / 2 + pan[1] - (this.metresPerPixel * (margin.bottom - margin.top)) / 2,
    ];
  }
  /** Pixels from the left and from the top. */
  across(metres) {
    return this.width / 2 + (metres - this.centre[0]) / this.metresPerPixel;
  }
  down(metres) {
    return this.height / 2 - (metres - this.centre[1]) / this.metresPerPixel;
  }
  /** Metres to the right and upwards at a place on the screen. */
  metresAt(stage, { clientX, clientY }) {
    const { left, top } = stage.getBoundingClientRect();
    return [this.centre[0] + (clientX - left - this.width / 2) * this.metresPerPixel, this.centre[1] - (clientY - top - this.height / 2) * this.metresPerPixel];
  }
}

/** Where grains and maps are drawn: left of what colours mean. */
const panel = ({ width, height, margin }) => [0, 0, Math.max(0, width - margin.right + 8), height];

/** A bar that says how long things are, at the lower left. */
function drawLengthBar(pen, look, { width, height, metresPerPixel, margin }) {
  const long = niceBelow(0.3 * Math.min(width, 480) * metresPerPixel), [factor, unit] = prefixed("m", long), y = height - 16;
  pen.box(margin.left - 6, y - 11, long / metresPerPixel + 70, 22, look.paper);
  pen.line(margin.left, y, margin.left + long / metresPerPixel, y, look.ink, 2);
  pen.text(margin.left + long / metresPerPixel + 8, y + 4, `${+(long * factor).toPrecision(3)} ${unit}`, look.ink);
}

/** What colours mean, at the upper right; numbers are times `factor`, in `unit`. */
function drawColourScale(pen, look, { width, height, low, high, table, label, unit, factor, note }) {
  const tall = Math.min(240, height - 110), left = width - 66, top = 46, pieces = 64;
  pen.text(width - 2, 20, label, look.ink, "end", 12.5);
  if (unit !== "1") pen.text(width - 2, 35, `[${writtenUnit(unit)}]`, look.soft, "end", 11.5);
  for (let i = 0; i < pieces; ++i) pen.box(left, top + (tall * (pieces - 1 - i)) / pieces, 13, tall / pieces + 0.6, rgb(table[Math.round((i / (pieces - 1)) * 255)]));
  const step = niceBelow((high - low) / 3), shown = step * factor;
  const words = (value) => (shown >= 1e5 || shown < 1e-5 ? value.toExponential(1) : value.toFixed(Math.max(0, -Math.floor(Math.log10(shown) + 1e-9)))).replace("-", "−");
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    const at = top + tall * (1 - (k * step - low) / (high - low));
    pen.line(left + 13, at, left + 17, at, look.frame, 1);
    pen.text(left + 20, at + 4, words(k * shown || 0), look.ink, "start", 11.5);
  }
  if (note) pen.text(width - 2, top + tall + 18, note, look.soft, "end", 11);
}
