// The frames of a run, decoded when shown.
"use strict";

const kept = 6; // frames in memory, around the one shown
const wallReach = 0.35; // of the extent of the grains, as in pictures

class GrainFrames {
  constructor(json) {
    this.json = json;
    this.sets = new Map();
    this.absolute = new Map();
    this.frames = new Map();
    this.wallCorners = new Map();
  }
  get count() {
    return this.json.frames.length;
  }
  /** Corners of the box of the grains of a stage, without those far from all others. By stage, as a falling cloud is taller than the packing. */
  extent(stage) {
    const same = this.json.frames.filter((frame) => frame.stage === stage && frame.low);
    if (same.length === 0) return null;
    const over = (key, of) => [0, 1, 2].map((axis) => of(...same.map((frame) => frame[key][axis])));
    return { low: over("low", Math.min), high: over("high", Math.max) };
  }
  /**
   * Corners of the box of the grains of some frames, without those far from all others, with the walls that the middle plane of a view cuts.
   * Of walls no more than a third of the extent of the grains around them, as they may be far larger. Null without grains.
   */
  outline(frames, view, walls) {
    const seen = frames.filter((frame) => frame.surface), axes = [view.right, view.up];
    if (seen.length === 0) return null;
    const corner = (end, of) => [0, 1, 2].map((axis) => of(...seen.map(({ surface }) => surface[end][axis])));
    const grains = [corner(0, Math.min), corner(1, Math.max)], low = [...grains[0]], high = [...grains[1]];
    if (!walls) return { low, high };
    const reach = wallReach * Math.max(...axes.map((axis) => high[axis] - low[axis])), middle = (low[view.depth] + high[view.depth]) / 2;
    for (const frame of seen)
      for (const [wall, ...moved] of frame.walls) {
        const [first, last] = ["low", "high"].map((end) => this.json.walls[wall][end].map((one, axis) => one + moved[axis]));
        if (first[view.depth] > middle || last[view.depth] < middle) continue;
        if (axes.some((axis) => last[axis] < grains[0][axis] - reach || first[axis] > grains[1][axis] + reach)) continue; // e.g. a gate moved far away
        for (const axis of axes) {
          low[axis] = Math.min(low[axis], Math.max(first[axis], grains[0][axis] - reach));
          high[axis] = Math.max(high[axis], Math.min(last[axis], grains[1][axis] + reach));
        }
      }
    return { low, high };
  }
  has(range) {
    return Object.values(this.json.stages).every(({ ranges }) => ranges[range] !== undefined);
  }

  /** Radius [m], id and clump of the bodies of a set. */
  set(number) {
    if (!this.sets.has(number)) {
      const { count, data, clumps, groups } = this.json.bodies[number];
      const integers = (buffer, place) => new Int32Array(buffer, 4 * place * count, count);
      this.sets.set(number, inflated(data).then((buffer) => ({
        radius: new Float32Array(buffer, 0, count),
        id: integers(buffer, 1),
        clump: clumps ? integers(buffer, 2) : null,
        group: groups ? integers(buffer, clumps ? 3 : 2) : null,
      })));
    }
    return this.sets.get(number);
  }

  /** Positions of a base frame, relative to which others are stored; x of all bodies, y, z. */
  base(number) {
    if (!this.absolute.has(number)) {
      const { set, data } = this.json.frames[number];
      this.absolute.set(number, planesOf(data).then((all) => all.slice(0, 3 * this.json.bodies[set].count)));
    }
    return this.absolute.get(number);
  }

  /** {time, step, stage, count, radius, id, clump, x, y, z, speed, rotation, displacement, values}; 16-bit lists from x on; values: one list for each of json.values, or null. */
  frame(number) {
    if (!this.frames.has(number)) {
      this.frames.set(number, this.read(number));
      if (this.frames.size > kept) this.frames.delete(this.frames.keys().next().value);
    }
    return this.frames.get(number);
  }
  async read(number) {
    const { set, base, data, time, step, stage } = this.json.frames[number];
    const bodies = await this.set(set), all = await planesOf(data), count = bodies.radius.length;
    if (base !== number) {
      const from = await this.base(base);
      for (let i = 0; i < from.length; ++i) all[i] += from[i];
    }
    const { values: element } = this.json.frames[number], numbers = element === undefined ? null : await planesOf(element);
    const values = numbers && this.json.values.map((_, k) => numbers.subarray(count * k, count * (k + 1)));
    let next = 0;
    const list = () => all.subarray(count * next, count * ++next);
    const vector = (name) => (this.has(name) ? [list(), list(), list()] : null);
    return { number, time, step, stage, count, ...bodies, x: list(), y: list(), z: list(), speed: list(), rotation: vector("rotation"), displacement: vector("displacement"), values };
  }

  /** The contacts of a frame to show, or the links of its linear chains: {count, body, branch [m] of all x, y, z, force [N]}. */
  async chains(number, linear = false) {
    const frame = this.json.frames[number], { strongest } = frame, contacts = (linear ? frame.linear_contacts : frame.contacts) ?? 0;
    const all = contacts > 0 ? await planesOf(linear ? frame.linear_chains : frame.chains) : new Uint16Array();
    const part = (i) => all.subarray(contacts * i, contacts * (i + 1));
    const [low, high, bx, by, bz, force] = [0, 1, 2, 3, 4, 5].map(part);
    const metres = (list) => Float32Array.from(list, (q) => (q / 65535 * 2 - 1) * this.json.reach);
    return { count: contacts, body: Uint32Array.from(low, (l, i) => l + 65536 * high[i]), branch: [metres(bx), metres(by), metres(bz)],
      force: Float32Array.from(force, (q) => (q / 65535) * strongest) };
  }

  /** Triangles of the walls at a frame: corners of three numbers [m], and the values of a field of json.wall_fields, or null. */
  async walls(number, field = -1) {
    const placed = [], frame = this.json.frames[number];
    for (const [place, [wall, ...moved]] of frame.walls.entries()) {
      const { name, data } = this.json.walls[wall], [, , element] = frame.wall_fields?.find(([at, one]) => at === place && one === field) ?? [];
      if (!this.wallCorners.has(wall)) this.wallCorners.set(wall, inflated(data).then((buffer) => new Float32Array(buffer)));
      placed.push({ name, corners: Float32Array.from(await this.wallCorners.get(wall), (c, i) => c + moved[i % 3]),
        values: element === undefined ? null : new Float32Array(await inflated(element)) });
    }
    return placed;
  }

  /** Metres of a 16-bit position along an axis. */
  metres(axis, number) {
    const { low, high } = this.json;
    return low[axis] + (number / 65535) * (high[axis] - low[axis]);
  }
}

const framesKnown = new WeakMap();
/** Grains and maps share them. */
function framesOf(grains) {
  if (!framesKnown.has(grains)) framesKnown.set(grains, new GrainFrames(grains));
  return framesKnown.get(grains);
}
