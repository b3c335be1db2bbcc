// Two programs side by side: both ladders, what belongs together, where they differ.

import { control, get, post } from "./api.js";
import { open } from "./detail.js";
import { button, el, time } from "./dom.js";
import { Pane, level } from "./pane.js";
import { search, toDifference } from "./proof.js";
import { shown, typed } from "./values.js";

/** Rows of the table at once. */
const ROWS = 200;

/** The live connection as the other program's ladder knows it. */
class OtherLive {
  constructor(live, prefix) {
    this.live = live;
    this.prefix = prefix;
    this.rungs = { get: (rung) => live.otherRungs.get(rung) };
    this.values = { get: (address) => live.values.get(prefix + address) };
  }

  get status() {
    return this.live.status;
  }

  see(part, shows) {
    // There is one panel for addresses of both.
    const name = part === "detail" ? part : `other ${part}`;
    this.live.see(name, shows && { otherRungs: shows.rungs, values: (shows.values ?? []).map((address) => this.prefix + address) });
  }

  listen(listener) {
    return this.live.listen((news) => {
      const values = Object.fromEntries(Object.entries(news.values ?? {}).filter(([address]) => address.startsWith(this.prefix)));
      listener({ status: { ...news.status, forces: news.status.pair.forces }, rungs: news.other_rungs ?? {}, values }, this);
    });
  }
}

/** One of the two programs, as views know the page. Without a project of its own it is the original. */
export class Side {
  constructor(app, project = null) {
    this.app = app;
    this.other = project !== null;
    this.project = project ?? app.project;
    this.prefix = this.other ? "other:" : "";
    this.api = this.other ? "/api/other" : "/api";
    this.pane = null;
    this.made = null;
  }

  get readOnly() {
    return this.app.readOnly;
  }

  get live() {
    this.made ??= this.other ? new OtherLive(this.app.live, this.prefix) : this.app.live;
    return this.made;
  }

  get forces() {
    return this.other ? new Map(this.app.live.status?.pair.forces ?? []) : this.app.forces;
  }

  open(address) {
    return open(this, address);
  }

  watch(address) {
    this.app.watch(this.prefix + address);
  }

  trend(address) {
    return this.app.trend(this.prefix + address);
  }

  edit(address) {
    if (this.readOnly) return;
    this.app.ask(`New value of ${address}, in both programs`, shown(this.live.values.get(address)).replaceAll(" ", ""), (text) =>
      post(`${this.api}/write`, { address, value: typed(text) }));
  }

  routineName(number) {
    return this.project.routines.find((one) => one.number === number)?.title ?? `file ${number}`;
  }

  show(view) {
    return this.pane?.show(view);
  }

  goto(routine, rung) {
    if (this.pane) this.pane.go(routine, rung);
    else location.hash = `pair/${this.other ? "other" : "original"}/${routine}/${rung}`;
  }
}

/** All rows, asked for in parts. */
async function allRows(count) {
  const rows = [];
  while (rows.length < count) {
    const part = await get(`/api/pair/rows?from=${rows.length}`);
    if (!part.length) break;
    rows.push(...part);
  }
  return rows;
}

/** Places that belong together, from either side. */
function linked(rungs) {
  const [from, to] = [new Map(), new Map()];
  const add = (map, [routine, rung], place) => map.set(`${routine}:${rung}`, [...(map.get(`${routine}:${rung}`) ?? []), place]);
  for (const [a, b, c, d] of rungs) {
    add(from, [a, b], [c, d]);
    add(to, [c, d], [a, b]);
  }
  return [from, to];
}

/** The view. */
export async function pair(app, view) {
  const found = await get("/api/pair");
  const rows = await allRows(found.rows);
  const converted = app.other.project.dialect === "do-more";
  const [from, to] = linked(found.rungs);
  const mine = new Side(app);
  // As the drawings number rungs: Do-more counts from 1.
  const short = (side, arrow) => (routine, rung) => (side.project.dialect === "do-more"
    ? `${arrow} ${side.routineName(routine).split(" ").at(-1)} rung ${rung + 1}`
    : `${arrow} ${routine}:${rung}`);
  const a = new Pane(mine, "Original", from, { name: short(app.other, "→"), lonely: "has no counterpart", original: true });
  const b = new Pane(app.other, converted ? "Converted" : "Other version", to, { name: short(mine, "←"), lonely: converted ? "added by the conversion" : "has no counterpart" });
  const unlevel = level(a, b);
  for (const [one, other] of [[a, b], [b, a]]) {
    one.chosen = async ([, rung], place) => {
      if (!place) {
        other.reveal(-1);
        one.reveal(rung, true);
        return;
      }
      if (other.routine !== place[0]) await other.go(place[0]);
      other.reveal(place[1]);
      one.reveal(rung, true);
    };
    one.turned = async (routine) => {
      const places = [...one.links].filter(([key]) => key.startsWith(`${routine}:`)).flatMap(([, all]) => all);
      if (places.length && !places.some(([of]) => of === other.routine)) await other.go(places[0][0], places[0][1]);
    };
  }
  const [searching, stopSearch] = search(app);
  const [table, stopTable] = values(app, rows);
  const [told, stopTold] = differences(app, a, rows);
  const doubts = [...found.incomparable, ...found.unmapped.map(([address, why]) => `${address}: ${why}`)];
  view.replaceChildren(el("h2", { class: "visually-hidden" }, "Side by side"), told,
    doubts.length ? el("details", { class: "doubts" }, el("summary", {}, `${doubts.length} ${doubts.length === 1 ? "thing" : "things"} cannot be compared: no difference would show there`), el("ul", {}, doubts.map((one) => el("li", {}, one)))) : "",
    el("div", { class: "panes" }, a.node, b.node), searching, table);
  const [side, routine, rung] = location.hash.slice(1).split("/").slice(1);
  const first = app.project.routines.find((one) => one.rungs > 1) ?? app.project.routines[0];
  await a.go(side === "original" && routine ? Number(routine) : first?.number, side === "original" && rung ? Number(rung) : null, true);
  if (side === "other" && routine) await b.go(Number(routine), Number(rung ?? 0), true);
  if (b.routine === null) await b.go(app.other.project.routines[0]?.number);
  // What a conversion adds stands before the first rung that was converted.
  const start = rung === undefined && (from.get(`${a.routine}:0`) ?? [])[0];
  if (start) a.chosen([a.routine, 0], start);
  return () => {
    for (const end of [stopSearch, stopTable, stopTold, unlevel]) end();
    a.close();
    b.close();
  };
}

/** What differs, since when, and what is done about it. */
function differences(app, pane, rows) {
  const compared = rows.filter((row) => row.compared).length;
  const among = compared === rows.length ? "" : ` among the ${compared} of ${rows.length} values that are compared`;
  const text = el("p", { id: "difference", class: "difference" });
  const stops = el("input", { type: "checkbox", id: "stop-at-difference", disabled: app.readOnly, on: { change: () => control({ do: "stop-at-difference", on: stops.checked }) } });
  const writer = async () => {
    const address = app.live.status.pair.first?.addresses?.[0];
    if (!address) return;
    const { uses } = await get(`/api/uses?address=${encodeURIComponent(address)}`);
    const use = uses.find((one) => one.access.includes("write"));
    if (use) {
      await pane.go(use.routine, use.rung, true);
      pane.chosen([use.routine, use.rung], pane.links.get(`${use.routine}:${use.rung}`)?.[0] ?? null);
    }
  };
  const there = button("Go to that scan", "Back to the scan in which the first difference arose", () => toDifference(app), { id: "to-difference", hidden: true });
  const rung = button("Show the rung", "The rung of the original that writes it, and its counterpart", writer, { id: "difference-rung", hidden: true });
  const node = el("section", { class: "row told", ariaLabel: "Differences" }, text, there, rung, el("label", {}, stops, " Stop at a difference"));
  const stop = app.live.listen(({ status: { pair: now, scans, mode, fault } }) => {
    const first = now.first;
    const parts = [];
    if (first) parts.push(`≠ First difference in scan ${first.scan} (${time(first.time)}): ${first.what}.`);
    else parts.push(scans ? `No difference in the ${scans} ${scans === 1 ? "scan" : "scans"} so far${among}.` : "Nothing has been scanned yet.");
    if (now.differences) parts.push(`${now.differences} ${now.differences === 1 ? "value differs" : "values differ"} now.`);
    else if (first) parts.push(scans < first.scan ? "" : "No value differs now.");
    if (now.left_conditions) parts.push("The original stopped where a stated condition of the conversion is not kept: what follows is no difference.");
    if (now.mode !== mode) parts.push(`The other program is in ${now.mode} mode.`);
    if (now.fault && now.fault !== fault) parts.push(`The other program: ${now.fault}.`);
    const said = parts.filter(Boolean).join(" ");
    if (text.textContent !== said) text.textContent = said;
    text.classList.toggle("differs", Boolean(first));
    there.hidden = app.readOnly || !first || scans <= first.scan;
    rung.hidden = !first?.addresses;
    stops.checked = now.stop_at_difference;
  });
  return [node, stop];
}

/** Mapped addresses with both values; those that differ stand first. */
function values(app, rows) {
  const filter = el("input", { type: "search", size: 16, placeholder: "address or symbol", autocomplete: "off" });
  const only = el("input", { type: "checkbox", id: "only-differences" });
  const body = el("tbody");
  const more = el("p", { class: "description" });
  let cells = new Map();
  let differing = new Set();
  let order = "";

  const change = (row) => {
    const [now] = app.live.rows.get(row.row) ?? [];
    if (row.kind === "bit") post("/api/write", { address: row.original, value: !now });
    else app.ask(`New value of ${row.original} and ${row.other}`, shown(now).replaceAll(" ", ""), (text) => post("/api/write", { address: row.original, value: typed(text) }));
  };
  const link = (address, text = address) => button(text, "Uses and value", () => app.open(address), { class: "link address" });
  const cell = (row) => button("…", `${row.original} and ${row.other}: change in both`, () => change(row), { class: "cell", disabled: app.readOnly });

  function lay() {
    const wanted = filter.value.trim().toLowerCase();
    const fits = (row) => (!only.checked || differing.has(row.row))
      && (!wanted || [row.original, row.other, row.symbol, row.description].some((text) => text.toLowerCase().includes(wanted)));
    const all = rows.filter(fits);
    const sorted = [...all.filter((row) => differing.has(row.row)), ...all.filter((row) => !differing.has(row.row))];
    const list = sorted.slice(0, ROWS);
    const now = list.map((row) => row.row).join(" ");
    if (now === order) return;
    order = now;
    cells = new Map();
    body.replaceChildren(...list.map((row) => {
      const parts = [cell(row), el("output", { class: "cell" }, "…"), el("td", { class: "mark" })];
      const line = el("tr", {}, parts[2], el("th", { scope: "row" }, link(row.original)), el("td", {}, parts[0]),
        el("td", {}, link(app.other.prefix + row.other, row.other)), el("td", {}, parts[1]), el("td", {}, el("span", { class: "symbol" }, row.symbol), " ", el("span", { class: "description" }, row.description)));
      cells.set(row.row, [row, line, ...parts]);
      return line;
    }));
    more.textContent = sorted.length > list.length ? `${sorted.length - list.length} more; filter for them.` : list.length ? "" : only.checked ? "No value differs now." : "Nothing fits.";
    app.live.see("rows", { rows: list.map((row) => row.row) });
  }

  filter.addEventListener("input", lay);
  only.addEventListener("change", lay);
  lay();
  const stop = app.live.listen(({ status }, live) => {
    const now = new Set(status.pair.differing);
    if (now.size !== differing.size || [...now].some((row) => !differing.has(row))) {
      differing = now;
      lay();
    }
    for (const [number, [row, line, own, other, mark]] of cells) {
      const [x, y] = live.rows.get(number) ?? [];
      const [left, right] = [shown(x), shown(y)];
      if (own.textContent !== left) own.textContent = left;
      if (other.textContent !== right) other.textContent = right;
      const differs = differing.has(number);
      const sign = differs ? "≠" : row.compared ? "=" : "–";
      if (mark.textContent !== sign) {
        mark.textContent = sign;
        mark.title = differs ? "They differ" : row.compared ? "Equal, and compared after every scan" : "Not compared";
        line.classList.toggle("differs", differs);
      }
    }
  });
  const node = el("section", { class: "pair-values" }, el("h3", {}, "Values of both"),
    el("div", { class: "row" }, el("label", {}, "Filter ", filter), el("label", {}, only, " Only differences")),
    el("div", { class: "scroll" }, el("table", {},
      el("thead", {}, el("tr", {}, ["", "Original", "Value", "Other program", "Value", "Symbol"].map((text) => el("th", {}, text || el("span", { class: "visually-hidden" }, "Same"))))), body)), more);
  return [node, () => {
    stop();
    app.live.see("rows", null);
  }];
}
