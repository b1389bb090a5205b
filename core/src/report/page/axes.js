// Axes: ticks and their labels, for charts and maps.
"use strict";

/** 1, 2 or 5 times a power of ten, at most `most`. */
function niceBelow(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((lead) => lead * power).find((one) => one <= most * 1.0001) ?? power;
}
/** Multiples of a step within a range. */
function multiples(step, low, high) {
  const all = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) all.push(k * step || 0);
  return all;
}
/** The label of a tick at an axis with tick spacing `step`. */
function atTick(value, step) {
  if (step >= 1e5 || step < 1e-5) return readable(value);
  return value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))).replace("-", "−");
}

const mostTicks = 8;
/** The number of ticks that fit into a length, `each` px wide. */
const ticksWithin = (length, each) => Math.max(2, Math.min(mostTicks, Math.floor(length / each)));
const ticksAcross = (width) => ticksWithin(width, 40);
const ticksUp = (height) => ticksWithin(height, 22);

/** Tick spacings for at most `most` ticks in a range, from too fine to coarse enough. */
function tickSteps(low, high, most) {
  const power = 10 ** Math.floor(Math.log10((high - low) / most));
  return [1, 2, 5, 10, 20].map((lead) => lead * power);
}
/** The finest spacing with at most `most` ticks in a range; it gives 4 or more, in few ranges 3. */
function tickStep(low, high, most = mostTicks) {
  return tickSteps(low, high, most).find((step) => multiples(step, low, high).length <= most);
}

const raised = (power) => String(power).replace("-", "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);
/** Powers of ten within a range, about `count` of them; if there are fewer than three, also their 2- and 5-fold. */
function powersWithin([low, high], count) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), every = Math.max(1, Math.ceil((last - first + 1) / count));
  if (last - first < 2)
    return [first - 1, first, last, last + 1].filter((power, i, all) => all.indexOf(power) === i).flatMap((power) => [1, 2, 5].map((lead) => +`${lead}e${power}`))
      .filter((value) => value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9));
  return Array.from({ length: last - first + 1 }, (_, i) => first + i).filter((power) => power % every === 0).map((power) => +`1e${power}`);
}
/** "0.01", "500", "10⁵", "2·10⁻⁷". */
function atPower(value) {
  if (value >= 1e-3 && value < 1e5) return readable(value);
  const power = Math.floor(Math.log10(value) + 1e-9), lead = Math.round(value / 10 ** power);
  return `${lead === 1 ? "" : `${lead}·`}10${raised(power)}`;
}

/** Ticks, labels and titles below and to the left of a frame [px], in a view along an axis. */
function drawAxes(pen, look, layout, view, { left, top, right, bottom }) {
  const largest = Math.max(...[left, right].map((x) => Math.abs(layout.metresAcross(x))), ...[top, bottom].map((y) => Math.abs(layout.metresUp(y))));
  const [factor, unit] = prefixed("m", largest);
  const along = (low, high, count, draw) => {
    const step = tickStep(low * factor, high * factor, count);
    for (const value of multiples(step, low * factor, high * factor)) draw(value / factor, atTick(value, step));
  };
  along(layout.metresAcross(left), layout.metresAcross(right), ticksAcross(right - left), (at, words) => {
    pen.line(layout.across(at), bottom, layout.across(at), bottom + 4, look.frame, 1);
    pen.text(layout.across(at), bottom + 17, words, look.soft, "middle", 11.5);
  });
  along(layout.metresUp(bottom), layout.metresUp(top), ticksUp(bottom - top), (at, words) => {
    pen.line(left - 4, layout.down(at), left, layout.down(at), look.frame, 1);
    pen.text(left - 8, layout.down(at) + 4, words, look.soft, "end", 11.5);
  });
  for (const [x1, y1, x2, y2] of [[left, top, right, top], [right, top, right, bottom], [left, bottom, right, bottom], [left, top, left, bottom]])
    pen.line(x1, y1, x2, y2, look.frame, 1);
  pen.text((left + right) / 2, bottom + 35, withUnit(letter(view.right), unit), look.ink, "middle", 12.5);
  pen.text(left - 44, (top + bottom) / 2, withUnit(letter(view.up), unit), look.ink, "middle", 12.5, true);
}
