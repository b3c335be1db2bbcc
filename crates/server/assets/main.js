// The page: the project tree, what is shown, and the keys.

import { Live, get, post } from "./api.js";
import { close, open } from "./detail.js";
import { button, byId, el } from "./dom.js";
import { ladder } from "./ladder.js";
import { palette } from "./palette.js";
import { toolbar } from "./run.js";
import { dataFile, forces, points, timers, watch } from "./tables.js";
import { trend } from "./trend.js";

const VIEWS = { points, timers, forces, watch, trend };
const NAMES = { points: "Inputs and outputs", timers: "Timers and counters", forces: "Forces", watch: "Watch list", trend: "Trend" };

class App {
  constructor(project, status) {
    this.project = project;
    this.readOnly = status.read_only;
    this.live = new Live();
    this.watched = [];
    this.stop = null;
    document.title = `${project.file} – rungs`;
    byId("title").textContent = project.file;
    byId("title").title = project.controller;
    this.tree();
    toolbar(this);
    palette(this);
    for (const note of project.notes) byId("tree").append(el("p", { class: "note" }, note));
    addEventListener("hashchange", () => this.follow());
    document.addEventListener("keydown", (event) => this.key(event));
    this.follow();
  }

  /** Installed forces by address. */
  get forces() {
    return new Map(this.live.status?.forces ?? []);
  }

  tree() {
    const link = (hash, text, title) => el("li", {}, el("a", { href: `#${hash}`, title }, text));
    const group = (name, items, open) => el("details", { open }, el("summary", {}, name), el("ul", {}, items));
    byId("tree").replaceChildren(
      el("p", { class: "controller" }, this.project.controller),
      group("Program", this.project.routines.map((one) => link(`ladder/${one.number}`, one.title, `${one.description} ${one.rungs} rungs`.trim())), true),
      group("Simulation", Object.entries(NAMES).map(([key, name]) => link(key, name)), true),
      group("Data", this.project.data_files.map((one) => link(`data/${encodeURIComponent(one.label)}`, `${one.label} ${one.title}`)), false));
  }

  /** Shows what the address bar says, so that Back and bookmarks work. */
  follow() {
    const [view, ...rest] = location.hash.slice(1).split("/");
    const main = byId("view");
    for (const one of byId("tree").querySelectorAll("a")) {
      const here = one.getAttribute("href") === `#${view}${["ladder", "data"].includes(view) && rest.length ? `/${rest[0]}` : ""}`;
      if (here) one.setAttribute("aria-current", "page");
      else one.removeAttribute("aria-current");
    }
    if (view === "ladder") this.show(() => ladder(this, main, Number(rest[0]), rest[1] === undefined ? null : Number(rest[1])), location.hash);
    else if (view === "data") this.show(() => dataFile(this, main, decodeURIComponent(rest[0] ?? "")), location.hash);
    else if (VIEWS[view]) this.show(() => VIEWS[view](this, main), location.hash);
    else if (this.project.routines.length) location.replace(`#ladder/${this.project.routines[0].number}`);
  }

  /** Shows a view; what the one before followed is followed no more. */
  async show(view) {
    this.stop?.();
    this.stop = null;
    const mine = (this.showing = Symbol("view"));
    byId("view").scrollTop = 0;
    let stop;
    try {
      stop = await view();
    } catch (problem) {
      byId("view").replaceChildren(el("p", { class: "wrong" }, problem.message));
      return;
    }
    if (this.showing === mine) this.stop = stop;
    else stop?.();
  }

  goView(name) {
    location.hash = name;
  }

  goto(routine, rung) {
    const hash = `#ladder/${routine}/${rung}`;
    if (location.hash === hash) this.follow();
    else location.hash = hash;
  }

  routineName(number) {
    return this.project.routines.find((one) => one.number === number)?.title ?? `file ${number}`;
  }

  open(address) {
    return open(this, address);
  }

  watch(address) {
    if (!this.watched.includes(address)) this.watched.push(address);
  }

  unwatch(address) {
    this.watched = this.watched.filter((one) => one !== address);
  }

  async trend(address) {
    const { traces } = await get("/api/trend");
    await post("/api/trend", { addresses: [...new Set([...traces.map((one) => one.address), address])] });
    this.goView("trend");
  }

  /** Asks for a text. */
  ask(question, text, then) {
    const dialog = byId("ask");
    const input = el("input", { type: "text", value: text, ariaLabel: question, autocomplete: "off" });
    const form = el("form", { method: "dialog", on: { submit: () => then(input.value) } },
      el("label", {}, question, input),
      el("div", { class: "row" }, el("button", { type: "submit" }, "Write"), button("Cancel", "Change nothing", () => dialog.close())));
    dialog.replaceChildren(form);
    dialog.showModal();
    input.select();
  }

  key(event) {
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "k") {
      event.preventDefault();
      this.search();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    if (event.key === "Escape") close(this.live);
    if (this.readOnly || event.target.closest("input, select, textarea, button, a, summary, [role=button]")) return;
    const does = { " ": () => this.toggleRun(), s: () => this.step(1), S: () => this.step(10), b: () => this.back(1), B: () => this.back(10) }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  }
}

const [project, status] = await Promise.all([get("/api/project"), get("/api/state")]);
new App(project, status);
