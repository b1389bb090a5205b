// Maps: what probes say of cells, a colour each, for the frame that is shown.
"use strict";

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
    this.runs = runs.map((run) => ({ name: run.name, maps: run.grains.maps, frames: run.grains.frames }));
  }
  /** More frames of the same runs, and maybe more maps; a frame is turned to then. */
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
    this.section.append(make("h2", {}, "Maps"), make("div", { className: "controls" }, labelled("of", this.fieldChoice), this.componentLabel, labelled("seen from", this.viewChoice), this.sliceLabel), this.figure);
    this.stage.addEventListener("pointermove", (event) => this.pick(event));
    this.stage.addEventListener("pointerdown", (event) => this.pick(event));
    this.stage.addEventListener("pointerleave", () => this.under.replaceChildren());
    this.stage.addEventListener("keydown", (event) => {
      const acts = this.player.keys();
      if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in acts)) return; // those are the browser's
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
    const names = this.run.maps.flatMap(({ probe, fields }) => fields.map(({ name, label }) => [`${probe}/${name}`, `${probe}: ${label}`]));
    if (!names.some(([name]) => name === this.state.field)) this.state.field = names[0][0];
    offer(this.fieldChoice, names);
    this.takeField(this.state.field);
  }
  takeField(name) {
    this.fieldChoice.value = this.state.field = name;
    this.now = null; // of another probe, maybe
    const { components } = this.field;
    if (this.state.component >= Math.max(1, components.length)) this.state.component = 0;
    this.componentLabel.hidden = components.length < 2;
    offer(this.componentChoice, components.map((label, place) => [String(place), label]));
    this.componentChoice.value = this.state.component;
    const { left_out } = this.map;
    this.about.textContent = this.field.about + (left_out > 0 ? `; ${left_out} frames have no map, so that the page stays light` : "");
    if (this.number !== undefined) this.turn(this.number);
  }
  get map() {
    const probe = this.state.field.slice(0, this.state.field.lastIndexOf("/"));
    return this.run.maps.find((one) => one.probe === probe);
  }
  get field() {
    const name = this.state.field.slice(this.state.field.lastIndexOf("/") + 1);
    return this.map.fields.find((one) => one.name === name);
  }
  /** "E xz", with the component where there are several. */
  get label() {
    const { label, components } = this.field;
    return components.length > 1 ? `${label} ${components[this.state.component]}` : label;
  }

  /** {count, centre and size of three lists [m], values: a list a component of each field}. */
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
  /** The place of a component's list. */
  place(field, component) {
    let place = 0;
    for (const one of this.map.fields) {
      if (one === field) return place + component;
      place += Math.max(1, one.components.length);
    }
  }

  /** The map of a frame, or of the last one before it that has one. */
  async turn(number) {
    this.number = number;
    if (this.section.hidden) return;
    const { map } = this, found = map.frames.findLast(({ frame }) => frame <= number);
    const cells = found ? await this.read(found) : null;
    if (this.number !== number || this.map !== map) return; // overtaken
    this.now = found ? { ...this.run.frames[found.frame], number: found.frame, cells } : null;
    this.draw();
  }

  /** Layers of cells along an axis. */
  layers(axis) {
    const { centre, size } = this.now.cells, [low, high] = rangeOf([centre[axis]]), [, thick] = rangeOf([size[axis]]);
    return thick > 0 ? Math.round((high - low) / thick) + 1 : 1;
  }
  /** Cells that the slice cuts, by their places: it goes through the middle of some, so that it is never between two. */
  seen(view) {
    const { count, centre, size } = this.now.cells, at = centre[view.depth], thick = size[view.depth];
    const [low, high] = rangeOf([at]), wanted = low + this.state.slice * (high - low), all = [];
    this.plane = at.reduce((best, one) => (Math.abs(one - wanted) < Math.abs(best - wanted) ? one : best), Infinity);
    for (let i = 0; i < count; ++i) if (Math.abs(at[i] - this.plane) < 0.49999 * thick[i] || at[i] === this.plane) all.push(i);
    return all;
  }

  /** Fixed over a stage; about zero where values lie on both of its sides. */
  scale() {
    const { field, state } = this, [low, high] = field.ranges[this.now.stage]?.[state.component] ?? [0, 1];
    if (field.signed[state.component]) {
      const most = Math.max(-low, high) || 1;
      return { low: -most, high: most, table: colourTables.diverging };
    }
    return high > low ? { low, high, table: colourTables.sequential } : { low: low - 0.5 * (Math.abs(low) || 1), high: low + 0.5 * (Math.abs(low) || 1), table: colourTables.sequential };
  }

  draw() {
    if (this.section.hidden || !this.run || this.stage.clientWidth === 0) return;
    if (!this.now) {
      this.canvas.getContext("2d").clearRect(0, 0, this.canvas.width, this.canvas.height);
      return;
    }
    if (!this.state.view) { // along the axis that has the fewest layers
      const layers = (name) => this.layers(views[name].depth);
      this.state.view = Object.keys(views).reduce((best, name) => (layers(name) < layers(best) ? name : best));
    }
    this.viewChoice.value = this.state.view;
    const view = views[this.state.view];
    this.sliceLabel.hidden = this.layers(view.depth) < 2;
    const { boxes } = this.map, box = boxes[this.now.stage] ?? Object.values(boxes)[0];
    this.layout = new Layout(this.stage, view, box.low, box.high);
    const { width, height } = this.layout;
    this.canvas.width = Math.round(width * devicePixelRatio), this.canvas.height = Math.round(height * devicePixelRatio);
    const context = this.canvas.getContext("2d");
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    this.paint(new CanvasPen(context), theme());
    const { label, field, now } = this, values = now.cells.list(this.place(field, this.state.component));
    const [low, high] = rangeOf([values]);
    const told = (value) => readable(value * field.factor) + ofUnit(field.shown_unit);
    this.stage.setAttribute("aria-label", `${label} of ${values.length} cells of ${this.map.probe} at ${writtenTime(now.time)}, from ${told(low)} to ${told(high)}`);
    this.stage.dataset.frame = now.number;
  }
  paint(pen, look) {
    const { layout, field, state } = this, { cells } = this.now, view = views[state.view], scale = (this.colours = this.scale());
    const values = cells.list(this.place(field, state.component)), sharp = (pixels) => Math.round(pixels * devicePixelRatio) / devicePixelRatio;
    let unknown = false;
    for (const i of (this.shown = this.seen(view))) {
      const [x, y] = [view.right, view.up].map((axis) => cells.centre[axis][i]), [w, h] = [view.right, view.up].map((axis) => cells.size[axis][i] / 2);
      const left = sharp(layout.across(x - w)), top = sharp(layout.down(y + h)), place = (values[i] - scale.low) / (scale.high - scale.low);
      const known = Number.isFinite(values[i]);
      unknown ||= !known;
      pen.box(left, top, sharp(layout.across(x + w)) - left, sharp(layout.down(y - h)) - top, known ? rgb(scale.table[Math.round(255 * Math.min(1, Math.max(0, place)))]) : look.line);
    }
    drawLengthBar(pen, look, layout);
    const [size, unit] = prefixed("m", Math.abs(this.plane)), slice = this.sliceLabel.hidden ? "" : `${letter(view.depth)} = ${readable(this.plane * size)} ${unit}    `;
    pen.text(layout.width - layout.margin.right, layout.height - 12, `${slice}${letter(view.right)} →  ${letter(view.up)} ↑`, look.soft, "end");
    drawColourScale(pen, look, { ...layout, ...scale, label: this.label, unit: field.shown_unit, factor: field.factor, note: unknown ? "grey: none" : "" });
  }

  pick(event) {
    if (!this.layout || !this.now) return;
    const { field, state } = this, { cells } = this.now, view = views[state.view], at = this.layout.metresAt(this.stage, event), axes = [view.right, view.up];
    const i = this.shown.findLast((one) => axes.every((axis, k) => Math.abs(at[k] - cells.centre[axis][one]) <= cells.size[axis][one] / 2));
    if (i === undefined) return this.under.replaceChildren();
    const value = cells.list(this.place(field, state.component))[i], [size, unit] = prefixed("m", Math.max(...axes.map((axis) => Math.abs(cells.centre[axis][i]))));
    this.under.replaceChildren(make("span", {}, `${this.label} ${readable(value * field.factor)}${ofUnit(field.shown_unit)}`),
      ...axes.map((axis) => make("span", {}, `${letter(axis)} ${readable(cells.centre[axis][i] * size)} ${unit}`)));
  }

  // ---- files

  get fileName() {
    return `${this.run.name}-${this.state.field.replace("/", "-")}-${String(this.now.number).padStart(3, "0")}`;
  }
  saveSvg() {
    const look = theme(), pen = new SvgPen(this.layout.width, this.layout.height, look.paper);
    this.paint(pen, look);
    save(`${this.fileName}.svg`, pen.finish(), "image/svg+xml");
  }
  savePng() {
    const all = make("canvas", { width: this.canvas.width, height: this.canvas.height }), context = all.getContext("2d");
    context.fillStyle = theme().paper;
    context.fillRect(0, 0, all.width, all.height);
    context.drawImage(this.canvas, 0, 0);
    all.toBlob((blob) => save(`${this.fileName}.png`, blob));
  }
  saveCsv() {
    const { field } = this, { cells } = this.now, names = field.components.length > 1 ? field.components.map((one) => `${field.name} ${one}`) : [field.name];
    const lists = [...cells.centre, ...cells.size, ...names.map((_, k) => cells.list(this.place(field, k)))];
    const lines = [["x", "y", "z", "size x", "size y", "size z"].map((one) => `${one} [m]`).concat(names.map((one) => withUnit(one, field.unit))).join(",")];
    for (let i = 0; i < cells.count; ++i) lines.push(lists.map((list) => +list[i].toPrecision(8)).join(","));
    save(`${this.fileName}.csv`, lines.join("\n") + "\n", "text/csv");
  }
}
