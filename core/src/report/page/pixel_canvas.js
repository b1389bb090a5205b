// Draws discs and segments without a graphics processor: each pixel once, by the nearest disc. WebGL2 in software takes five times
// as long: 400 ms for 200 000 discs.
"use strict";

/** Indices of the 16-bit numbers from `from` to `to`, sorted ascending or descending. */
function ordered(list, from, to, rising) {
  const starts = new Uint32Array(65537);
  for (let i = 0; i < list.length; ++i) if (list[i] >= from && list[i] <= to) ++starts[list[i] + 1];
  for (let k = 0; k < 65536; ++k) starts[k + 1] += starts[k];
  const places = new Uint32Array(starts[65536]);
  for (let i = 0; i < list.length; ++i) if (list[i] >= from && list[i] <= to) places[starts[list[i]]++] = i;
  return rising ? places : places.reverse();
}

const patience = 40; // ms, maximum time of a drawing while something moves

class PixelPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.fine = make("canvas"); // twice as many pixels in each direction, for smooth edges
    this.took = 0;
  }
  setBodies(bodies) {
    this.bodies = bodies;
  }
  setPlaces(places) {
    this.places = places;
  }
  setSegments(segments) {
    this.segments = segments;
  }
  setColours(table) {
    this.table = table;
  }

  /** Draws with coarse edges if fine ones take too long, unless `fine` is set. Returns whether they are coarse. */
  draw({ fine, ...what }) {
    const coarse = !fine && this.took > patience, began = performance.now(), { width, height } = this.canvas;
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, width, height);
    if (coarse) {
      this.drawDiscs(this.context, what, 1);
    } else {
      if (this.fine.width !== 2 * width || this.fine.height !== 2 * height) this.fine.width = 2 * width, this.fine.height = 2 * height;
      this.drawDiscs(this.fine.getContext("2d"), what, 2);
      this.context.drawImage(this.fine, 0, 0, width, height);
      this.took = performance.now() - began;
    }
    this.drawSegments(what);
    return coarse;
  }

  /** The nearest disc first; a coloured pixel keeps its colour. `scale`: pixels of the context over those of the canvas. */
  drawDiscs(context, { low, span, window, depth, view, metresPerPixel, fade, look, panelWidth }, scale) {
    const { radius } = this.bodies, lists = [this.bodies.x, this.bodies.y, this.bodies.z], size = (0.5 * scale) / metresPerPixel; // pixels per metre
    const width = scale * panelWidth, height = scale * this.canvas.height, least = 0.5 * scale;
    if (width === 0 || height === 0) return;
    const image = this.imageOf(width, height), pixels = new Uint32Array(image.data.buffer), paper = parsed(look.paper);
    const packed = (colour, shade) => {
      const [r, g, b] = colour.map((c, k) => Math.round(shade * c + fade * (paper[k] - shade * c)));
      return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
    };
    const fills = this.table.map((colour) => packed(colour, 1)), rims = this.table.map((colour) => packed(colour, 0.56));
    const grey = [180, 180, 176], none = packed(grey, 1), noneRim = packed(grey, 0.56);
    const [xs, ys] = [view.right, view.up].map((axis) => lists[axis]), step = (axis) => span[axis] / 65535;
    const x0 = (low[view.right] - window[0]) * size + (0.5 * scale * this.canvas.width), xStep = step(view.right) * size;
    const y0 = (window[1] - low[view.up]) * size + 0.5 * height, yStep = step(view.up) * size;
    for (const i of this.order(lists[view.depth], low[view.depth], step(view.depth), view.away, depth[0])) {
      const x = x0 + xStep * xs[i], y = y0 - yStep * ys[i], r = Math.max(least, radius[i] * size), inner = r < 1.5 * scale ? r : r - scale;
      const place = this.places[i], k = Math.round(place * 255), fill = place < 0 ? none : fills[k], rim = place < 0 ? noneRim : rims[k];
      const end = Math.min(height - 1, Math.floor(y + r - 0.5));
      for (let row = Math.max(0, Math.ceil(y - r - 0.5)); row <= end; ++row) {
        const up = row + 0.5 - y, half = Math.sqrt(r * r - up * up), within = inner * inner - up * up, core = within > 0 ? Math.sqrt(within) : 0;
        const last = row * width + Math.min(width - 1, Math.floor(x + half - 0.5)), first = row * width + Math.max(0, Math.ceil(x - half - 0.5));
        const from = row * width + Math.ceil(x - core - 0.5), to = row * width + Math.floor(x + core - 0.5);
        for (let p = first; p <= last; ++p) if (pixels[p] === 0) pixels[p] = core > 0 && p >= from && p <= to ? fill : rim;
      }
    }
    context.putImageData(image, 0, 0);
  }
  /** An empty image. */
  imageOf(width, height) {
    if (this.image?.width === width && this.image.height === height) this.image.data.fill(0);
    else this.image = new ImageData(width, height);
    return this.image;
  }
  order(list, low, step, away, cut) {
    const key = `${away} ${cut}`;
    if (this.sorted?.list !== list || this.sorted.key !== key) {
      const limit = step > 0 ? (away * cut - low) / step : (away * low >= cut ? -1 : 1) * away * Infinity;
      this.sorted = { list, key, places: away > 0 ? ordered(list, limit, 65535, true) : ordered(list, 0, limit, false) };
    }
    return this.sorted.places;
  }

  drawSegments({ window, metresPerPixel, look, panelWidth }) {
    const { from, to, width, alpha, tint } = this.segments, pen = new CanvasPen(this.context), { canvas } = this, size = 0.5 / metresPerPixel;
    const across = (x) => (x - window[0]) * size + 0.5 * canvas.width, down = (y) => (window[1] - y) * size + 0.5 * canvas.height;
    pen.within([0, 0, panelWidth, canvas.height], () => {
      for (let i = 0; i < width.length; ++i)
        pen.line(across(from[2 * i]), down(from[2 * i + 1]), across(to[2 * i]), down(to[2 * i + 1]), inkOf(tint, i, look), 2 * width[i], alpha[i]);
    });
  }
}

/** Uses the graphics processor if there is one. */
function painterFor(canvas) {
  let trial;
  try {
    trial = new GlPainter(make("canvas"));
  } catch {
    return new PixelPainter(canvas);
  }
  const { gl } = trial, names = gl.getExtension("WEBGL_debug_renderer_info"), renderer = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer) ? new PixelPainter(canvas) : new GlPainter(canvas);
}
