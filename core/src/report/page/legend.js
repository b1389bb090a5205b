// The legend below a chart: entries side by side, as many in a row as fit.
"use strict";

const legendRow = 17, sampleLength = 16, besideSample = 6, betweenEntries = 18, legendSize = 11.5; // px

/** A name of at most `most` pixels; a longer one is shortened in the middle, as names differ at their ends. */
function shortened(name, most, widthOf) {
  if (widthOf(name) <= most) return name;
  let kept = name.length - 1;
  const without = () => `${name.slice(0, Math.ceil(kept / 2))}…${name.slice(name.length - Math.floor(kept / 2))}`;
  while (kept > 1 && widthOf(without()) > most) --kept;
  return without();
}

/** [{label, s, x, row}] of entries [{label, s}] within a width [px]; nothing overlaps. */
function legendPlaces(entries, width) {
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = `${legendSize}px ${getComputedStyle(document.body).fontFamily}`;
  const widthOf = (text) => pen.measureText(text).width;
  let x = 0, row = 0;
  return entries.map(({ label, s }) => {
    const short = shortened(label, width - sampleLength - besideSample, widthOf), wide = sampleLength + besideSample + widthOf(short);
    if (x > 0 && x + wide > width) (x = 0), ++row;
    const place = { label: short, s, x, row };
    x += wide + betweenEntries;
    return place;
  });
}
const legendHeight = (places) => (places.length === 0 ? 0 : 8 + legendRow * (1 + places.at(-1).row));

/** Data and marks of a legend that begins `below` pixels below the axes. */
function legendParts(places, below, look, font) {
  const y = { signal: `height + ${below} + ${legendRow} * datum.row` }, from = { data: "legend" };
  return {
    data: { name: "legend", values: places },
    marks: [
      { type: "rule", name: "legend-samples", interactive: false, from, encode: { update: { x: { field: "x" }, x2: { field: "x", offset: sampleLength }, y, stroke: { scale: "colour", field: "s" },
        strokeDash: { scale: "dash", field: "s" }, strokeWidth: { value: 3 } } } },
      { type: "text", name: "legend-names", interactive: false, from, encode: { update: { x: { field: "x", offset: sampleLength + besideSample }, y, text: { field: "label" }, fill: { value: look.ink },
        font: { value: font }, fontSize: { value: legendSize }, baseline: { value: "middle" } } } },
    ],
  };
}
