// The grains: slider over the frames, view, colours, force chains, walls.
"use strict";

// The quantities that colours show: value in its unit from a frame `of` a stage, and colour table. Factor: unit per SI unit.
const colourings = {
  rotation: { label: "rotation", unit: "°", factor: 180 / Math.PI, table: "diverging", note: "clockwise +", needs: "rotation",
    limit: (of, view) => (of.limits.rotation[view.depth] * 180) / Math.PI,
    value: (of, view, frame) => (i) => ((frame.rotation[view.depth][i] / 65535) * 2 - 1) * of.ranges.rotation * view.away * (180 / Math.PI) },
  displacement: { label: "displacement", unit: "m", table: "diverging", needs: "displacement", note: (view) => `${letter(view.right)} +`,
    limit: (of, view) => of.limits.displacement[view.right],
    value: (of, view, frame) => (i) => ((frame.displacement[view.right][i] / 65535) * 2 - 1) * of.ranges.displacement },
  speed: { label: "speed", unit: "m/s", table: "sequential", limit: (of) => of.limits.speed,
    value: (of, view, frame) => (i) => (frame.speed[i] / 65535) * of.ranges.speed },
  radius: { label: "radius", unit: "m", table: "sequential", between: true, value: (of, view, frame) => (i) => frame.radius[i] },
  layers: { label: "layer", unit: "1", table: "sequential", note: (view, seen) => `by ${letter(view.up)} at the start of ${seen.json.layers.stage}`,
    value: (of, view, frame, seen) => (i) => seen.layers.get(frame.id[i]) ?? -1 },
  group: { label: "group", unit: "1", table: "clumps", needs: "groups", value: (of, view, frame) => (i) => frame.group?.[i] ?? -1 },
  clump: { label: "clump", unit: "1", table: "clumps", needs: "clumps", value: (of, view, frame) => (i) => frame.clump?.[i] ?? -1 },
};

/** The same for a number of bodies from a field of a probe; `place` is its index. In its readable unit. */
const fieldColouring = ({ label, unit, factor, signed }, place) => ({
  label, unit, factor, table: signed ? "diverging" : "sequential",
  limit: (of) => (of.values[place]?.[2] ?? 0) * factor,
  value: (of, view, frame) => {
    const list = frame.values?.[place], [low, high] = of.values[place] ?? [0, 0];
    return (i) => (!list || list[i] === 65535 ? NaN : (low + (list[i] / 65535) * (high - low)) * factor);
  },
});

const layerCount = 10;
const stillAfter = 150; // ms

class GrainView {
  constructor(section, runs, player) {
    this.player = player;
    this.refresh(runs);
    this.state = { run: 0, frame: 0, view: "xz", colour: "speed", cut: 0, chains: false, linear: false, walls: true, wallField: -1, zoom: 1, pan: [0, 0] };
    this.build(section);
    new ResizeObserver(() => this.redraw()).observe(this.stage);
    dark.addEventListener("change", () => this.redraw());
  }
  /** Takes more frames of the same runs; turn() follows. */
  refresh(runs) {
    this.runs = runs.map((run) => ({ name: run.name, frames: framesOf(run.grains), leftOut: run.grains.left_out, picture: run.picture ?? {}, scales: run.color_scales,
      fields: Object.fromEntries(run.grains.values.map((one, place) => [one.name, { ...fieldColouring(one, place), about: one.about, title: `${one.name.split("/")[0]}: ${one.label}` }])) }));
    this.now = this.layersOf = this.shownOf = null;
    if (this.colourChoice) this.offerColours();
  }
  get frames() {
    return this.runs[this.state.run].frames;
  }
  get json() {
    return this.frames.json;
  }
  get view() {
    return views[this.state.view];
  }
  get colouring() {
    return colourings[this.state.colour] ?? this.runs[this.state.run].fields[this.state.colour] ?? colourings.speed;
  }

  // ---- controls

  build(section) {
    const choice = (name, entries, act) => make("select", { name, onchange: (event) => act(event.target.value) }, ...entries.map(([value, label]) => make("option", { value }, label)));
    const labelled = (words, control) => make("label", {}, `${words} `, control);
    const tool = (text, title, act) => make("button", { type: "button", title, onclick: act }, text);
    this.runChoice = choice("run", this.runs.map((run, i) => [i, run.name]), (value) => this.player.takeRun(+value));
    this.viewChoice = choice("view", Object.entries(views).map(([name, one]) => [name, one.label]), (value) => ((this.viewChosen = true), this.change({ view: value, zoom: 1, pan: [0, 0] })));
    this.colourChoice = make("select", { name: "colour", onchange: () => ((this.chosen = true), this.change({ colour: this.colourChoice.value })) });
    this.wallChoice = make("select", { name: "wall-colour", onchange: () => this.change({ wallField: +this.wallChoice.value }) });
    this.wallPlace = labelled("colour of walls", this.wallChoice);
    this.cut = make("input", { type: "range", name: "cut", min: 0, max: 100, value: 0, title: "fraction cut away in front", oninput: () => this.change({ cut: this.cut.value / 100 }) });
    const showChains = () => this.change({ chains: this.chains.checked || this.linear.checked, linear: this.linear.checked });
    this.chains = make("input", { type: "checkbox", name: "chains", onchange: showChains });
    this.linear = make("input", { type: "checkbox", name: "linear", onchange: showChains });
    this.linearLabel = make("label", { title: "linear chains of grains that carry more than the mean force, instead of all contacts above the mean force" }, this.linear, " linear chains");
    this.walls = make("input", { type: "checkbox", name: "walls", checked: true, onchange: () => this.change({ walls: this.walls.checked }) });
    this.canvas = make("canvas", {});
    this.overlay = make("canvas", { className: "overlay" });
    this.stage = make("div", { className: "stage", tabIndex: 0 }, this.canvas, this.overlay);
    this.stage.setAttribute("role", "img");
    this.under = make("output", { className: "values" });
    this.about = make("span", { className: "about" });
    section.append(make("h2", {}, "Grains"),
      make("div", { className: "controls" }, ...(this.runs.length > 1 ? [labelled("run", this.runChoice)] : []), labelled("view", this.viewChoice),
        labelled("colour", this.colourChoice), labelled("cut away", this.cut), make("label", {}, this.chains, " force chains"), this.linearLabel, make("label", {}, this.walls, " walls"), this.wallPlace),
      make("figure", { className: "grains" }, this.stage, this.player.strip(),
        make("figcaption", {}, this.under, this.about, make("span", { className: "tools" }, tool("−", "Zoom out", () => this.scale(1 / 1.4)), tool("+", "Zoom in", () => this.scale(1.4)),
          tool("fit", "Fit the grains and walls of this frame", () => this.fit()), tool("SVG", "Save as SVG", () => this.saveSvg()), tool("PNG", "Save as PNG", () => this.savePng()), tool("CSV", "Save the grains", () => this.saveCsv())))));
    section.querySelector("figure").grains = this;
    this.painter = painterFor(this.canvas);
    this.listen();
  }

  listen() {
    const { stage } = this, fingers = new Map();
    let spread = 0;
    stage.addEventListener("keydown", (event) => {
      const acts = { ...this.player.keys(), "+": () => this.scale(1.4), "-": () => this.scale(1 / 1.4), 0: () => this.change({ zoom: 1, pan: [0, 0] }) };
      if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in acts)) return; // keys of the browser
      event.preventDefault();
      acts[event.key]();
    });
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey && document.activeElement !== stage) return; // the page scrolls
      event.preventDefault();
      this.scale(Math.exp(-event.deltaY * 0.002), event);
    }, { passive: false });
    stage.addEventListener("pointerdown", (event) => {
      stage.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      this.pick(event); // a touch sends no move before
    });
    stage.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return this.pick(event);
      fingers.set(event.pointerId, event);
      if (fingers.size === 2) {
        const [a, b] = [...fingers.values()], now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (spread > 0) this.scale(now / spread, { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 });
        spread = now;
      } else if (event.pointerType === "mouse" || this.state.zoom > 1) {
        const { metresPerPixel } = this.layout;
        const [x, y] = this.state.pan;
        this.change({ pan: [x - (event.clientX - before.clientX) * metresPerPixel, y + (event.clientY - before.clientY) * metresPerPixel] });
      }
    });
    for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, (event) => (fingers.delete(event.pointerId), (spread = 0)));
    stage.addEventListener("pointerleave", () => this.under.replaceChildren());
    stage.addEventListener("dblclick", () => this.change({ zoom: 1, pan: [0, 0] }));
  }

  takeRun(run) {
    this.state.run = run;
    this.now = null;
    const { json } = this;
    const { color, view } = this.runs[run].picture; // from its description, until the user has chosen
    if (!this.chosen) this.state.colour = color ?? "rotation";
    if (!this.viewChosen) this.state.view = view in views ? view : "xz";
    this.viewChoice.value = this.state.view;
    this.state.wallField = -1;
    this.offerColours();
    this.linearLabel.hidden = !json.frames.some((frame) => frame.linear_contacts > 0);
    // Cut a deep specimen near its middle: in front there are walls.
    const { low, high } = json.frames.at(-1).low ? json.frames.at(-1) : json, deep = high[this.view.depth] - low[this.view.depth] > 3 * json.mean_diameter;
    this.cut.value = deep ? 33 : 0;
    this.state.cut = this.cut.value / 100;
  }

  /** The colours that the run has, of grains and of walls. */
  offerColours() {
    const { json, state } = this, needed = { clumps: () => json.clumps, groups: () => json.groups.length > 1 };
    const there = Object.entries(colourings).filter(([, { needs }]) => !needs || (needed[needs] ?? (() => this.frames.has(needs)))()).map(([name, { label }]) => [name, label]);
    there.push(...Object.entries(this.runs[state.run].fields).map(([name, { title }]) => [name, title]));
    if (!there.some(([name]) => name === state.colour)) state.colour = "speed";
    offer(this.colourChoice, there);
    this.colourChoice.value = state.colour;
    if (state.wallField >= json.wall_fields.length) state.wallField = -1;
    offer(this.wallChoice, [["-1", "none"], ...json.wall_fields.map(({ wall, label }, place) => [String(place), `${label} of ${wall}`])]);
    this.wallChoice.value = state.wallField;
    this.wallPlace.hidden = json.wall_fields.length === 0;
  }

  /** Shows a frame, unless another one is requested meanwhile. */
  async turn(number) {
    this.state.frame = number;
    const { frames } = this, frame = await frames.frame(number);
    if (this.state.frame !== number || this.frames !== frames) return; // overtaken
    await this.show(frame);
    if (number + 1 < this.frames.count) this.frames.frame(number + 1);
  }

  // ---- drawing

  change(part) {
    Object.assign(this.state, part);
    return this.now ? this.show(this.now) : undefined;
  }
  scale(factor, at) {
    const zoom = Math.min(200, Math.max(0.2, this.state.zoom * factor)), { pan } = this.state;
    if (at) {
      const { left, top, width, height } = this.stage.getBoundingClientRect(), { metresPerPixel } = this.layout;
      const keep = 1 - this.state.zoom / zoom;
      pan[0] += (at.clientX - left - width / 2) * metresPerPixel * keep;
      pan[1] -= (at.clientY - top - height / 2) * metresPerPixel * keep;
    }
    return this.change({ zoom, pan });
  }

  /** Corners of the box of the centres in the frames of this stage, without those far from all others. */
  extent() {
    return this.frames.extent(this.now.stage) ?? this.json;
  }
  /** Corners of the box of the grains and walls of these frames. */
  outline(frames) {
    return this.frames.outline(frames, this.view, this.state.walls);
  }
  /** The layout on a stage of this size: unless it is zoomed or moved, grains and walls of all frames of this stage. */
  arranged(size, { zoom, pan } = this.state) {
    const { json, view } = this, radius = 0.75 * json.mean_diameter, extent = this.extent();
    const low = extent.low.map((v) => v - radius), high = extent.high.map((v) => v + radius);
    const all = this.outline(json.frames.filter(({ stage }) => stage === this.now.stage)) ?? { low, high };
    const layout = new Layout(size, { left: 14, right: 92, top: 14, bottom: 44 }, view, all.low, all.high, zoom, pan);
    // Depth grows away from the reader.
    const ends = [view.away * low[view.depth], view.away * high[view.depth]].sort((a, b) => a - b);
    const cut = this.state.cut > 0 ? ends[0] + this.state.cut * (ends[1] - ends[0]) : -Infinity;
    return Object.assign(layout, { near: ends[0], far: ends[1], cut: Math.max(cut, ends[0] - 1e-9 - (ends[1] - ends[0])) });
  }

  /** Zooms and moves so that the grains and walls of this frame fill the stage. */
  fit() {
    const [here, all] = [[this.json.frames[this.now.number]], this.json.frames.filter(({ stage }) => stage === this.now.stage)].map((frames) => this.outline(frames));
    if (!here) return this.change({ zoom: 1, pan: [0, 0] });
    const { view } = this, layout = this.arranged(sizeOf(this.stage), { zoom: 1, pan: [0, 0] });
    const wide = (axis) => Math.max(here.high[axis] - here.low[axis], 1e-9), middle = ({ low, high }, axis) => (low[axis] + high[axis]) / 2;
    const zoom = layout.metresPerPixel / layout.metresToFit(wide(view.right), wide(view.up));
    return this.change({ zoom, pan: [view.right, view.up].map((axis) => middle(here, axis) - middle(all, axis)) });
  }

  /** The colour scale: {low, high} of the value, and the table. */
  scaleOfColours(frame) {
    const { json, view, colouring } = this, { factor = 1 } = colouring, ends = endsOf(this.runs[this.state.run].scales, this.state.colour);
    const set = ends && Object.fromEntries(["low", "high"].filter((end) => ends[end] !== undefined).map((end) => [end, ends[end] * factor]));
    const table = colourTables[colouring.table];
    if (colouring.between) {
      const [least, most] = rangeOf([frame.radius]), [low, high] = withEnds([least, most > least ? most : least + 1e-12], set, false);
      return { table, low, high };
    }
    if (this.state.colour === "layers") return { table, low: 1, high: layerCount };
    const limit = (colouring.limit ? colouring.limit(json.stages[frame.stage], view) : 1) || 1, signed = colouring.table === "diverging";
    const [low, high] = withEnds([signed ? -limit : 0, limit], set, signed);
    return { table, low, high };
  }
  places(frame) {
    const value = this.valueOf(frame), { low, high } = this.colours;
    const places = new Float32Array(frame.count);
    if (this.colouring.table === "clumps") {
      for (let i = 0; i < frame.count; ++i) places[i] = value(i) < 0 ? -1 : (value(i) % 251) / 255;
      return places;
    }
    if (this.state.colour === "layers") {
      for (let i = 0; i < frame.count; ++i) places[i] = value(i) < 0 ? -1 : (value(i) - 1) / (layerCount - 1);
      return places;
    }
    for (let i = 0; i < frame.count; ++i) {
      const place = (value(i) - low) / (high - low);
      places[i] = Number.isNaN(place) ? -1 : Math.min(1, Math.max(0, place));
    }
    return places;
  }
  valueOf(frame) {
    return this.colouring.value(this.json.stages[frame.stage], this.view, frame, this);
  }

  /** The layer of each grain by id, from 1: of equal height, along the upward axis of the view. */
  async findLayers() {
    const { frame: number } = this.json.layers, { up } = this.view, key = `${this.state.run} ${number} ${up}`;
    if (this.layersOf === key) return;
    const start = await this.frames.frame(number), list = [start.x, start.y, start.z][up], layers = new Map();
    const box = this.json.frames[number], [low, high] = box.low ? [box.low[up], box.high[up]] : [0, 1]; // without grains far from all others
    for (let i = 0; i < start.count; ++i) {
      const fraction = (this.frames.metres(up, list[i]) - low) / (high - low || 1);
      layers.set(start.id[i], 1 + Math.max(0, Math.min(layerCount - 1, Math.floor(layerCount * fraction))));
    }
    this.layers = layers, this.layersOf = key;
  }

  /** Chains and walls as segments in the plane of the view; widths in pixels, `ratio` of them per CSS pixel. */
  async segments(frame, layout, ratio) {
    const { view, state, json } = this, { cut, near, far } = layout;
    const from = [], to = [], width = [], alpha = [], tint = [];
    const put = (a, b, w, shade, ink = [0, 0, 0, 0]) => (from.push(...a), to.push(...b), width.push(w), alpha.push(shade), tint.push(...ink));
    if (state.chains) {
      const chains = await this.frames.chains(frame.number, state.linear), lists = [frame.x, frame.y, frame.z];
      const slab = Math.max(4 * json.mean_diameter, 0.25 * (far - near)), first = Math.max(near, cut);
      const strongest = json.frames[frame.number].strongest || 1, grain = json.mean_diameter / layout.metresPerPixel;
      for (let i = 0; i < chains.count; ++i) {
        const at = [0, 1, 2].map((axis) => this.frames.metres(axis, lists[axis][chains.body[i]]));
        const depth = view.away * (at[view.depth] + chains.branch[view.depth][i] / 2);
        if (depth < first || depth > first + slab) continue;
        const force = chains.force[i] / strongest;
        put([at[view.right], at[view.up]], [at[view.right] + chains.branch[view.right][i], at[view.up] + chains.branch[view.up][i]],
          Math.max(0.3, 0.3 * grain * force) * ratio, 0.9 - 0.6 * ((depth - first) / slab));
      }
    }
    if (state.walls) {
      const middle = (view.away * (near + far)) / 2, { low, high, table } = this.scaleOfWalls(frame);
      const inkOf = (value) => [...table[Math.round(255 * Math.min(1, Math.max(0, (value - low) / (high - low))))], 255];
      for (const { corners, values } of await this.frames.walls(frame.number, state.wallField))
        for (const [a, b, triangle] of cutBy(view, corners, middle)) values && Number.isFinite(values[triangle]) ? put(a, b, 2.5 * ratio, 1, inkOf(values[triangle])) : put(a, b, ratio, 1);
    }
    return { from: Float32Array.from(from), to: Float32Array.from(to), width: Float32Array.from(width), alpha: Float32Array.from(alpha), tint: Uint8Array.from(tint) };
  }
  /** The field of json.wall_fields that colours walls, if any, and its colour scale in SI; of a run without a frame yet: null. */
  scaleOfWalls(frame) {
    const { wallField } = this.state, field = this.json.wall_fields[wallField], limit = (frame && this.json.stages[frame.stage].wall_fields[wallField]) || 1;
    const [low, high] = withEnds([field?.signed ? -limit : 0, limit], field && endsOf(this.runs[this.state.run].scales, field.name), field?.signed);
    return { field, low, high, table: colourTables[field?.signed ? "diverging" : "sequential"] };
  }

  async show(frame) {
    this.now = frame;
    if (this.stage.clientWidth === 0) return; // removed from the page, or no width
    if (this.state.colour === "layers") {
      await this.findLayers();
      if (this.now !== frame) return;
    }
    this.layout = this.arranged(sizeOf(this.stage));
    fitStage(this.stage, this.layout);
    const segments = await this.segments(frame, this.layout, devicePixelRatio);
    if (this.now !== frame) return;
    const { state } = this, key = `${state.run} ${frame.number} ${state.colour} ${state.view}`;
    if (this.shownOf !== key) { // else only zoomed or moved
      this.colours = this.scaleOfColours(frame);
      this.shownPlaces = this.places(frame);
      this.painter.setBodies(frame);
      this.painter.setPlaces(this.shownPlaces);
      this.painter.setColours(this.colours.table);
      this.shownOf = key;
    }
    this.shownSegments = segments;
    this.painter.setSegments(segments);
    this.paint();
    this.stage.setAttribute("aria-label", `${frame.count} grains at ${writtenTime(frame.time)}, coloured by ${this.colouring.label}`);
    this.stage.dataset.frame = frame.number;
    const { leftOut } = this.runs[this.state.run], { unplaced, strays } = this.json.frames[frame.number];
    this.about.textContent = [leftOut > 0 ? `${this.frames.count} of ${this.frames.count + leftOut} frames, to limit the size of the page` : "", this.colouring.about ?? "",
      this.json.values_left_out > 0 ? `colours omitted to limit the size of the page: ${this.json.values_left_out}` : "",
      strays > 0 ? `far from all others and initially out of view: ${strays}` : "",
      unplaced > 0 ? `bodies omitted, without a finite position or too far away: ${unplaced}` : ""].filter(Boolean).join("; ");
    this.painted = frame;
  }
  redraw() {
    if (this.now) this.show(this.now);
  }

  whatToDraw(layout, look, ratio) {
    const { json, view } = this, axes = new Float32Array(9);
    axes[3 * view.right] = 1, axes[3 * view.up + 1] = 1, axes[3 * view.depth + 2] = view.away;
    return {
      low: json.low, span: json.high.map((high, i) => high - json.low[i]), axes, view, look, fade: this.state.chains ? 0.72 : 0,
      window: [...layout.centre, 2 / (layout.width * layout.metresPerPixel), 2 / (layout.height * layout.metresPerPixel)],
      depth: [layout.cut, layout.near, Math.max(layout.far - layout.near, 1e-12)], metresPerPixel: (0.5 * layout.metresPerPixel) / ratio,
      panelWidth: Math.round(panel(layout)[2] * ratio),
    };
  }
  /** A slow drawing is refined only when nothing moves, or on request. */
  paint(fine = printing) {
    const { layout } = this, look = theme();
    for (const canvas of [this.canvas, this.overlay]) {
      const width = Math.round(layout.width * devicePixelRatio), height = Math.round(layout.height * devicePixelRatio);
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
    }
    const coarse = this.painter.draw({ ...this.whatToDraw(layout, look, devicePixelRatio), fine });
    clearTimeout(this.refining);
    if (coarse) this.refining = setTimeout(() => this.paint(true), stillAfter);
    const context = this.overlay.getContext("2d");
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.clearRect(0, 0, layout.width, layout.height);
    this.annotate(new CanvasPen(context), look, layout);
  }

  /** Indices of the visible grains, the farthest first. */
  seen(layout = this.layout) {
    const { view, now } = this, list = [now.x, now.y, now.z][view.depth];
    const depth = (i) => view.away * this.frames.metres(view.depth, list[i]);
    const all = [];
    for (let i = 0; i < now.count; ++i) if (depth(i) >= layout.cut) all.push(i);
    return all.sort((a, b) => depth(b) - depth(a));
  }
  drawGrains(pen, look, layout, { from, to, width, alpha, tint }) {
    const { view, now } = this, lists = [now.x, now.y, now.z];
    const fade = this.state.chains ? 0.72 : 0, paper = parsed(look.paper);
    const mixed = (colour) => rgb(colour.map((c, k) => Math.round(c + fade * (paper[k] - c))));
    const fills = this.colours.table.map(mixed), rims = this.colours.table.map((colour) => mixed(colour.map((c) => c * 0.55))), grey = mixed([180, 180, 176]);
    for (const i of this.seen(layout)) {
      const place = this.shownPlaces[i], k = Math.round(place * 255);
      pen.disc(layout.across(this.frames.metres(view.right, lists[view.right][i])), layout.down(this.frames.metres(view.up, lists[view.up][i])),
        Math.max(0.5, now.radius[i] / layout.metresPerPixel), place < 0 ? grey : fills[k], place < 0 ? "#666" : rims[k]);
    }
    for (let i = 0; i < width.length; ++i)
      pen.line(layout.across(from[2 * i]), layout.down(from[2 * i + 1]), layout.across(to[2 * i]), layout.down(to[2 * i + 1]), inkOf(tint, i, look), 2 * width[i], alpha[i]);
  }

  /** Scale bar, axes and colour scales: that of walls below that of grains. */
  annotate(pen, look, layout) {
    const { view, colours, colouring } = this, { width, height, margin } = layout;
    drawLengthBar(pen, look, layout);
    pen.box(width - margin.right - 58, height - 26, 62, 20, look.paper);
    pen.text(width - margin.right, height - 12, `${letter(view.right)} →  ${letter(view.up)} ↑`, look.soft, "end");
    const { field, ...ofWalls } = this.scaleOfWalls(this.now), walls = field && this.state.walls, grains = colouring.table !== "clumps";
    const tall = walls && grains ? Math.min(240, Math.max(30, height / 2 - 80)) : Math.min(240, height - 110);
    if (grains) {
      const [factor, unit] = prefixed(colouring.unit, Math.max(Math.abs(colours.low), Math.abs(colours.high)));
      drawColourScale(pen, look, { width, first: 0, tall, ...colours, label: colouring.label, unit, factor,
        note: typeof colouring.note === "function" ? colouring.note(view, this) : colouring.note });
    }
    if (walls) drawColourScale(pen, look, { width, first: grains ? tall + 62 : 0, tall, ...ofWalls, label: field.label, unit: field.unit, factor: field.factor, note: field.wall });
  }

  /** Shows the values of the grain under the pointer. */
  pick(event) {
    if (!this.now || !this.layout) return;
    const { view, now, layout } = this, lists = [now.x, now.y, now.z], [right, up] = layout.metresAt(this.stage, event);
    let found = -1, nearest = Infinity;
    for (let i = 0; i < now.count; ++i) {
      const dx = this.frames.metres(view.right, lists[view.right][i]) - right, dy = this.frames.metres(view.up, lists[view.up][i]) - up;
      if (dx * dx + dy * dy > now.radius[i] * now.radius[i]) continue;
      const depth = view.away * this.frames.metres(view.depth, lists[view.depth][i]);
      if (depth >= layout.cut && depth < nearest) (nearest = depth), (found = i);
    }
    if (found < 0) return this.under.replaceChildren();
    const { colouring } = this, value = this.valueOf(now)(found), [size, unit] = prefixed("m", now.radius[found]);
    const [scale, shown] = prefixed(colouring.unit, Math.abs(value));
    const rest = ["radius", "clump"].includes(this.state.colour) || (this.state.colour === "layers" && value < 0) ? [] : [make("span", {}, this.state.colour === "group" ? `group ${this.json.groups[value]}` : `${colouring.label} ${readable(value * scale)}${ofUnit(shown)}`)];
    this.under.replaceChildren(make("span", {}, `grain ${now.id[found]}`), make("span", {}, `radius ${readable(now.radius[found] * size)} ${unit}`), ...rest);
  }

  // ---- files

  get fileName() {
    return `${this.runs[this.state.run].name}-grains-${String(this.now.number).padStart(3, "0")}`;
  }
  async saveSvg() {
    const { fileName } = this, look = filesLook(), layout = this.arranged(fileSize), pen = new SvgPen(layout.width, layout.height, look.paper);
    const segments = await this.segments(this.now, layout, 1);
    pen.within(panel(layout), () => this.drawGrains(pen, look, layout, segments));
    this.annotate(pen, look, layout);
    save(`${fileName}.svg`, pen.finish(), "image/svg+xml");
  }
  async savePng() {
    const { fileName, now, shownPlaces, colours } = this, look = filesLook(), layout = this.arranged(fileSize), what = this.whatToDraw(layout, look, filePixels);
    const painter = new PixelPainter(make("canvas", { width: filePixels * layout.width, height: filePixels * layout.height }));
    painter.setBodies(now), painter.setPlaces(shownPlaces), painter.setColours(colours.table);
    painter.setSegments(await this.segments(now, layout, filePixels));
    painter.draw({ ...what, fine: true });
    const all = fileCanvas(layout, (pen) => {
      pen.image(painter.canvas, 0, 0, layout.width, layout.height);
      this.annotate(pen, look, layout);
    });
    all.toBlob((blob) => save(`${fileName}.png`, blob));
  }
  saveCsv() {
    const { now, colouring } = this, lists = [now.x, now.y, now.z], value = this.valueOf(now);
    const lines = [`id,x [m],y [m],z [m],radius [m],${withUnit(colouring.label, colouring.unit)}`];
    for (let i = 0; i < now.count; ++i)
      lines.push([now.id[i], ...lists.map((list, axis) => this.frames.metres(axis, list[i]).toPrecision(6)), now.radius[i].toPrecision(6), colouring.unit === "1" ? value(i) : value(i).toPrecision(5)].join(","));
    save(`${this.fileName}.csv`, lines.join("\n") + "\n", "text/csv");
  }
}

function runsWithGrains() {
  return report.runs.filter((run) => run.grains && run.grains.frames.length > 0);
}

/** Grains, and maps of cells below them, with the same slider. */
function showFrames(grains, maps) {
  const runs = runsWithGrains();
  if (runs.length === 0) return;
  const player = new Player(runs);
  player.viewers.push(new GrainView(grains, runs, player), new MapView(maps, runs, player));
  player.takeRun(0);
}
