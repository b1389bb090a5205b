// Shared parts of figures in metres: views, readable units, scale bar, colour scale, size of files.
"use strict";

// Axes to the right, upwards, and along the line of sight with its sign away from the viewer; as in picture.svg.
const views = {
  xz: { label: "front (x, z)", right: 0, up: 2, depth: 1, away: 1 },
  yz: { label: "side (y, z)", right: 1, up: 2, depth: 0, away: -1 },
  xy: { label: "top (x, y)", right: 0, up: 1, depth: 2, away: -1 },
};
const letter = (axis) => "xyz"[axis];

const prefixes = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];
/** The unit with the best prefix for numbers up to `largest`. */
function prefixed(unit, largest) {
  if (unit !== "m" && unit !== "m/s") return [1, unit];
  const [size, prefix] = prefixes.find(([one]) => largest >= one) ?? prefixes.at(-1);
  return [1 / size, prefix + unit];
}

// The size of files does not depend on the screen: the width of a text column, at a resolution for print.
const fileSize = { width: 600, tallest: 700 }, filePixels = 3; // CSS pixels, and PNG pixels per CSS pixel

/** The space for a figure on the screen. */
const sizeOf = (stage) => ({ width: stage.clientWidth, tallest: Math.min(900, Math.max(300, 0.78 * innerHeight)) });
function fitStage(stage, { height }) {
  if (stage.style.height !== `${height}px`) stage.style.height = `${height}px`;
}

/** The canvas of a file; `draw` gets a pen in CSS pixels. */
function fileCanvas({ width, height }, draw) {
  const canvas = make("canvas", { width: filePixels * width, height: filePixels * height }), context = canvas.getContext("2d");
  context.fillStyle = filesLook().paper;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.setTransform(filePixels, 0, 0, filePixels, 0, 0);
  draw(new CanvasPen(context), context);
  return canvas;
}

/** Maps metres to pixels of a stage, so that a box fills it, modified by `zoom` and `pan` [m]. */
class Layout {
  constructor({ width, tallest }, margin, view, low, high, zoom = 1, pan = [0, 0]) {
    Object.assign(this, { width, margin });
    const across = Math.max(high[view.right] - low[view.right], 1e-9), upward = Math.max(high[view.up] - low[view.up], 1e-9);
    const inner = Math.max(80, width - margin.left - margin.right);
    this.metresToFit = (wide, tall) => Math.max(wide / inner, tall / (this.height - margin.top - margin.bottom)); // per pixel
    this.height = Math.round(Math.min(Math.max((inner * upward) / across + margin.top + margin.bottom, 240), tallest));
    this.metresPerPixel = this.metresToFit(across, upward) / zoom;
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
  metresAcross(pixels) {
    return this.centre[0] + (pixels - this.width / 2) * this.metresPerPixel;
  }
  metresUp(pixels) {
    return this.centre[1] - (pixels - this.height / 2) * this.metresPerPixel;
  }
  /** Metres to the right and upwards at a point of the screen. */
  metresAt(stage, { clientX, clientY }) {
    const { left, top } = stage.getBoundingClientRect();
    return [this.metresAcross(clientX - left), this.metresUp(clientY - top)];
  }
}

/** Sections of triangles with the plane at a depth: from and to, to the right and upwards [m], and the number of the triangle. */
function cutBy(view, corners, depth) {
  const lines = [];
  for (let t = 0; t + 8 < corners.length; t += 9) {
    const points = [];
    for (let k = 0; k < 3; ++k) {
      const a = t + 3 * k, b = t + 3 * ((k + 1) % 3);
      const before = corners[a + view.depth] - depth, after = corners[b + view.depth] - depth;
      if (before < 0 === after < 0) continue;
      const fraction = before / (before - after), between = (axis) => corners[a + axis] + fraction * (corners[b + axis] - corners[a + axis]);
      points.push([between(view.right), between(view.up)]);
    }
    if (points.length === 2) lines.push([...points, t / 9]);
  }
  return lines;
}

/** The box of the grains: left of the colour scale. */
const panel = ({ width, height, margin }) => [0, 0, Math.max(0, width - margin.right + 8), height];

/** The scale bar, at the lower left. */
function drawLengthBar(pen, look, { width, height, metresPerPixel, margin }) {
  const long = niceBelow(0.3 * Math.min(width, 480) * metresPerPixel), [factor, unit] = prefixed("m", long), y = height - 16;
  pen.box(margin.left - 6, y - 11, long / metresPerPixel + 70, 22, look.paper);
  pen.line(margin.left, y, margin.left + long / metresPerPixel, y, look.ink, 2);
  pen.text(margin.left + long / metresPerPixel + 8, y + 4, `${+(long * factor).toPrecision(3)} ${unit}`, look.ink);
}

/** A colour bar with its upper end at `left`, `top`; numbers are multiplied by `factor`. */
function drawColourBar(pen, look, { left, top, tall, low, high, table, factor }) {
  const bar = make("canvas", { width: 1, height: table.length }), context = bar.getContext("2d");
  table.forEach((colour, i) => ((context.fillStyle = rgb(colour)), context.fillRect(0, table.length - 1 - i, 1, 1)));
  pen.image(bar, left, top, 13, tall);
  const step = tickStep(low * factor, high * factor, ticksWithin(tall, 16));
  for (const value of multiples(step, low * factor, high * factor)) {
    const at = top + tall * (1 - (value / factor - low) / (high - low));
    pen.line(left + 13, at, left + 17, at, look.frame, 1);
    pen.text(left + 20, at + 4, atTick(value, step), look.ink, "start", 11.5);
  }
}
/** The same to the right, `first` pixels below the top, with its title. */
function drawColourScale(pen, look, { width, first, tall, label, unit, note, ...scale }) {
  const top = first + 46;
  pen.text(width - 2, first + 20, label, look.ink, "end", 12.5);
  if (unit !== "1") pen.text(width - 2, first + 35, `[${unit}]`, look.soft, "end", 11.5);
  drawColourBar(pen, look, { left: width - 66, top, tall, ...scale });
  if (note) pen.text(width - 2, top + tall + 18, note, look.soft, "end", 11);
}
