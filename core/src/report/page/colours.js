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

const rgb = ([r, g, b]) => `rgb(${r},${g},${b})`;
const parsed = (hex) => [1, 3, 5].map((i) => parseInt(hex.length === 4 ? hex[(i + 1) / 2].repeat(2) : hex.slice(i, i + 2), 16));
