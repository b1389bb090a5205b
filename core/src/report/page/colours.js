// Colours of the page in light or dark mode, and colour scales.
"use strict";
const dark = matchMedia("(prefers-color-scheme: dark)");

function lookOf(style) {
  const of = (name) => style.getPropertyValue(`--${name}`).trim();
  return { ink: of("ink"), soft: of("soft"), paper: of("paper"), line: of("line"), frame: of("frame") };
}
let printing = false;
const theme = () => (printing ? filesLook() : lookOf(getComputedStyle(document.documentElement)));
/** Files and prints have a white background, independent of the mode of the page. */
const filesLook = () => lookOf([...document.styleSheets[0].cssRules].find(({ selectorText }) => selectorText === ":root").style);

for (const [event, now] of [["beforeprint", true], ["afterprint", false]])
  addEventListener(event, () => {
    printing = now;
    if (dark.matches) dark.dispatchEvent(new Event("change")); // listeners redraw
  });

const seriesColour = (place) => report.colours.series[place % report.colours.series.length];

/** 256 colours [r, g, b] from one end of a scale to the other. */
function table(colourAt) {
  return Array.from({ length: 256 }, (_, i) => colourAt(i / 255));
}

const colourTables = {
  diverging: table((place) => {
    const colours = report.colours.diverging;
    const along = place * (colours.length - 1);
    const i = Math.min(Math.floor(along), colours.length - 2);
    return colours[i].map((c, k) => Math.round(c + (along - i) * (colours[i + 1][k] - c)));
  }),
  sequential: table((place) => {
    const colour = vega.scheme("viridis")(place);
    const parts = colour.startsWith("#") ? colour.slice(1).match(/../g).map((p) => parseInt(p, 16)) : colour.match(/\d+/g).map(Number);
    return parts.slice(0, 3);
  }),
  clumps: table((place) => {
    const hex = report.colours.series[Math.floor(place * 255) % (report.colours.series.length - 1)];
    return hex.slice(1).match(/../g).map((part) => parseInt(part, 16));
  }),
};

/** A range [low, high] with the ends that the description sets, or null; one end of a symmetric range sets both. As in pictures. */
function withEnds([low, high], ends, symmetric) {
  if (!ends) return [low, high];
  const { low: first, high: last } = ends, mirrored = (one) => (symmetric && one !== undefined ? -one : undefined);
  low = first ?? mirrored(last) ?? low;
  high = last ?? mirrored(first) ?? high;
  if (low < high) return [low, high];
  return first !== undefined ? [low, low + (Math.abs(low) || 1)] : [high - (Math.abs(high) || 1), high];
}
/** The ends that a run's description sets for the first of these names; null if it sets none. */
const endsOf = (scales, ...names) => names.map((name) => scales?.find(({ of }) => of === name)).find(Boolean) ?? null;

const rgb = ([r, g, b]) => `rgb(${r},${g},${b})`;
const parsed = (hex) => [1, 3, 5].map((i) => parseInt(hex.length === 4 ? hex[(i + 1) / 2].repeat(2) : hex.slice(i, i + 2), 16));
