// Lists with a position or a direction for each number: profiles and polar plots at several instants.
"use strict";

/** The index of the last of ascending numbers that is not above `most`; 0 if all are above. */
function lastUpTo(rising, most) {
  let low = 0, high = rising.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (rising[middle] <= most) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/** The samples of a probe's lists to show: that of the slider, and those kept; by default those at one and two thirds. */
class TimeChoice {
  constructor(changed) {
    this.changed = changed;
    this.kept = null;
    this.chosen = null; // s; null: the end
    this.slider = make("input", { type: "range", name: "sample", min: 0, max: 1000, value: 1000, oninput: () => this.choose(this.slider.value / 1000) });
    this.slider.setAttribute("aria-label", "time of profiles and directions");
    this.shown = make("output", { className: "clock" });
    const button = (text, title, act) => make("button", { type: "button", title, onclick: act }, text);
    this.controls = make("div", { className: "controls times" }, make("label", {}, "profiles and directions at ", this.slider), this.shown,
      button("keep", "Keep this time in the charts", () => this.keep(this.times)), button("only this", "Show only this time", () => this.keep([])));
  }
  /** Reads the available times from the channels of time: a slider at the end stays at the end. */
  read(channels) {
    this.known = Promise.all(channels.map(({ channel }) => numbersOf(channel.data))).then((lists) => {
      this.span = rangeOf(lists);
      const [low, high] = this.span;
      this.slider.value = this.chosen === null || high === low ? 1000 : (1000 * (this.chosen - low)) / (high - low);
      this.showTime();
    });
  }
  at(part) {
    return this.span[0] + part * (this.span[1] - this.span[0]);
  }
  get now() {
    return this.chosen ?? this.span[1];
  }
  /** Times in seconds; that of the slider is the last. */
  get times() {
    return [...(this.kept ?? [1 / 3, 2 / 3].map((part) => this.at(part))), this.now];
  }
  inWords(seconds) {
    return writtenTime(seconds, Math.max(...this.span.map(Math.abs)));
  }
  showTime() {
    this.shown.textContent = this.inWords(this.now);
    this.slider.setAttribute("aria-valuetext", this.shown.textContent);
  }
  choose(part) {
    if (!this.span) return;
    this.chosen = part < 1 ? this.at(part) : null;
    this.showTime();
    this.changed();
  }
  keep(times) {
    if (!this.span) return;
    this.kept = times;
    this.changed();
  }
}

/** The value at an instant of the abscissa in the description's picture: ": settlement 3.2 mm"; empty for time. */
async function abscissaAt({ picture, probes }, seconds) {
  const [probe, name] = (picture?.x ?? "").split("/"), channels = probes.find((one) => one.name === probe)?.channels ?? [];
  const x = channels.find((one) => one.name === name && one.width === 1), time = channels.find((one) => one.name === "time");
  if (!x || !time || x === time) return "";
  const times = await numbersOf(time.data), i = lastUpTo(times, seconds), value = (await numbersOf(x.data))[i];
  return times[i] <= seconds && Number.isFinite(value) ? `: ${x.label} ${valueWithUnit(value * x.factor, x)}` : "";
}

class ListChart extends Chart {
  get abscissa() {
    return this.group.coordinateOf(this.channel) ?? { label: "number", shown_unit: "1", unit: "1", factor: 1, name: "number" };
  }
  async load() {
    const { choice } = this.group, series = [], many = report.runs.length > 1;
    await choice.known;
    for (const { run, place, channel, probe } of this.group.channelsNamed(this.name)) {
      if (channel.unit !== this.channel.unit) continue;
      const { width } = channel, all = await numbersOf(channel.data), samples = all.length / width;
      const named = (name) => probe.channels.find((one) => one.name === name), time = named("time"), where = named(this.abscissa.name);
      const instants = time ? await numbersOf(time.data) : Float64Array.from({ length: samples }, (_, i) => i), places = where && (await numbersOf(where.data));
      for (const [k, wanted] of choice.times.entries()) {
        if (samples === 0) continue;
        const sample = Math.min(samples - 1, lastUpTo(instants, wanted)), row = (list) => list.slice(sample * width, (sample + 1) * width);
        const label = `${many ? `${run.name} ` : ""}${choice.inWords(instants[sample])}${await abscissaAt(run, instants[sample])}`;
        if (series.some((one) => one.label === label)) continue;
        series.push({ run, label, x: places ? row(places) : Float64Array.from({ length: width }, (_, i) => i + 1), y: row(all), colour: many ? place + k * report.runs.length : k });
      }
    }
    return series;
  }
}

/** A list over frequency: logarithmic axes, as spectra span many powers of ten. */
class SpectrumChart extends ListChart {
  get byPowers() {
    return true;
  }
}

/** A list over direction, as a polar plot. */
class PolarChart extends ListChart {
  settle() {
    const [, most] = rangeOf(this.series.map(({ shownY }) => shownY)), high = most > 0 ? most : 1;
    this.step = niceBelow(high / 2);
    this.reach = Math.max(Math.ceil((high / this.step) * (1 - 1e-9)), 1) * this.step;
  }
  /** Rings replace them. */
  ticks() {
    return {};
  }
  /** 180°, in the unit of the directions. */
  get half() {
    return this.abscissa.shown_unit.startsWith("rad") ? Math.PI : 180;
  }
  at(angle, radius) {
    return { x: radius * Math.cos((angle / this.half) * Math.PI), y: radius * Math.sin((angle / this.half) * Math.PI) };
  }
  pointOf({ shownX, shownY }, i) {
    return Number.isFinite(shownY[i]) ? this.at(shownX[i], Math.max(0, shownY[i])) : { x: null, y: null };
  }
  /** A stepped outline around the centre: each number covers the directions around it. */
  outline({ shownX, shownY, s }) {
    const wide = shownX.length > 1 ? Math.abs(shownX[1] - shownX[0]) / 2 : this.half, points = [];
    shownX.forEach((angle, i) => [-1, -0.5, 0, 0.5, 1].forEach((part) =>
      points.push({ ...(Number.isFinite(shownY[i]) ? this.at(angle + part * wide, Math.max(0, shownY[i])) : { x: null, y: null }), s })));
    return [...points, points[0]];
  }

  spec(width, look) {
    const spec = super.spec(width, look), { half, reach, step } = this, font = pageFont(), size = this.size(width);
    const rings = Array.from({ length: Math.round(reach / step) }, (_, k) => (k + 1) * step);
    const grid = rings.flatMap((radius) => Array.from({ length: 121 }, (_, i) => ({ ...this.at((i / 60) * half, radius), g: String(radius) })));
    for (let k = 0; k < 6; ++k) for (const end of [k, k + 6]) grid.push({ ...this.at((end / 6) * half, reach), g: `spoke ${k}` });
    const names = [0, 90, 180, 270].map((degree) => ({ ...this.at((degree / 180) * half, 1.13 * reach), t: `${degree}°` }));
    const radii = rings.map((radius) => ({ ...this.at(half * 5 / 12, radius), t: readable(radius) }));
    const at = (field) => ({ scale: field, field });
    const lines = (data, by, stroke) => ({ type: "group", from: { facet: { name: `${data} one`, data, groupby: by } },
      marks: [{ type: "line", interactive: false, from: { data: `${data} one` }, encode: { update: { x: at("x"), y: at("y"), defined: { signal: "isValid(datum.x)" }, strokeJoin: { value: "round" }, ...stroke } } }] });
    const words = (data, colour) => ({ type: "text", interactive: false, from: { data }, encode: { update: { x: at("x"), y: at("y"), text: { field: "t" },
      fill: { value: colour }, font: { value: font }, fontSize: { value: 11.5 }, baseline: { value: "middle" }, align: { value: "center" } } } });
    const places = this.series.length < 2 ? [] : legendPlaces(this.series, width), legend = legendParts(places, 12, look, font), near = spec.marks.find(({ type }) => type === "symbol"), title = spec.marks.find(({ name }) => name === "title");
    return { ...spec, height: size, padding: { ...around, bottom: 12 + legendHeight(places) }, axes: [],
      data: [{ name: "grid", values: grid }, { name: "names", values: names }, { name: "radii", values: radii },
        { name: "curves", values: this.series.flatMap((one) => this.outline(one)) }, { name: "near", values: [] }, legend.data],
      scales: spec.scales.map((scale) => (["x", "y"].includes(scale.name) ? { ...scale, nice: false, domain: this.domain(scale.name, width) } : scale)),
      marks: [title, lines("grid", "g", { stroke: { value: look.line } }), words("names", look.soft),
        lines("curves", "s", { stroke: { scale: "colour", field: "s" }, strokeDash: { scale: "dash", field: "s" }, strokeWidth: { value: 2 } }),
        words("radii", look.soft), near, ...legend.marks] };
  }
  /** Equal scales along both axes, whatever the width. */
  domain(axis, width) {
    const half = 1.2 * this.reach * (axis === "x" ? width / this.size(width) : 1);
    return [-half, half];
  }
  size(width) {
    return Math.min(width, plotHeight + 80);
  }

  point(event) {
    if (!this.view) return;
    const area = this.area(), right = event.clientX - (area.left + area.right) / 2, up = (area.top + area.bottom) / 2 - event.clientY;
    if (Math.hypot(right, up) > 0.5 * area.height) return this.show(null);
    const turn = 2 * this.half, angle = (Math.atan2(up, right) / Math.PI) * this.half;
    const off = (one) => Math.abs(((((one - angle) % turn) + 1.5 * turn) % turn) - turn / 2);
    this.show(this.series.map(({ shownX }) => shownX.reduce((best, one, i) => (off(one) < off(shownX[best]) ? i : best), 0)));
  }
}
