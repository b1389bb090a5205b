// Time: the frame and run to show, set by synchronised sliders.
"use strict";

class Player {
  /** Viewers need takeRun(run), turn(number) and refresh(runs). */
  constructor(runs) {
    this.read(runs);
    this.viewers = [];
    this.strips = [];
  }
  read(runs) {
    this.runs = runs.map((run) => run.grains.frames);
  }
  /** Frames of the run shown: [{time [s], step, stage}]. */
  get frames() {
    return this.runs[this.run];
  }
  get count() {
    return this.frames.length;
  }

  /** A button, a slider and a clock. */
  strip() {
    const play = make("button", { type: "button", className: "play", title: "Play (space)", onclick: () => this.toggle() }, "▶");
    const slider = make("input", { type: "range", name: "frame", min: 0, value: 0, oninput: () => (this.stop(), this.go(+slider.value)) });
    slider.setAttribute("aria-label", "frame");
    play.setAttribute("aria-label", "play");
    const clock = make("output", { className: "clock" });
    this.strips.push({ play, slider, clock });
    return make("div", { className: "player" }, play, slider, clock);
  }
  /** Actions of keys. */
  keys() {
    return { " ": () => this.toggle(), ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1), Home: () => this.step(-Infinity), End: () => this.step(Infinity) };
  }

  /** Shows the last frame of a run. */
  takeRun(run) {
    this.stop();
    this.run = run;
    for (const viewer of this.viewers) viewer.takeRun(run);
    return this.takeFrames(this.count - 1);
  }
  /** Takes more frames of the same runs: follows the last one, and stays at any other. */
  refresh(runs) {
    const last = this.number === this.count - 1, { step } = this.frames[this.number];
    this.read(runs);
    for (const viewer of this.viewers) viewer.refresh(runs);
    return this.takeFrames(last ? this.count - 1 : Math.max(0, this.frames.findLastIndex((frame) => frame.step <= step)));
  }
  takeFrames(shown) {
    for (const { play, slider } of this.strips) {
      slider.max = this.count - 1;
      play.disabled = slider.disabled = this.count < 2;
    }
    this.number = -1;
    return this.go(shown);
  }
  async go(number) {
    if (number === this.number) return;
    this.number = number;
    const { time, stage } = this.frames[number];
    for (const { slider, clock } of this.strips) {
      slider.value = number;
      clock.textContent = `${writtenTime(time)} · ${stage} · ${number + 1}/${this.count}`;
      slider.setAttribute("aria-valuetext", clock.textContent);
    }
    await Promise.all(this.viewers.map((viewer) => viewer.turn(number)));
  }
  step(by) {
    this.stop();
    return this.go(Math.min(this.count - 1, Math.max(0, this.number + by)));
  }
  toggle() {
    return this.playing ? this.stop() : this.start();
  }
  stop() {
    this.playing = null;
    for (const { play } of this.strips) play.textContent = "▶";
  }
  async start() {
    if (this.count < 2) return;
    const playing = (this.playing = {}); // replaced if it is stopped and started meanwhile
    for (const { play } of this.strips) play.textContent = "❚❚";
    if (this.number === this.count - 1) await this.go(0);
    const pace = Math.min(200, Math.max(40, 6000 / this.count)); // ms: playing a run takes some seconds
    while (this.playing === playing && this.number < this.count - 1) {
      const next = performance.now() + pace;
      await this.go(this.number + 1);
      await new Promise((done) => setTimeout(done, Math.max(0, next - performance.now())));
    }
    if (this.playing === playing) this.stop();
  }
}
