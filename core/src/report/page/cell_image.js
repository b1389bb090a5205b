// Cells as one image: each pixel has the colour of the nearest cell, so that there are no gaps between neighbours.
"use strict";

const gapClosed = 0.75; // of a cell's width: a wider gap is a region without cells

/** For each pixel of a width × height image the index of its cell, -1 for none. Cells: lists of centres and half sizes [px]. */
function cellsByPixel({ x, y, w, h }, width, height) {
  // In units of its half size a cell extends from -1 to 1. It is dilated by half a gap on each side, in whole pixels; the image gets a margin for this.
  const beyond = (half) => Math.round(gapClosed * half), margin = beyond([...w, ...h].reduce((a, b) => Math.max(a, b), 0));
  const wide = width + 2 * margin, tall = height + 2 * margin;
  const nearest = new Int32Array(wide * tall).fill(-1), distance = new Float32Array(wide * tall).fill(Infinity);
  for (let i = 0; i < x.length; ++i) {
    const across = w[i] + beyond(w[i]), up = h[i] + beyond(h[i]), left = x[i] + margin, top = y[i] + margin;
    const lastRow = Math.min(tall - 1, Math.floor(top + up - 0.5)), lastColumn = Math.min(wide - 1, Math.floor(left + across - 0.5));
    for (let row = Math.max(0, Math.ceil(top - up - 0.5)); row <= lastRow; ++row) {
      const off = Math.abs(row + 0.5 - top) / h[i];
      for (let column = Math.max(0, Math.ceil(left - across - 0.5)); column <= lastColumn; ++column) {
        const most = Math.max(off, Math.abs(column + 0.5 - left) / w[i]), p = row * wide + column;
        if (most < distance[p]) (distance[p] = most), (nearest[p] = i);
      }
    }
  }
  // Then it is eroded by the same amount ("closing" of image analysis): outside its edge a cell keeps pixels that are surrounded by cells.
  const before = new Int32Array((wide + 1) * (tall + 1)), line = wide + 1; // number of pixels with a cell above and to the left
  for (let row = 0, p = 0; row < tall; ++row)
    for (let column = 0, along = 0; column < wide; ++column, ++p) before[(row + 1) * line + column + 1] = before[row * line + column + 1] + (along += nearest[p] >= 0 ? 1 : 0);
  const owner = new Int32Array(width * height);
  for (let row = 0, q = 0; row < height; ++row)
    for (let column = 0; column < width; ++column, ++q) {
      const p = (row + margin) * wide + column + margin, cell = (owner[q] = nearest[p]);
      if (cell < 0 || distance[p] <= 1 + 1e-6) continue;
      const across = beyond(w[cell]), up = beyond(h[cell]), top = (row + margin - up) * line, bottom = (row + margin + up + 1) * line;
      const left = column + margin - across, right = column + margin + across + 1;
      if (before[bottom + right] - before[top + right] - before[bottom + left] + before[top + left] < (2 * across + 1) * (2 * up + 1)) owner[q] = -1;
    }
  return owner;
}

/** A canvas with the colours [r, g, b] of cells; transparent without a cell. */
function imageOfCells(owner, width, height, colourOf) {
  const image = new ImageData(width, height), pixels = new Uint32Array(image.data.buffer), colours = new Map();
  for (let p = 0; p < owner.length; ++p) {
    const cell = owner[p];
    if (cell < 0) continue;
    if (!colours.has(cell)) colours.set(cell, colourOf(cell).reduce((all, part, k) => all | (part << (8 * k)), 0xff << 24) >>> 0);
    pixels[p] = colours.get(cell);
  }
  const canvas = make("canvas", { width, height });
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
