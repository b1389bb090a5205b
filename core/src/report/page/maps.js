// Maps: values of cells from probes, as colours, for the frame shown.
"use strict";

const mapMargin = { left: 62, right: 78, top: 46, bottom: 46 }; // px, around the frame

class MapView {
  constructor(section, runs, player) {
    this.section = section;
    this.player = player;
    this.readRuns(runs);
    this.state = { field: "", component: 0, view: null, slice: 0.5 };
    this.cells = new Map();
    this.build();
    new ResizeObserver(() => this.draw()).observe(this.stage);
    dark.addEventListener("change", () => this.draw());
  }

  readRuns(runs) {
    this.runs = runs.map((run) => ({ name: run.name, maps: run.grains.maps, scales: run.color_scales, frames: run.grains.frames, grains: framesOf(run.grains) }));
  }
  /** Takes more frames, and possibly more maps, of the same runs; turn() follows. */
  refresh(runs) {
    this.readRuns(runs);
    this.takeRun(this.shownRun);
  }

  build() {
    const tool = (text, title, act) => make("button", { type: "button", title, onclick: act }, text);
    const labelled = (words, control) => make("label", {}, `${words} `, control);
    this.fieldChoice = make("select", { name: "field", onchange: () => this.takeField(this.fieldChoice.value) });
    this.componentChoice = make("select", { name: "component", onchange: () => ((this.state.component = +this.componentChoice.value), this.draw()) });
    this.componentLabel = labelled("component", this.componentChoice);
    this.viewChoice = make("select", { name: "map-view", onchange: () => ((this.state.view = this.viewChoice.value), this.draw()) },
      ...Object.entries(views).map(([value, { label }]) => make("option", { value }, label)));
    this.slice = make("input", { type: "range", name: "slice", min: 0, max: 1, step: 0.01, value: 0.5, oninput: () => ((this.state.slice = +this.slice.value), this.draw()) });
    this.sliceLabel = labelled("slice", this.slice);
    this.canvas = make("canvas");
    this.stage = make("div", { className: "stage", tabIndex: 0 }, this.canvas);
    this.stage.setAttribute("role", "img");
    this.under = make("output", { className: "values" });
    this.about = make("span", { className: "about" });
    this.figure = make("figure", { className: "map" }, this.stage, this.player.strip(), make("figcaption", {}, this.under, this.about,
      make("span", { className: "tools" }, tool("SVG", "Save as SVG", () => this.saveSvg()), tool("PNG", "Save as PNG", () => this.savePng()), tool("CSV", "Save the cells of this frame, in SI", () => this.saveCsv()))));
    this.figure.map = this;
    this.section.append(make("h2", {}, "Maps"), make("div", { className: "controls" }, labelled("field", this.fieldChoice), this.componentLabel, labelled("view", this.viewChoice), this.sliceLabel), this.figure);
    this.stage.addEventListener("pointermove", (event) => this.pick(event));
    this.stage.addEventListener("pointerdown", (event) => this.pick(event));
    this.stage.addEventListener("pointerleave", () => this.under.replaceChildren());
    this.stage.addEventListener("keydown", (event) => {
      const acts = this.player.keys();
      if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in acts)) return; // keys of the browser
      event.preventDefault();
      acts[event.key]();
    });
  }

  takeRun(run) {
    this.shownRun = run;
    this.run = this.runs[run];
    this.section.hidden = this.run.maps.length === 0;
    this.cells.clear();
    this.now = null;
    if (this.section.hidden) return;
    const names = this.run.maps.flatMap(({ probe, fields }) => fields.map(({ name, label, rank }) => [`${probe}/${name}`, `${probe}: ${label}`, rank]))
      .sort((a, b) => a[2] - b[2]).map(([value, label]) => [value, label]);
    if (!names.some(([name]) => name === this.state.field)) this.state.field = names[0][0];
    offer(this.fieldChoice, names);
    this.takeField(this.state.field);
  }
  takeField(name) {
    if (this.componentOf !== name) this.state.component = -1;
    this.fieldChoice.value = this.state.field = this.componentOf = name;
    this.now = null; // possibly of another probe
    const { components, unit } = this.field;
    // The default component of a strain is shear.
    const shear = unit === "1" ? components.findIndex((one) => one.length === 2 && one[0] !== one[1]) : -1;
    if (this.state.component < 0 || this.state.component >= Math.max(1, components.length)) this.state.component = Math.max(0, shear);
    this.componentLabel.hidden = components.length < 2;
    offer(this.componentChoice, components.map((label, place) => [String(place), label]));
    this.componentChoice.value = this.state.component;
    const { left_out } = this.map;
    this.about.textContent = `${this.field.about}; the colour scale ${this.ends ? "has ends set by the description" : "covers 98 % of the cells of each stage"}` + (left_out > 0 ? `; ${left_out} frames have no map, to limit the size of the page` : "");
    if (this.number !== undefined) this.turn(this.number);
  }
  get frames() {
    return this.run.grains;
  }
  get map() {
    const probe = this.state.field.slice(0, this.state.field.lastIndexOf("/"));
    return this.run.maps.find((one) => one.probe === probe);
  }
  get field() {
    const name = this.state.field.slice(this.state.field.lastIndexOf("/") + 1);
    return this.map.fields.find((one) => one.name === name);
  }
  /** "E xz", with the component if there are several. */
  get label() {
    const { label, components } = this.field;
    return components.length > 1 ? `${label} ${components[this.state.component]}` : label;
  }

  /** {count, centre and size as three lists each [m], values: one list per component of each field}. */
  read({ cells, data }) {
    if (!this.cells.has(data)) {
      if (this.cells.size > kept) this.cells.delete(this.cells.keys().next().value);
      this.cells.set(data, inflated(data).then((buffer) => {
        const all = new Float32Array(buffer), list = (i) => all.subarray(cells * i, cells * (i + 1));
        return { count: cells, centre: [0, 1, 2].map(list), size: [3, 4, 5].map(list), list: (i) => list(6 + i) };
      }));
    }
    return this.cells.get(data);
  }
  /** The index of a component's list. */
  place(field, component) {
    let place = 0;
    for (const one of this.map.fields) {
      if (one === field) return place + component;
      place += Math.max(1, one.components.length);
    }
  }

  /** Shows the map of a frame, or of the last one before it that has one. */
  async turn(number) {
    this.number = number;
    if (this.section.hidden) return;
    const { map, frames } = this, found = map.frames.findLast(({ frame }) => frame <= number);
    const [cells, walls] = found ? await Promise.all([this.read(found), frames.walls(found.frame)]) : [];
    if (this.number !== number || this.map !== map) return; // overtaken
    this.now = found ? { ...this.run.frames[found.frame], number: found.frame, cells, walls } : null;
    this.draw();
  }

  /** Number of layers of cells along an axis. */
  layers(axis) {
    const { centre, size } = this.now.cells, [low, high] = rangeOf([centre[axis]]), [, thick] = rangeOf([size[axis]]);
    return thick > 0 ? Math.round((high - low) / thick) + 1 : 1;
  }
  /** Indices of the cells that the slice cuts: it passes through centres of cells, so that it is never between two. */
  seen(view) {
    const { count, centre, size } = this.now.cells, at = centre[view.depth], thick = size[view.depth];
    const [low, high] = rangeOf([at]), wanted = low + this.state.slice * (high - low), all = [];
    this.plane = at.reduce((best, one) => (Math.abs(one - wanted) < Math.abs(best - wanted) ? one : best), Infinity);
    for (let i = 0; i < count; ++i) if (Math.abs(at[i] - this.plane) < 0.49999 * thick[i] || at[i] === this.plane) all.push(i);
    return all;
  }

  /** The colour scale, fixed over a stage or by the description; symmetric about zero for signed quantities, whatever the values. */
  scale() {
    const { field, state } = this, signed = field.signed[state.component];
    let [low, high] = field.ranges[this.now.stage]?.[state.component] ?? [0, 1];
    if (signed) (high = Math.max(-low, high) || 1), (low = -high);
    else if (!(high > low)) [low, high] = [low - 0.5 * (Math.abs(low) || 1), low + 0.5 * (Math.abs(low) || 1)];
    [low, high] = withEnds([low, high], this.ends, signed);
    return { low, high, table: colourTables[signed ? "diverging" : "sequential"] };
  }
  /** Those of the colour scale that the description sets. */
  get ends() {
    const { field, state } = this;
    return endsOf(this.run.scales, `${state.field}/${field.components[state.component]}`, state.field);
  }

  /** The layout on a stage of this size: all cells, and grains around them up to half the width of their box. */
  arranged(size, view) {
    const { stage } = this.now, { boxes } = this.map, cells = boxes[stage] ?? Object.values(boxes)[0], grains = this.frames.extent(stage) ?? cells;
    const radius = 0.75 * this.frames.json.mean_diameter, most = cells.low.map((low, axis) => (cells.high[axis] - low) / 2);
    const low = cells.low.map((one, axis) => Math.max(Math.min(one, grains.low[axis] - radius), one - most[axis]));
    const high = cells.high.map((one, axis) => Math.min(Math.max(one, grains.high[axis] + radius), one + most[axis]));
    const room = 0.03 * Math.max(high[view.right] - low[view.right], high[view.up] - low[view.up]); // for walls
    const layout = new Layout(size, mapMargin, view, low.map((one) => one - room), high.map((one) => one + room));
    const [left, right] = [low[view.right] - room, high[view.right] + room].map((at) => Math.round(layout.across(at)));
    const [bottom, top] = [low[view.up] - room, high[view.up] + room].map((at) => Math.round(layout.down(at)));
    return Object.assign(layout, { frame: { left, right, top, bottom } });
  }

  draw() {
    if (this.section.hidden || !this.run || this.stage.clientWidth === 0) return;
    const context = this.canvas.getContext("2d");
    if (!this.now) {
      context.clearRect(0, 0, this.canvas.width, this.canvas.height);
      return;
    }
    if (!this.state.view) { // along the axis with the fewest layers
      const layers = (name) => this.layers(views[name].depth);
      this.state.view = Object.keys(views).reduce((best, name) => (layers(name) < layers(best) ? name : best));
    }
    this.viewChoice.value = this.state.view;
    const view = views[this.state.view];
    this.sliceLabel.hidden = this.layers(view.depth) < 2;
    this.layout = this.arranged(sizeOf(this.stage), view);
    fitStage(this.stage, this.layout);
    const { width, height } = this.layout;
    this.canvas.width = Math.round(width * devicePixelRatio), this.canvas.height = Math.round(height * devicePixelRatio);
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    this.under.replaceChildren();
    this.colours = this.scale();
    this.shown = this.seen(view);
    this.byPixel = this.paint(new CanvasPen(context), theme(), this.layout, devicePixelRatio);
    const { label, field, now } = this, values = now.cells.list(this.place(field, this.state.component));
    const [low, high] = rangeOf([values]);
    const [from, to] = [low, high].map((value) => valueWithUnit(value * field.factor, field));
    this.stage.setAttribute("aria-label", `${label} of ${values.length} cells of ${this.map.probe} at ${writtenTime(now.time)}, from ${from} to ${to}`);
    this.stage.dataset.frame = now.number;
  }
  /** Returns {owner, width, height}: for each pixel of the frame the index of its cell; `ratio` pixels per CSS pixel. */
  paint(pen, look, layout, ratio) {
    const { field, state, colours, shown, now } = this, { cells } = now, view = views[state.view], { left, right, top, bottom } = layout.frame;
    const values = cells.list(this.place(field, state.component)), list = (of) => Float64Array.from(shown, of), size = (axis, i) => Math.max(0.5, (0.5 * cells.size[axis][i] * ratio) / layout.metresPerPixel);
    const width = Math.max(1, Math.round((right - left) * ratio)), height = Math.max(1, Math.round((bottom - top) * ratio));
    const owner = cellsByPixel({
      x: list((i) => (layout.across(cells.centre[view.right][i]) - left) * ratio), y: list((i) => (layout.down(cells.centre[view.up][i]) - top) * ratio),
      w: list((i) => size(view.right, i)), h: list((i) => size(view.up, i)),
    }, width, height);
    const grey = parsed(look.line), place = (value) => Math.round(255 * Math.min(1, Math.max(0, (value - colours.low) / (colours.high - colours.low))));
    const colourOf = (k) => (Number.isFinite(values[shown[k]]) ? colours.table[place(values[shown[k]])] : grey);
    pen.within([left, top, right - left, bottom - top], () => {
      pen.image(imageOfCells(owner, width, height, colourOf), left, top, right - left, bottom - top);
      for (const { corners } of now.walls) for (const [a, b] of cutBy(view, corners, this.plane))
        pen.line(layout.across(a[0]), layout.down(a[1]), layout.across(b[0]), layout.down(b[1]), look.ink, 1.5);
    });
    drawAxes(pen, look, layout, view, layout.frame);
    const [scale, unit] = prefixed("m", Math.abs(this.plane)), slice = this.layers(view.depth) < 2 ? "" : `  ·  ${letter(view.depth)} = ${readable(this.plane * scale)} ${unit}`;
    pen.text(left, top - 26, withUnit(this.label, field.shown_unit), look.ink, "start", 13.5, false, 600);
    pen.text(left, top - 9, `${writtenTime(now.time)}${slice}`, look.soft, "start", 11.5);
    drawColourBar(pen, look, { left: right + 16, top, tall: Math.min(320, bottom - top), ...colours, factor: field.factor });
    if (shown.some((i) => !Number.isFinite(values[i]))) pen.text(right + 16, Math.min(top + 320, bottom) + 17, "grey: no value", look.soft, "start", 11);
    return { owner, width, height };
  }

  pick(event) {
    if (!this.layout || !this.now) return;
    const { field, state, layout } = this, { cells } = this.now, view = views[state.view], axes = [view.right, view.up];
    const { owner, width, height } = this.byPixel, { left, top } = this.stage.getBoundingClientRect();
    const column = Math.floor((event.clientX - left - layout.frame.left) * devicePixelRatio), row = Math.floor((event.clientY - top - layout.frame.top) * devicePixelRatio);
    const i = column >= 0 && column < width && row >= 0 && row < height ? this.shown[owner[row * width + column]] : undefined;
    if (i === undefined) return this.under.replaceChildren();
    const value = cells.list(this.place(field, state.component))[i], [size, unit] = prefixed("m", Math.max(...axes.map((axis) => Math.abs(cells.centre[axis][i]))));
    this.under.replaceChildren(make("span", {}, `${this.label} ${valueWithUnit(value * field.factor, field)}`),
      ...axes.map((axis) => make("span", {}, `${letter(axis)} ${readable(cells.centre[axis][i] * size)} ${unit}`)));
  }

  // ---- files

  get fileName() {
    return `${this.run.name}-${this.state.field.replace("/", "-")}-${String(this.now.number).padStart(3, "0")}`;
  }
  saveSvg() {
    const look = filesLook(), layout = this.arranged(fileSize, views[this.state.view]), pen = new SvgPen(layout.width, layout.height, look.paper);
    this.paint(pen, look, layout, filePixels);
    save(`${this.fileName}.svg`, pen.finish(), "image/svg+xml");
  }
  savePng() {
    const { fileName } = this, layout = this.arranged(fileSize, views[this.state.view]);
    fileCanvas(layout, (pen) => this.paint(pen, filesLook(), layout, filePixels)).toBlob((blob) => save(`${fileName}.png`, blob));
  }
  saveCsv() {
    const { field } = this, { cells } = this.now, names = field.components.length > 1 ? field.components.map((one) => `${field.name} ${one}`) : [field.name];
    const lists = [...cells.centre, ...cells.size, ...names.map((_, k) => cells.list(this.place(field, k)))];
    const lines = [["x", "y", "z", "size x", "size y", "size z"].map((one) => `${one} [m]`).concat(names.map((one) => withUnit(one, field.unit))).join(",")];
    for (let i = 0; i < cells.count; ++i) lines.push(lists.map((list) => +list[i].toPrecision(8)).join(","));
    save(`${this.fileName}.csv`, lines.join("\n") + "\n", "text/csv");
  }
}
