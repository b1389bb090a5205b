// Cells as one image: each pixel has the colour of the cell that is nearest, so that nothing shows between two.
"use strict";

const gapClosed = 0.75; // of a cell's width: what is wider between two is no gap, but a place without cells

/** By pixel of a width × height image the place of its cell, -1 of none. Cells: lists of centres and half sizes [px]. */
function cellsByPixel({ x, y, w, h }, width, height) {
  const owner = new Int32Array(width * height).fill(-1), distance = new Float32Array(width * height).fill(Infinity);
  // In its own measure a cell is from -1 to 1; it is asked for half a gap more on each side.
  const reach = 1 + gapClosed;
  for (let i = 0; i < x.length; ++i) {
    const lastRow = Math.min(height - 1, Math.floor(y[i] + reach * h[i] - 0.5)), lastColumn = Math.min(width - 1, Math.floor(x[i] + reach * w[i] - 0.5));
    for (let row = Math.max(0, Math.ceil(y[i] - reach * h[i] - 0.5)); row <= lastRow; ++row) {
      const up = Math.abs(row + 0.5 - y[i]) / h[i];
      for (let column = Math.max(0, Math.ceil(x[i] - reach * w[i] - 0.5)); column <= lastColumn; ++column) {
        const off = Math.max(up, Math.abs(column + 0.5 - x[i]) / w[i]), p = row * width + column;
        if (off < distance[p]) (distance[p] = off), (owner[p] = i);
      }
    }
  }
  // Beyond its edge a cell has only what lies between it and another one: along a row, along a column, and where such gaps cross.
  const within = Uint8Array.from(distance, (off) => (off <= 1 + 1e-6 ? 1 : 0));
  const close = (lines, length, at, size) => {
    for (let line = 0; line < lines; ++line)
      for (let k = 0, last = -1; k < length; ++k) {
        const p = at(line, k);
        if (!within[p]) continue;
        if (last >= 0 && k - last - 1 <= 2 * gapClosed * size[owner[p]]) for (let i = last + 1; i < k; ++i) within[at(line, i)] = 1;
        last = k;
      }
  };
  close(height, width, (row, column) => row * width + column, w);
  close(width, height, (column, row) => row * width + column, h); // across gaps that are closed by now, too
  for (let p = 0; p < owner.length; ++p) if (!within[p]) owner[p] = -1;
  return owner;
}

/** A canvas of cells' colours [r, g, b]; nothing where there is no cell. */
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
