// Curves: a chart for each channel of each probe, with all runs, and values at the pointer.
"use strict";

const componentNames = ({ width, components }) =>
  components.length === width ? components : width === 3 ? ["x", "y", "z"] : width === 9 ? ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"] : Array.from({ length: width }, (_, i) => String(i + 1));

// Margins in pixels, the same for all charts, so that their axes are aligned.
const around = { left: 58, right: 20, top: 34, bottom: 44 }, plotHeight = 180;
const mostPowers = 10; // powers of ten along an axis
const widestForLines = 9; // numbers per sample; more are a list, of which some samples are drawn

/** Smallest and largest finite number. */
function rangeOf(lists) {
  let low = Infinity, high = -Infinity;
  for (const list of lists)
    for (const value of list)
      if (Number.isFinite(value)) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
  return low <= high ? [low, high] : [0, 1];
}

/** {ends, step} of a vertical axis: includes zero if it is near, and has a minimum height. */
function settled([low, high]) {
  if (low > 0 && low < 0.5 * high) low = 0;
  if (high < 0 && high > 0.5 * low) high = 0;
  if (high - low <= 1e-12 * Math.max(Math.abs(low), Math.abs(high))) {
    const room = low === 0 ? 1 : 0.5 * Math.abs(low);
    return { ends: [low - room, high + room], step: tickStep(low - room, high + room, 5) };
  }
  // From tick to tick, without an extra tick for noise about one.
  const room = 0.03 * (high - low), most = ticksUp(plotHeight);
  const reaches = (step) => [Math.floor((low + room) / step + 1e-9), Math.ceil((high - room) / step - 1e-9)];
  const step = tickSteps(low, high, most).find((one) => reaches(one)[1] - reaches(one)[0] < most);
  return { ends: reaches(step).map((tick) => +(tick * step).toPrecision(12)), step }; // rounded: else the first tick may lie below
}
/** Powers of ten that enclose the positive numbers, at most `most`. */
function settledPowers(lists, most) {
  const [low, high] = rangeOf(lists.map((list) => list.filter((value) => value > 0)));
  const last = Math.ceil(Math.log10(high) - 1e-9), first = Math.max(last - most, Math.min(last - 1, Math.floor(Math.log10(low) + 1e-9)));
  return low > 0 ? [+`1e${first}`, +`1e${last}`] : [0.1, 1];
}

/** Indices of the points needed for a line of `pixels`: lowest and highest of each piece. */
function pointsToDraw(y, pixels) {
  const pieces = 2 * pixels;
  if (y.length <= 2 * pieces) return y.keys();
  const places = [0];
  for (let piece = 0; piece < pieces; ++piece) {
    const first = Math.floor((piece * y.length) / pieces), end = Math.floor(((piece + 1) * y.length) / pieces);
    let low = first, high = first, gap = -1; // a gap is kept
    for (let i = first; i < end; ++i) {
      if (!Number.isFinite(y[i])) gap = i;
      else {
        if (!(y[i] >= y[low])) low = i;
        if (!(y[i] <= y[high])) high = i;
      }
    }
    places.push(...[...new Set(gap < 0 ? [low, high] : [low, high, gap])].sort((a, b) => a - b));
  }
  places.push(y.length - 1);
  return places;
}

const whenIdle = (act) => (window.requestIdleCallback ?? ((run) => setTimeout(run, 100)))(act);

/** A value with its unit. */
const valueWithUnit = (value, { shown_unit }) => readable(value) + (Number.isFinite(value) ? ofUnit(shown_unit) : "");
/** Vega leaves a gap for null, but would draw an infinite number. */
const drawable = (value) => (Number.isFinite(value) ? value : null);
const pageFont = () => getComputedStyle(document.body).fontFamily;

/** One channel of one probe over an abscissa, for all runs that have it. */
class Chart {
  constructor(group, name) {
    this.group = group;
    this.name = name;
    this.channel = group.channelsNamed(name)[0].channel;
    this.plot = make("div", { className: "plot" });
    this.values = make("output", { className: "values" });
    const tool = (text, title, act) => make("button", { type: "button", title, onclick: () => act.call(this) }, text);
    this.about = make("span", { className: "about" }, this.channel.about);
    this.figure = make("figure", { className: "chart", tabIndex: 0 }, this.plot,
      make("figcaption", {}, this.values, this.about,
        make("span", { className: "tools" }, tool("SVG", "Save as SVG", this.saveSvg), tool("PNG", "Save as PNG", this.savePng),
          tool("CSV", "Save the values, in SI", this.saveCsv))));
    this.figure.chart = this;
    this.figure.setAttribute("role", "group");
    this.figure.setAttribute("aria-label", `${this.channel.label}; arrow keys show values`);
    this.plot.addEventListener("pointermove", (event) => this.point(event));
    this.plot.addEventListener("pointerdown", (event) => this.point(event));
    this.plot.addEventListener("pointerleave", () => this.show(null));
    this.figure.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.fit()).observe(this.plot);
    dark.addEventListener("change", () => this.view && this.draw());
    new IntersectionObserver((entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      this.draw();
    }, { rootMargin: "400px" }).observe(this.figure);
  }

  /** Also if out of view, so that a printed page contains it; but not during a run, where every drawn chart is redrawn at each update. */
  drawSoon() {
    if (report.live || this.view) return;
    whenIdle(() => !this.drawing && this.figure.isConnected && !this.figure.hidden && this.draw());
  }

  get abscissa() {
    return this.group.abscissaOf(this.name);
  }
  /** Whether its axes are logarithmic. */
  get byPowers() {
    return false;
  }

  /** [{run, label, x, y, colour, dashed}], x and y as in series.h5, for each run that has both, in the same units; `without` names the other runs. */
  async load() {
    const series = [], { abscissa } = this, without = [];
    for (const { run, place, channel, probe } of this.group.channelsNamed(this.name)) {
      const parts = componentNames(channel);
      const many = report.runs.length > 1;
      const against = probe.channels.find((one) => one.name === abscissa.name && one.unit === abscissa.unit);
      if (channel.unit !== this.channel.unit || (!against && abscissa.data !== undefined)) {
        without.push(run.name);
        continue;
      }
      const all = await numbersOf(channel.data);
      const x = against ? await numbersOf(against.data) : Float64Array.from({ length: all.length / channel.width }, (_, i) => i);
      parts.forEach((part, k) => {
        const y = channel.width === 1 ? all : Float64Array.from({ length: all.length / channel.width }, (_, i) => all[i * channel.width + k]);
        const label = [many ? run.name : "", channel.width > 1 ? part : ""].filter(Boolean).join(" ") || this.channel.label;
        series.push({ run, label, x, y, colour: many && channel.width === 1 ? place : series.length });
      });
    }
    return Object.assign([...series, ...(await this.references(series))], { without });
  }
  /** The references of the descriptions for this channel: curves over this abscissa, and constant values. */
  async references(series) {
    const full = `${this.group.name}/${this.name}`, found = new Map();
    for (const run of report.runs) for (const one of run.references) {
      const against = one.against || `${this.group.name}/time`;
      if (one.of !== full || (one.value === undefined && against !== `${this.group.name}/${this.abscissa.name}`)) continue;
      const [x, y] = one.value === undefined ? [await numbersOf(one.x), await numbersOf(one.y)]
        : [Float64Array.from(rangeOf(series.map(({ x }) => x))), Float64Array.of(one.value, one.value)];
      found.set(one.name, { label: one.name, x, y, colour: series.length + found.size, reference: true });
    }
    return [...found.values()];
  }

  async draw() {
    const drawing = (this.drawing = {}), series = await this.load();
    if (this.drawing !== drawing) return; // overtaken
    this.series = series;
    const { abscissa, channel } = this;
    const shown = (list, factor) => Float64Array.from(list, (value) => value * factor);
    for (const one of this.series) {
      one.shownX = shown(one.x, abscissa.factor);
      one.shownY = shown(one.y, channel.factor);
    }
    this.series.forEach((one, place) => (one.s = String(place)));
    this.settle();
    this.about.textContent = channel.about + (series.without?.length > 0 ? `; not against ${abscissa.label}: ${series.without.join(", ")}` : "");
    this.view?.finalize();
    this.view = new vega.View(vega.parse(this.spec(this.width, theme())), { renderer: "svg", container: this.plot, hover: false });
    this.view.run();
    this.plot.setAttribute("role", "img"); // Vega sets another one
    this.plot.setAttribute("aria-label", this.inWords());
    this.figure.dataset.drawn = "yes";
  }

  /** Sets the ranges of the axes. */
  settle() {
    if (this.byPowers) {
      const [low, high] = rangeOf(this.series.map((one) => one.shownX.filter((value) => value > 0)));
      this.xDomain = low > 0 && high > low ? [low, high] : [0.1, 1];
      this.yDomain = settledPowers(this.series.map((one) => one.shownY), mostPowers);
      return;
    }
    this.xDomain = rangeOf(this.series.map((one) => one.shownX));
    if (this.xDomain[0] === this.xDomain[1]) this.xDomain = [this.xDomain[0] - 0.5, this.xDomain[1] + 0.5];
    const { ends, step } = settled(rangeOf(this.series.map((one) => one.shownY)));
    this.yDomain = ends, this.yStep = step;
  }
  /** The chart as text, for screen readers. */
  inWords() {
    const between = (list, of) => rangeOf([list]).map((value) => valueWithUnit(value, of)).join(" to ");
    const each = this.series.map(({ label, shownX, shownY }) => `${label} ${between(shownY, this.channel)} over ${between(shownX, this.abscissa)}`);
    return `${this.channel.label} against ${this.abscissa.label}: ${each.join("; ")}`;
  }
  /** The coordinates of a point of a series; null is not drawn. */
  pointOf({ shownX, shownY }, i) {
    const there = (value) => (this.byPowers && !(value > 0) ? null : drawable(value));
    return { x: there(shownX[i]), y: there(shownY[i]) };
  }
  /** Position of a value along an axis, from 0 to 1. */
  along(value, [low, high]) {
    return this.byPowers ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  /** Redraws with the new data of its group, also if it is being drawn for the first time. */
  async refresh() {
    this.channel = this.group.channelsNamed(this.name)[0].channel;
    if (!this.drawing) return;
    const { places } = this;
    await this.draw();
    if (this.view) this.show(places?.length === this.series.length ? places : null);
  }

  /** The Vega specification, `width` pixels between the axes. */
  spec(width, look) {
    const values = [], font = pageFont();
    for (const one of this.series) for (const i of pointsToDraw(one.shownY, 800)) values.push({ ...this.pointOf(one, i), s: one.s });
    const axis = { domain: false, ticks: false, gridColor: look.line, labelColor: look.soft, titleColor: look.ink, labelFont: font,
      titleFont: font, labelFontSize: 11.5, titleFontSize: 12.5, titleFontWeight: 400, grid: true, labelOverlap: true,
      encode: { labels: { update: { text: { signal: "replace(replace(datum.label, /,/g, '\u202f'), '-', '−')" } } } }, labelPadding: 6, titlePadding: 8, zindex: 0 };
    const at = (field) => ({ scale: field, field });
    const visible = "isValid(datum.x) && isValid(datum.y)", keys = this.series.map(({ s }) => s);
    const places = this.series.length < 2 ? [] : legendPlaces(this.series, width), legend = legendParts(places, around.bottom + 6, look, font);
    const scaleOf = (name, range, domain) => ({ name, type: this.byPowers ? "log" : "linear", range, domain, nice: false, ...(this.byPowers ? {} : { zero: false }) });
    return {
      width, height: plotHeight, padding: { ...around, bottom: around.bottom + legendHeight(places) }, autosize: "none",
      background: look.paper,
      data: [{ name: "curves", values }, { name: "near", values: [] }, legend.data],
      scales: [
        scaleOf("x", "width", this.xDomain),
        scaleOf("y", "height", this.yDomain),
        { name: "colour", type: "ordinal", domain: keys, range: this.series.map((one) => this.colour(one, look)) },
        { name: "dash", type: "ordinal", domain: keys, range: this.series.map((one) => this.dash(one)) },
      ],
      axes: [
        { ...axis, scale: "x", orient: "bottom", title: withUnit(this.abscissa.label, this.abscissa.shown_unit), ...this.ticks(this.xDomain, ticksAcross(width)) },
        { ...axis, scale: "y", orient: "left", ...this.ticks(this.yDomain, ticksUp(plotHeight), this.yStep) },
      ],
      marks: [
        { type: "text", name: "title", interactive: false, encode: { update: { x: { value: 2 - around.left }, y: { value: -16 }, text: { value: withUnit(this.channel.label, this.channel.shown_unit) },
          fill: { value: look.ink }, font: { value: font }, fontSize: { value: 13.5 }, fontWeight: { value: 600 } } } },
        ...(this.byPowers ? [] : [{ type: "rule", encode: { update: { x: { value: 0 }, x2: { field: { group: "width" } }, y: { scale: "y", value: 0 }, stroke: { value: look.frame },
          opacity: { signal: "inrange(0, domain('y')) ? 1 : 0" } } } }]),
        { type: "group", encode: { update: { width: { signal: "width" }, height: { signal: "height" }, clip: { value: this.byPowers } } }, from: { facet: { name: "one", data: "curves", groupby: "s" } },
          marks: [{ type: "line", interactive: false, from: { data: "one" }, encode: { update: { x: at("x"), y: at("y"), defined: { signal: visible },
            stroke: { scale: "colour", field: "s" }, strokeDash: { scale: "dash", field: "s" }, strokeWidth: { value: 2 }, strokeJoin: { value: "round" }, strokeCap: { value: "round" } } } }] },
        { type: "rule", interactive: false, from: { data: "near" }, encode: { update: { x: at("x"), y: { value: 0 }, y2: { field: { group: "height" } },
          stroke: { value: look.frame }, strokeDash: { value: [3, 3] }, opacity: { signal: "datum.k === 0 ? 1 : 0" } } } },
        { type: "symbol", interactive: false, from: { data: "near" }, encode: { update: { x: at("x"), y: at("y"), size: { value: 60 },
          fill: { scale: "colour", field: "s" }, stroke: { value: look.paper }, strokeWidth: { value: 1.5 } } } },
        ...legend.marks,
      ],
    };
  }
  /** Ticks of an axis: at most `count`, or about `count` powers of ten. */
  ticks(domain, count, step) {
    if (!this.byPowers) return { tickCount: (domain[1] - domain[0]) / (step ?? tickStep(...domain, count)) };
    const values = powersWithin(domain, count), words = Object.fromEntries(values.map((value) => [value, atPower(value)]));
    return { values, encode: { labels: { update: { text: { signal: `(${JSON.stringify(words)})[datum.value]` } } } } };
  }

  /** Lines are dashed when colours repeat, and for references. */
  dash({ colour, reference }) {
    return reference ? [[2, 4], [8, 3, 2, 3]][colour % 2] : colour < report.colours.series.length ? [1, 0] : [7, 4];
  }
  colour({ colour, reference }, look = theme()) {
    return reference ? look.soft : seriesColour(colour);
  }
  get width() {
    return Math.max(160, this.plot.clientWidth - around.left - around.right);
  }
  /** Redraws the chart after a change of width, as the legend may need more rows. */
  fit() {
    if (this.view && Math.abs(this.view.width() - this.width) >= 2) this.draw();
  }

  /** The rectangle between the axes on the screen. */
  area() {
    return this.plot.querySelector(".role-frame.root .background").getBoundingClientRect();
  }

  point(event) {
    if (!this.view) return;
    const area = this.area();
    const x = (event.clientX - area.left) / area.width, y = (area.bottom - event.clientY) / area.height;
    if (x < -0.02 || x > 1.02 || y < -0.1 || y > 1.1) return this.show(null);
    this.show(this.series.map((one) => this.nearest(one, x, y, area)));
  }

  /** The point nearest to a position in the area; the horizontal distance has ten times the weight of the vertical. */
  nearest({ shownX, shownY }, x, y, area) {
    let best = -1, least = Infinity;
    for (let i = 0; i < shownX.length; ++i) {
      const dx = (this.along(shownX[i], this.xDomain) - x) * area.width, dy = 0.1 * (this.along(shownY[i], this.yDomain) - y) * area.height;
      const distance = dx * dx + dy * dy;
      if (distance < least) (least = distance), (best = i);
    }
    return best;
  }

  /** Marks a point of each series and shows its values; null: none. */
  show(places) {
    this.places = places;
    const points = (places ?? []).flatMap((i, k) => (i < 0 ? [] : [{ ...this.pointOf(this.series[k], i), s: this.series[k].s, k, i }]));
    this.view?.data("near", points.filter(({ x, y }) => x !== null && y !== null)).runAsync();
    this.values.replaceChildren(...(points.length === 0 ? [] : [`${this.abscissa.label} ${valueWithUnit(this.series[points[0].k].shownX[points[0].i], this.abscissa)}`]),
      ...points.map(({ k, i }) => make("span", {}, make("span", { className: "key", style: `background:${this.colour(this.series[k])}` }),
        `${this.series[k].label} ${valueWithUnit(this.series[k].shownY[i], this.channel)}`)));
  }

  /** The sample with the nearest abscissa; among equals, the one at the most similar index. */
  nearestX(list, wanted, along) {
    let best = -1, least = Infinity, off = Infinity;
    for (let i = 0; i < list.length; ++i) {
      const distance = Math.abs(list[i] - wanted), aside = Math.abs(i / list.length - along);
      if (distance < least || (distance === least && aside < off)) (least = distance), (off = aside), (best = i);
    }
    return best;
  }

  key(event) {
    const steps = { ArrowLeft: -1, ArrowRight: 1, Home: -Infinity, End: Infinity };
    if (event.target !== this.figure || !this.series) return;
    if (event.key === "Escape") return this.show(null);
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in steps)) return; // keys of the browser
    event.preventDefault();
    const far = event.shiftKey ? 20 : 1;
    // The longest series steps by samples, and the others follow its abscissa.
    const leader = this.series.reduce((best, { x }, k) => (x.length > this.series[best].x.length ? k : best), 0), { x } = this.series[leader];
    const i = Math.min(x.length - 1, Math.max(0, (this.places?.[leader] ?? -1) + far * steps[event.key]));
    this.show(this.series.map((one) => (one.x[i] === x[i] ? i : this.nearestX(one.x, x[i], i / x.length))));
  }

  get fileName() {
    const names = report.runs.map((run) => run.name), named = names.length > 3 ? [names[0], `and-${names.length - 1}-more`] : names; // file systems take 255 bytes
    return [...named, this.group.name, this.name].join("-");
  }
  /** The view written to files. */
  fileView() {
    return new vega.View(vega.parse(this.spec(fileSize.width - around.left - around.right, filesLook())), { renderer: "none" });
  }
  async saveSvg() {
    save(`${this.fileName}.svg`, await this.fileView().toSVG(), "image/svg+xml");
  }
  async savePng() {
    const canvas = await this.fileView().toCanvas(filePixels);
    canvas.toBlob((blob) => save(`${this.fileName}.png`, blob));
  }
  saveCsv() {
    const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
    const names = this.series.flatMap(({ label }) => [withUnit(this.abscissa.name, this.abscissa.unit), withUnit(label === this.channel.label ? this.name : `${this.name} ${label}`, this.channel.unit)]);
    const lines = [names.map(quoted).join(",")];
    const rows = Math.max(...this.series.map(({ x }) => x.length));
    for (let i = 0; i < rows; ++i) lines.push(this.series.map(({ x, y }) => (i < x.length ? `${x[i]},${y[i]}` : ",")).join(","));
    save(`${this.fileName}.csv`, lines.join("\n") + "\n", "text/csv");
  }
}

/** All channels of a probe over one abscissa, for all runs that have it. */
class ProbeCharts {
  constructor(name) {
    this.name = name;
    this.read();
    this.against = this.abscissas.find((one) => this.scalars().includes(one)) ?? "time";
  }
  /** Reads the present data of this probe. */
  read() {
    const { name } = this;
    this.probes = report.runs.map((run, place) => ({ run, place, probe: run.probes.find((one) => one.name === name) })).filter(({ probe }) => probe);
    this.names = [...new Set(this.probes.flatMap(({ probe }) => probe.channels.map((channel) => channel.name)))];
    const here = (names) => [...new Set(names)].filter((one) => one?.startsWith(`${name}/`)).map((one) => one.slice(name.length + 1));
    this.abscissas = here(report.runs.map(({ picture }) => picture?.x));
    this.shown = here(report.runs.flatMap(({ picture }) => picture?.y ?? []));
    const rank = (one) => (this.shown.includes(one) ? this.shown.indexOf(one) : this.shown.length);
    const sampled = (one) => this.channelsNamed(one).some(({ channel }) => channel.filled);
    const seen = this.names.filter((one) => one !== "time" && sampled(one) && !this.isCoordinate(one)).sort((a, b) => rank(a) - rank(b));
    this.zero = seen.filter((one) => this.isZero(one));
    this.ordered = seen.filter((one) => !this.zero.includes(one));
    this.choice?.read(this.channelsNamed("time"));
  }
  /** Whether it is 0 throughout, and no description names its curve. */
  isZero(name) {
    const full = `${this.name}/${name}`, asked = this.shown.includes(name) || report.runs.some(({ references }) => references.some(({ of }) => of === full));
    return !asked && this.channelsNamed(name).every(({ channel }) => channel.zero || !channel.filled);
  }
  /** The channel with the coordinate of each number of a list; results of older versions always use "position". */
  coordinateOf({ name, coordinate, width }) {
    const wanted = coordinate || (width > widestForLines && name !== "position" ? "position" : "");
    return this.channelsNamed(wanted).find(({ channel }) => channel.width === width)?.channel;
  }
  /** Whether a channel is only the coordinate of others. */
  isCoordinate(name) {
    return this.names.some((other) => this.coordinateOf(this.channelsNamed(other)[0].channel)?.name === name);
  }
  isList(name) {
    const { channel } = this.channelsNamed(name)[0];
    return channel.width > widestForLines || this.coordinateOf(channel) !== undefined;
  }
  chart(name) {
    if (!this.isList(name)) return new Chart(this, name);
    const unit = this.coordinateOf(this.channelsNamed(name)[0].channel)?.unit ?? "";
    return new (/^(rad|deg)/.test(unit) ? PolarChart : unit === "Hz" ? SpectrumChart : ListChart)(this, name);
  }
  channelsNamed(name) {
    return this.probes.map((one) => ({ ...one, channel: one.probe.channels.find((channel) => channel.name === name) })).filter(({ channel }) => channel);
  }
  scalars() {
    return this.names.filter((name) => this.channelsNamed(name).every(({ channel }) => channel.width === 1));
  }
  /** Abscissa of a channel: the chosen one if a run has both; otherwise that of the picture in a description, or time. */
  abscissaOf(name) {
    const runs = this.channelsNamed(name).map(({ probe }) => probe.channels), named = (wanted) => runs.map((channels) => channels.find((one) => one.name === wanted && one.filled)).find(Boolean);
    return [this.against, ...this.abscissas, "time"].filter((one) => one !== name).map(named).find(Boolean) ?? { name: "sample", label: "sample", unit: "1", shown_unit: "1", factor: 1 };
  }
  fill(parent) {
    const choice = make("select", { onchange: () => this.turn(choice.value) },
      ...this.scalars().map((name) => make("option", { value: name, selected: name === this.against }, this.channelsNamed(name)[0].channel.label)));
    this.grid = make("div", { className: "charts" });
    this.more = make("button", { type: "button", className: "more", onclick: () => this.unfold(!this.unfolded) });
    parent.append(make("label", { className: "against" }, "against ", choice));
    if (this.ordered.some((one) => this.isList(one))) {
      this.choice = new TimeChoice(() => {
        for (const { chart } of this.grid.children) if (chart instanceof ListChart && chart.view) chart.draw();
      });
      this.choice.read(this.channelsNamed("time"));
      parent.append(this.choice.controls);
    }
    parent.append(this.grid, this.more);
    if (this.zero.length > 0) parent.append(make("p", { className: "zero" }, `0 throughout: ${this.zero.map((one) => this.channelsNamed(one)[0].channel.label).join(", ")}`));
    this.turn(this.against);
  }
  /** Channels named by the picture of the description are shown at once; many others on request. */
  unfold(unfolded) {
    this.unfolded = unfolded;
    const rest = [...this.grid.children].filter(({ chart }) => !this.shown.includes(chart.name)), many = rest.length > 2 && rest.length < this.grid.children.length;
    for (const figure of rest) figure.hidden = many && !unfolded;
    for (const { chart } of this.grid.children) chart.drawSoon();
    this.more.hidden = !many;
    this.more.textContent = unfolded ? "fewer" : `${rest.length} more`;
    this.more.setAttribute("aria-expanded", unfolded);
  }
  turn(against) {
    this.against = against;
    this.grid.replaceChildren(...this.ordered.filter((name) => name !== against).map((name) => this.chart(name).figure));
    this.unfold(this.unfolded ?? false);
  }
}

/** All probes of all runs. */
function curveGroups() {
  return [...new Set(report.runs.flatMap((run) => run.probes.map((probe) => probe.name)))].map((name) => new ProbeCharts(name));
}

function showCurves(section) {
  const groups = curveGroups();
  if (groups.length === 0) return;
  section.append(make("h2", {}, "Curves"));
  const isNamed = ({ names, shown }) => shown.some((one) => names.includes(one)), named = groups.filter(isNamed);
  for (const charts of groups) {
    const { name } = charts;
    const count = charts.ordered.length + charts.zero.length;
    if (count === 0) {
      section.append(make("p", { className: "probe" }, make("b", {}, name), make("small", {}, " no samples")));
      continue;
    }
    const part = make("details", { className: "probe" }, make("summary", {}, name, make("small", {}, ` ${count} channel${count === 1 ? "" : "s"}`)));
    part.addEventListener("toggle", () => part.open && !charts.grid && charts.fill(part));
    part.charts = charts;
    part.open = named.length > 0 ? named.includes(charts) : !section.querySelector("details");
    section.append(part);
  }
}
