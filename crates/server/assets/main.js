// The page: the project tree, what is shown, and the keys.

import { Live, get, post, tell } from "./api.js";
import { close, open, parts } from "./detail.js";
import { button, byId, el } from "./dom.js";
import { fault } from "./fault.js";
import { help } from "./help.js";
import { ladder } from "./ladder.js";
import { Side, pair } from "./pair.js";
import { tape } from "./proof.js";
import { palette } from "./palette.js";
import { session } from "./session.js";
import { toolbar } from "./run.js";
import { controller, dataFile, forces, points, timers, watch } from "./tables.js";
import { trend } from "./trend.js";
import { shown, typed } from "./values.js";

/** Views by the name in the address bar. */
const VIEWS = {
  controller: ["Controller properties", controller],
  session: ["Run and recording", session],
  points: ["Inputs and outputs", points],
  timers: ["Timers and counters", timers],
  fault: ["Fault", fault],
  forces: ["Forces", forces],
  watch: ["Watch list", watch],
  trend: ["Trend", trend],
  pair: ["Side by side", pair],
};

/** Names of the groups of the tree, as the vendors' software has them. */
const GROUPS = {
  slc: { program: "Program Files", data: "Data Files", forces: "Force Files", watch: "Custom Data Monitors", trends: "Trends" },
  "do-more": { program: "Code-Blocks", data: "Memory", forces: "Forces", watch: "Data View", trends: "Trend View" },
};

const RESTARTED = "The controller was started again, with the data of the project. What was not saved is gone: values, forces, history, snapshots, recordings.";

class App {
  constructor(project, status, other) {
    this.project = project;
    /** What asks for this program. */
    this.api = "/api";
    /** The other one of two programs side by side. */
    this.other = other && new Side(this, other);
    this.readOnly = status.read_only;
    this.live = new Live();
    this.live.restarted = () => this.restarted();
    if (sessionStorage.getItem("rungs-restarted")) {
      sessionStorage.removeItem("rungs-restarted");
      tell(RESTARTED, "wrong");
    }
    this.key = `rungs-watch:${project.file}`;
    this.watched = this.#kept();
    this.stop = null;
    byId("title").textContent = other ? `${project.file} ⇄ ${other.file}` : project.file;
    byId("title").title = project.controller;
    this.tree();
    toolbar(this);
    byId("banners").after(tape(this));
    palette(this);
    help(this);
    addEventListener("hashchange", () => this.follow());
    document.addEventListener("keydown", (event) => this.pressed(event));
    byId("tree-button").addEventListener("click", () => this.drawer());
    byId("tree").addEventListener("click", (event) => event.target.closest("a") && this.drawer(false));
    this.follow();
  }

  /** The server was started again: with the same program the page goes on, with another one it begins anew. */
  async restarted() {
    const project = await get("/api/project").catch(() => null);
    if (JSON.stringify(project) === JSON.stringify(this.project)) {
      tell(RESTARTED, "wrong");
      return;
    }
    sessionStorage.setItem("rungs-restarted", "1");
    location.reload();
  }

  /** Installed forces by address. */
  get forces() {
    return new Map(this.live.status?.forces ?? []);
  }

  /** Views, program files and data files a person can go to: name, what it is, address. */
  get places() {
    const { routines, data_files: files } = this.project;
    return [
      ...Object.entries(VIEWS).filter(([key]) => key !== "pair" || this.other).map(([key, [name]]) => [name, "view", key]),
      ...routines.map((one) => [`${one.title} ${one.description}`.trim(), "program", `ladder/${one.number}`]),
      ...files.map((one) => [this.dataName(one), "data", `data/${encodeURIComponent(one.label)}`]),
    ];
  }

  dataName(file) {
    return file.title ? `${file.label} - ${file.title}` : file.label;
  }

  tree() {
    const names = GROUPS[this.project.dialect] ?? GROUPS.slc;
    const link = (hash, text, title) => el("li", {}, el("a", { href: `#${hash}`, title }, text));
    const views = (...keys) => keys.map((key) => link(key, VIEWS[key][0]));
    const group = (name, items) => el("details", { open: true }, el("summary", {}, name), el("ul", {}, items));
    byId("tree").replaceChildren(
      el("p", { class: "controller" }, this.project.controller),
      this.other ? group("Two programs", views("pair")) : "",
      group("Controller", views("controller", "session", "points", "timers", "fault")),
      group(names.program, this.project.routines.map((one) => link(`ladder/${one.number}`, one.title, `${one.description} ${one.rungs} rungs`.trim()))),
      group(names.data, this.project.data_files.map((one) => link(`data/${encodeURIComponent(one.label)}`, this.dataName(one)))),
      group(names.forces, views("forces")), group(names.watch, views("watch")), group(names.trends, views("trend")),
      ...this.project.notes.map((note) => el("p", { class: "note" }, note)));
  }

  /** Opens or closes the tree where there is no room for it beside the program. */
  drawer(wanted) {
    const on = document.body.classList.toggle("tree-open", wanted);
    byId("tree-button").setAttribute("aria-expanded", String(on));
    if (on) (byId("tree").querySelector("[aria-current]") ?? byId("tree").querySelector("a"))?.focus();
  }

  /** Shows what the address bar says, so that Back and bookmarks work. */
  follow() {
    const [view, ...rest] = location.hash.slice(1).split("/");
    const main = byId("view");
    let here = null;
    for (const one of byId("tree").querySelectorAll("a")) {
      const is = one.getAttribute("href") === `#${view}${["ladder", "data"].includes(view) && rest.length ? `/${rest[0]}` : ""}`;
      if (is) one.setAttribute("aria-current", "page");
      else one.removeAttribute("aria-current");
      if (is) here = one;
    }
    here?.scrollIntoView({ block: "nearest" });
    main.ariaLabel = here?.textContent ?? "Program";
    document.title = `${here ? `${here.textContent} – ` : ""}${this.project.file} – rungs`;
    main.dataset.view = view;
    if (view === "ladder") this.show(() => ladder(this, main, Number(rest[0]), rest[1] === undefined ? null : Number(rest[1])));
    else if (view === "data") this.show(() => dataFile(this, main, decodeURIComponent(rest[0] ?? "")));
    else if (VIEWS[view]) this.show(() => VIEWS[view][1](this, main));
    else if (this.other) location.replace("#pair");
    else if (this.project.routines.length) location.replace(`#ladder/${this.project.routines[0].number}`);
    else location.replace("#controller");
  }

  /** Shows a view; what the one before followed is followed no more. */
  async show(view) {
    const mine = (this.showing = Symbol("view"));
    // One that is still being made would take the place of the one after it.
    await this.making;
    if (this.showing !== mine) return;
    this.making = this.#make(view, mine);
    await this.making;
  }

  async #make(view, mine) {
    this.stop?.();
    this.stop = null;
    byId("view").scrollTop = 0;
    try {
      this.stop = await view();
    } catch (problem) {
      byId("view").replaceChildren(el("p", { class: "wrong" }, problem.message));
      return;
    }
    if (this.showing === mine) byId("view").dataset.shown = location.hash;
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
    const other = this.other && address.startsWith(this.other.prefix);
    return other ? this.other.open(address.slice(this.other.prefix.length)) : open(this, address);
  }

  /** Who uses an address, of two programs side by side of either one. */
  async uses(address) {
    const prefix = this.other && address.startsWith(this.other.prefix) ? this.other.prefix : "";
    const found = await get(`${prefix ? this.other.api : this.api}/uses?address=${encodeURIComponent(address.slice(prefix.length))}`);
    return { ...found, address: prefix + found.address };
  }

  /** The address of a symbol a person typed, or what was typed. */
  async address(text) {
    return (await this.uses(text.trim()).catch(() => null))?.address ?? text.trim();
  }

  /** The watch list of this program, as it was when the page was left. */
  #kept() {
    try {
      const kept = JSON.parse(localStorage.getItem(this.key) ?? "[]");
      return Array.isArray(kept) ? kept.filter((one) => typeof one === "string").slice(0, 500) : [];
    } catch {
      return [];
    }
  }

  #keep() {
    try {
      localStorage.setItem(this.key, JSON.stringify(this.watched));
    } catch { /* It holds until the page is left. */ }
  }

  /** Follows an address; a whole timer, counter or control element stands for all its members. */
  async watch(address) {
    const prefix = this.other && address.startsWith(this.other.prefix) ? this.other.prefix : "";
    const members = await parts(prefix ? this.other : this, address.slice(prefix.length));
    for (const one of members.length ? members.map((member) => prefix + member) : [address]) {
      if (!this.watched.includes(one)) this.watched.push(one);
    }
    this.#keep();
    tell(`${address} is in the watch list.`);
  }

  unwatch(address) {
    this.watched = this.watched.filter((one) => one !== address);
    this.#keep();
  }

  async trend(address) {
    const { traces } = await get("/api/trend");
    const addresses = [...new Set([...traces.map((one) => one.address), address])];
    if (await post("/api/trend", { addresses })) this.goView("trend");
  }

  /** Asks for a new value of an address. */
  edit(address) {
    if (this.readOnly) return;
    this.ask(`New value of ${address}`, shown(this.live.values.get(address)).replaceAll(" ", ""), (text) =>
      post("/api/write", { address, value: typed(text) }));
  }

  /** Asks for a text. */
  ask(question, text, then) {
    const dialog = byId("ask");
    const input = el("input", { type: "text", value: text, autocomplete: "off" });
    const form = el("form", { method: "dialog", on: { submit: () => then(input.value) } },
      el("label", {}, question, input),
      el("div", { class: "row" }, el("button", { type: "submit" }, "Write"), button("Cancel", "Change nothing", () => dialog.close())));
    dialog.replaceChildren(form);
    dialog.showModal();
    input.select();
  }

  pressed(event) {
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "k") {
      event.preventDefault();
      this.search();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    if (event.key === "Escape") {
      if (document.body.classList.contains("tree-open")) {
        this.drawer(false);
        byId("tree-button").focus();
      } else close(this);
      return;
    }
    if (event.target.closest("input, select, textarea, [role=menuitem]")) return;
    // What has the focus takes Space for itself.
    const own = event.key === " " && event.target.closest("button, a, summary, [role=button]");
    if (event.key === "?") this.help();
    if (this.readOnly || own) return;
    const does = { " ": () => this.toggleRun(), s: () => this.step(1), S: () => this.step(10), b: () => this.back(1), B: () => this.back(10) }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  }
}

const [project, status] = await Promise.all([get("/api/project"), get("/api/state")]);
new App(project, status, status.pair ? await get("/api/other/project") : null);
