// The ladders of two programs beside each other: rungs that belong together are level, and lead to each other.

import { button, el } from "./dom.js";
import { ladder } from "./ladder.js";

/** One program in its pane. `names` says what a rung of the other program is called. */
export class Pane {
  #stop = null;
  #showing = null;
  /** Sections of rungs and the labels above them, by rung. */
  sections = [];
  labels = [];

  constructor(side, title, links, beyond) {
    this.side = side;
    /** Per `routine:rung` the places that belong to it in the other program. */
    this.links = links;
    this.beyond = beyond;
    this.title = title;
    this.body = el("div", { class: "pane-body", tabIndex: 0, role: "region", ariaLabel: `Ladder of ${side.project.file}` });
    this.choose = el("select", { ariaLabel: `Routine of ${side.project.file}`, on: { change: () => this.go(Number(this.choose.value), null, true) } },
      side.project.routines.map((one) => el("option", { value: one.number }, one.title)));
    this.node = el("section", { class: "pane" },
      el("div", { class: "pane-head" }, el("h3", {}, title), el("span", { class: "pane-file" }, side.project.file), this.choose), this.body);
    this.routine = null;
    /** The rung that shall stay in sight while others are drawn. */
    this.wanted = null;
    /** Heights of labels and rungs, as the browser tells them: asking for all of them would lay out the page each time. */
    this.heights = new Map();
    this.resized = new ResizeObserver((entries) => {
      for (const { target, borderBoxSize } of entries) this.heights.set(target, borderBoxSize[0].blockSize);
      this.changed();
    });
    // What this program shows, the page shows in this pane.
    side.pane = this;
  }

  /** Called when this program decides what is seen of both. */
  leads() {}

  /** Called when rungs were drawn and may be of another height. */
  changed() {}

  /** Called when a rung is chosen: its place, and the place of what belongs to it. */
  chosen() {}

  /** Called when another routine is shown because a person chose it. */
  turned() {}

  /** Shows a rung, or the beginning of a routine. */
  async go(routine, rung = null, byHand = false) {
    if (routine !== this.routine) {
      this.wanted = null;
      await this.show(() => ladder(this.side, this.body, routine, null, false), routine);
    }
    if (rung !== null) this.reveal(rung);
    if (byHand) this.turned(routine);
  }

  /** Shows what draws rungs into the pane; it is drawn again when the width changes. */
  async show(view, routine = this.routine) {
    this.#stop?.();
    this.#stop = null;
    this.resized.disconnect();
    this.heights.clear();
    this.sections = [];
    const mine = (this.#showing = Symbol("view"));
    this.routine = routine;
    this.choose.value = String(routine);
    const stop = await view();
    if (this.#showing !== mine) {
      stop?.();
      return;
    }
    this.#stop = stop;
    this.#label();
  }

  #label() {
    const { side, title } = this;
    const rungs = [...this.body.querySelectorAll(":scope > .rung-place")];
    this.sections = rungs;
    this.labels = rungs.map((section, index) => {
      const to = this.links.get(`${this.routine}:${index}`) ?? [];
      const last = index === rungs.length - 1;
      const lead = to.map(([routine, rung]) => button(this.beyond.name(routine, rung), "Show it in the other program", () => this.chosen([this.routine, index], [routine, rung]), { class: "link" }));
      section.ariaLabel = `${title}, rung ${index + (side.project.dialect === "do-more" ? 1 : 0)}`;
      const label = el("div", { class: "pair-label" }, lead.length || (last && this.beyond.original) ? lead : this.beyond.lonely);
      section.before(label);
      section.addEventListener("click", () => this.chosen([this.routine, index], to[0] ?? null));
      this.resized.observe(section);
      this.resized.observe(label);
      return label;
    });
    rungs[this.wanted]?.classList.add("goal");
    this.changed();
  }

  /** Marks a rung as the one looked at and brings it into sight; `quietly`: scrolls only where it is out of sight. */
  reveal(rung, quietly = false) {
    const section = this.sections[rung];
    this.body.querySelectorAll(".goal").forEach((one) => one.classList.remove("goal"));
    if (!section) return;
    section.classList.add("goal");
    this.wanted = rung;
    this.leads();
    this.reach(quietly);
  }

  /** Scrolls to the rung that is wanted. */
  reach(quietly = false) {
    const [section, rung] = [this.sections[this.wanted], this.wanted];
    if (!section) return;
    const label = this.labels[rung] ?? section;
    const top = label.getBoundingClientRect().top - this.body.getBoundingClientRect().top + this.body.scrollTop;
    const inside = top >= this.body.scrollTop && top + section.offsetHeight <= this.body.scrollTop + this.body.clientHeight;
    if (!quietly || !inside) this.body.scrollTop = Math.max(0, top - 8);
  }

  close() {
    this.#stop?.();
    this.#showing = null;
    this.resized.disconnect();
    if (this.side.pane === this) this.side.pane = null;
  }
}

/** Makes rungs that belong together level by room above them, and lets both scroll as one while they are. */
export function level(a, b) {
  let queued = false;
  let leads = null;
  let together = false;

  const lay = () => {
    queued = false;
    const [left, right] = [a.node.getBoundingClientRect(), b.node.getBoundingClientRect()];
    const beside = Math.abs(left.top - right.top) < 2 && left.width > 0 && right.width > 0;
    const heights = (pane) => pane.sections.map((rung, index) => (pane.heights.get(pane.labels[index]) ?? 0) + (pane.heights.get(rung) ?? 0));
    const [x, y] = [heights(a), heights(b)];
    const room = [new Map(), new Map()];
    const at = [[0, 0], [0, 0]];
    together = false;
    /** The top of a rung, with the room given above it and all before. */
    const top = (side, sizes, rung) => {
      const place = at[side];
      for (; place[0] < rung; place[0] += 1) place[1] += sizes[place[0]];
      return place[1];
    };
    if (beside) {
      let next = 0;
      for (let rung = 0; rung < x.length; rung += 1) {
        const to = (a.links.get(`${a.routine}:${rung}`) ?? []).find(([routine, at]) => routine === b.routine && at >= next);
        // A rung that moved upwards cannot be level with its own without tearing the others apart.
        if (!to || to[1] >= y.length) continue;
        next = to[1] + 1;
        together = true;
        const lack = top(0, x, rung) - top(1, y, to[1]);
        if (lack > 0) room[1].set(to[1], lack);
        else if (lack < 0) room[0].set(rung, -lack);
        at[lack > 0 ? 1 : 0][1] += Math.abs(lack);
      }
    }
    const ends = [top(0, x, x.length), top(1, y, y.length)];
    [a, b].forEach((pane, side) => {
      pane.labels.forEach((label, rung) => {
        const margin = room[side].has(rung) ? `${room[side].get(rung)}px` : "";
        if (label.style.marginTop !== margin) label.style.marginTop = margin;
      });
      pane.body.style.setProperty("--rest", together ? `${Math.max(...ends) - ends[side]}px` : "0px");
    });
    // What was given room above the rungs looked at, or lost it, moved them.
    a.reach(true);
    b.reach(true);
    follow();
  };
  const follow = () => {
    const other = leads === a ? b : a;
    if (together && leads && other.body.scrollTop !== leads.body.scrollTop) other.body.scrollTop = leads.body.scrollTop;
  };
  const queue = () => {
    if (!queued) requestAnimationFrame(lay);
    queued = true;
  };
  const offs = [];
  for (const one of [a, b]) {
    one.changed = queue;
    one.leads = () => (leads = one);
    for (const name of ["pointerdown", "wheel", "touchmove", "keydown"]) {
      one.node.addEventListener(name, () => {
        // A person scrolls: nothing else decides any more what is seen.
        leads = one;
        a.wanted = null;
        b.wanted = null;
      }, { passive: true });
    }
    one.body.addEventListener("scroll", () => leads === one && follow(), { passive: true });
  }
  addEventListener("resize", queue);
  offs.push(() => removeEventListener("resize", queue));
  return () => offs.forEach((off) => off());
}
