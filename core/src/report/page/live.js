// A page served during a run: requests new data, and updates the page without moving it.
"use strict";

/**
 * Requests updates one after the other, in its own thread: the server keeps the last state only for a few seconds, and the page may take longer to draw.
 * Sends the merged updates whenever the page is ready; `silent`: the last request had no response.
 */
function askAhead(address, page, run, since) {
  let held = null, ready = false;
  const handOver = () => {
    if (!held || !ready) return;
    postMessage(held);
    held = null, ready = false;
  };
  const ask = async () => {
    try {
      const answer = await fetch(`${address}?since=${since}&page=${page}`);
      return answer.ok ? await answer.json() : null;
    } catch {
      return null;
    }
  };
  const together = (older, newer) => {
    const all = { ...older, ...newer, silent: false, elements: { ...older?.elements, ...newer.elements } };
    const used = new Set(all.used?.map(String));
    for (const number of Object.keys(all.elements)) if (!used.has(number)) delete all.elements[number];
    return all;
  };
  const follow = async () => {
    for (;;) {
      const news = await ask();
      since = news?.since ?? since;
      held = news ? together(held, news) : { ...held, silent: true };
      handOver();
      if (news && news.run !== run) return;
      if (!news) await new Promise((done) => setTimeout(done, 2000));
    }
  };
  onmessage = () => ((ready = true), handOver());
  follow();
}

class Follower {
  constructor() {
    const { since, run } = report.live;
    Object.assign(this, { run, used: this.inPage() });
    const page = Math.random().toString(36).slice(2), words = [new URL("new", location).href, page, run, since].map((word) => JSON.stringify(word));
    this.asker = new Worker(URL.createObjectURL(new Blob([`(${askAhead})(${words})`])));
    this.line = make("p", { className: "progress" });
    this.line.setAttribute("role", "status");
    document.getElementById("head").before(this.line);
  }
  inPage() {
    return new Set(Array.from(document.querySelectorAll("[id^=data-]"), (element) => element.id.slice(5)));
  }
  show(words) {
    this.line.textContent = words;
  }

  /** Until the server shows another run. */
  async follow() {
    for (;;) {
      const news = await this.news();
      if ((news.run ?? this.run) !== this.run) return location.reload();
      if (news.report) await this.take(news);
      this.ended = news.ended ?? this.ended;
      if (!news.silent) this.show(news.progress);
      else this.show(this.ended ? "The run has ended and this page is no longer updated; 'grit report' writes a permanent one." : "No response: the run has stopped or cannot be reached.");
    }
  }
  news() {
    return new Promise((done) => {
      this.asker.onmessage = ({ data }) => done(data);
      this.asker.postMessage("ready");
    });
  }

  async take({ head, report: now, elements, used }) {
    for (const [number, text] of Object.entries(elements))
      document.body.append(make("script", { type: "application/octet-stream", id: `data-${number}`, textContent: text }));
    // Data used so far may still be in use by a drawing.
    const needed = new Set([...this.used, ...used.map(String)]);
    for (const number of this.inPage()) if (!needed.has(number)) this.forget(number);
    this.used = new Set(used.map(String));
    Object.assign(report, now);
    this.showHead(head);
    await Promise.all([this.showCurves(document.getElementById("curves")), this.showFrames(document.getElementById("grains"), document.getElementById("maps"))]);
  }
  forget(number) {
    document.getElementById(`data-${number}`).remove();
    doubles.delete(+number);
  }

  showHead(html) {
    const place = document.getElementById("head"), folds = () => [...place.querySelectorAll("details")];
    const open = folds().map((fold) => fold.open);
    place.innerHTML = html;
    folds().forEach((fold, i) => (fold.open = open[i] ?? false));
    document.title = place.querySelector("h1").textContent;
  }
  async showCurves(section) {
    const parts = [...section.querySelectorAll("details.probe")], names = ({ ordered, zero }) => `${ordered.join()}|${zero.join()}`;
    const before = parts.map(({ charts }) => charts.name + names(charts)).join();
    for (const { charts } of parts) charts.read();
    const now = curveGroups().filter(({ ordered, zero }) => ordered.length + zero.length > 0);
    if (now.map((charts) => charts.name + names(charts)).join() === before)
      return Promise.all(Array.from(section.querySelectorAll("figure.chart"), ({ chart }) => chart.refresh()));
    const open = parts.filter((part) => part.open).map(({ charts }) => charts.name);
    section.replaceChildren();
    showCurves(section);
    if (open.length > 0) for (const part of section.querySelectorAll("details.probe")) part.open = open.includes(part.charts.name);
  }
  async showFrames(grains, maps) {
    const player = grains.querySelector("figure.grains")?.grains.player, runs = runsWithGrains();
    if (player && runs.length > 0) return player.refresh(runs);
    grains.replaceChildren(), maps.replaceChildren(); // a resumed run may have removed frames
    return showFrames(grains, maps);
  }
}

new Follower().follow();
