// Views that are tables of values: the controller, data files, points, timers, forces, the watch list.

import { control, get, post, tell } from "./api.js";
import { WORDS, bits, heads, show } from "./bits.js";
import { button, byId, el } from "./dom.js";
import { actions, menu } from "./menu.js";
import { RADICES, shown } from "./values.js";

/** A cell that shows a value and can be edited. */
function cell(app, address, radix) {
  return el("button", {
    type: "button", class: "cell", title: `${address}: edit`, data: { address, radix: radix ?? "decimal" }, disabled: app.readOnly,
    on: { click: () => app.edit(address) },
  }, "…");
}

/** Keeps all cells below a node up to date; answers how to stop. */
function follow(app, node, part) {
  const cells = [...node.querySelectorAll("[data-address]")];
  app.live.see(part, { values: [...new Set(cells.map((one) => one.dataset.address))] });
  const stop = app.live.listen((_, live) => {
    for (const one of cells) {
      const now = live.values.get(one.dataset.address);
      if (one.dataset.bit !== undefined) {
        show(one, now);
        continue;
      }
      if (one.classList.contains("lamp")) {
        if (one.getAttribute("role") === "switch") one.setAttribute("aria-checked", String(Boolean(now)));
        else one.ariaLabel = `${one.dataset.name} is ${now === undefined ? "not known yet" : now ? "on" : "off"}`;
        one.classList.toggle("lit", Boolean(now));
        continue;
      }
      if (one.type === "range") {
        if (one !== document.activeElement && typeof now === "number") one.value = now;
        continue;
      }
      const text = shown(now, one.dataset.radix);
      if (one.textContent !== text) one.textContent = text;
    }
  });
  return () => {
    stop();
    app.live.see(part, null);
  };
}

const link = (app, address) => button(address, "Uses and value", () => app.open(address), { class: "link address" });

/** Elements of one page of a data file. */
const PAGE = 250;

/** A data file; words in the radix chosen, or bit by bit. */
export async function dataFile(app, view, label, from = 0, radix) {
  const file = app.project.data_files.find((one) => one.label.toLowerCase() === label.toLowerCase());
  if (!file) throw new Error(`There is no data file ${label}.`);
  const words = app.project.dialect === "slc" && /^[BNIOS]\d*$/.test(file.label);
  const chosen = radix ?? (words && /^[BIOS]/.test(file.label) ? "bits" : null);
  const size = chosen === "bits" ? WORDS : PAGE;
  const data = await get(`${app.api}/data/${encodeURIComponent(label)}?from=${from}&count=${size}`);
  const shownAs = chosen ?? data.radix;
  const grid = shownAs === "bits";
  const choose = el("select", { ariaLabel: "Radix", on: { change: () => app.show(() => dataFile(app, view, label, from, choose.value)) } },
    [...(words ? ["bits"] : []), ...RADICES].map((one) => el("option", { value: one, selected: one === shownAs }, one)));
  const page = (to, text) => button(text, text, () => app.show(() => dataFile(app, view, label, Math.max(0, to), shownAs)), { disabled: to <= -size || to >= file.elements });
  const rows = data.elements.map((element) => el("tr", {},
    el("th", { scope: "row" }, link(app, element.address)),
    grid ? bits(app, element.address) : data.columns.map((column) => el("td", {}, cell(app, element.address + column, column === "" ? shownAs : "decimal"))),
    el("td", { class: "symbol" }, element.symbol), el("td", { class: "description" }, element.description)));
  const columns = grid ? heads() : data.columns.map((column) => el("th", {}, column || "Value"));
  view.replaceChildren(
    el("h2", {}, app.dataName(file)),
    el("div", { class: "row" }, el("label", {}, "Radix ", choose),
      file.elements > size ? [page(from - size, "Previous"), page(from + size, "Next"), `${from} to ${Math.min(from + size, file.elements) - 1} of ${file.elements}`] : null),
    el("div", { class: "scroll", tabIndex: 0, role: "region", ariaLabel: app.dataName(file) }, el("table", { class: grid ? "bits" : "" },
      el("thead", {}, el("tr", {}, el("th", {}, "Address"), columns, el("th", {}, "Symbol"), el("th", {}, "Description"))),
      el("tbody", {}, rows))));
  return follow(app, view, "table");
}

/** What is known of the controller. */
export function controller(app, view) {
  const { properties, notes } = app.project;
  view.replaceChildren(el("h2", {}, "Controller properties"),
    el("dl", { class: "facts" }, properties.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)])),
    notes.length ? el("h3", {}, "What must be known of this simulation") : "", el("ul", {}, notes.map((note) => el("li", {}, note))));
}

/** Switches and lamps, sliders and numbers for every point the program uses. */
export function points(app, view) {
  const words = [];
  const item = (point) => {
    const { address, symbol, input, analog } = point;
    const force = el("strong", { class: "forced-word" });
    if (!analog) words.push([address, force]);
    const more = button("⋯", `What can be done with ${address}`, () =>
      menu(more, `${address} ${symbol}`.trim(), actions(app, { bit: analog ? null : address, forcible: !analog, values: analog ? [address] : [] })),
    { class: "more", ariaLabel: `What can be done with ${address}`, ariaHasPopup: "menu" });
    const name = el("span", { class: "name" }, link(app, address), el("span", { class: "symbol" }, symbol), el("span", { class: "description" }, point.description), force);
    if (analog) {
      const slider = el("input", { type: "range", min: 0, max: 32767, ariaLabel: `${address} ${symbol}`, data: { address }, on: {
        input: () => post("/api/write", { address, value: Number(slider.value) }) } });
      return el("li", {}, cell(app, address), name, input && !app.readOnly ? slider : null, more);
    }
    const lamp = input
      ? el("button", { type: "button", role: "switch", class: "lamp input", ariaLabel: `${address} ${symbol}`, data: { address }, disabled: app.readOnly,
        on: { click: () => post("/api/write", { address, value: lamp.getAttribute("aria-checked") !== "true" }) } })
      : el("span", { role: "img", class: "lamp output", data: { address, name: `${address} ${symbol}`.trim() } });
    return el("li", {}, lamp, name, more);
  };
  const list = (input) => {
    const all = app.project.points.filter((point) => point.input === input);
    return all.length ? el("ul", { class: "points" }, all.map(item)) : el("p", {}, "The program names none.");
  };
  const gauges = el("dl", { class: "gauges" });
  view.replaceChildren(el("h2", {}, "Inputs and outputs"),
    el("div", { class: "columns" }, el("section", {}, el("h3", {}, "Inputs"), list(true)), el("section", {}, el("h3", {}, "Outputs"), list(false))), gauges);
  const stop = follow(app, view, "table");
  const stopForces = app.live.listen((_, { status }) => {
    const { forces } = app;
    for (const [address, node] of words) {
      const state = forces.get(address);
      const text = state === undefined ? "" : `forced ${state ? "ON" : "OFF"}${status.forces_enabled ? "" : " (disabled)"}`;
      if (node.textContent !== text) node.textContent = text;
    }
    showGauges(gauges, status.plant);
  });
  return () => {
    stop();
    stopForces();
  };
}

/** The plant in figures. */
export function showGauges(list, plant) {
  const rows = (plant?.gauges ?? []).map(([element, quantity, value, unit]) => [`${element} ${quantity}`, `${Number(value.toFixed(2))} ${unit}`.trim()]);
  const now = JSON.stringify(rows);
  if (list.dataset.shown === now) return;
  list.dataset.shown = now;
  list.replaceChildren(...rows.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
}

/** Timers and counters with bars. */
export function timers(app, view) {
  const bars = [];
  const rows = app.project.timers.map((timer) => {
    const bar = el("meter", { min: 0, max: 1, value: 0, ariaLabel: `${timer.address} progress` });
    const seconds = el("span", { class: "seconds" });
    bars.push([timer, bar, seconds]);
    return el("tr", {}, el("th", { scope: "row" }, link(app, timer.address)), el("td", {}, timer.kind), el("td", { class: "symbol" }, timer.symbol, timer.symbol && timer.description ? el("br") : "", el("span", { class: "description" }, timer.description.replaceAll("\n", " "))),
      el("td", {}, cell(app, timer.accumulated)), el("td", {}, timer.preset ? cell(app, timer.preset) : "in the rung"), el("td", { class: "progress" }, bar, seconds), el("td", {}, cell(app, timer.done)));
  });
  view.replaceChildren(el("h2", {}, "Timers and counters"), el("div", { class: "scroll", tabIndex: 0, role: "region", ariaLabel: "Timers and counters" }, el("table", {},
    el("thead", {}, el("tr", {}, ["Address", "Kind", "Symbol and description", "Accum", "Preset", "Progress", "Done"].map((text) => el("th", {}, text)))),
    el("tbody", {}, rows))));
  const stop = follow(app, view, "table");
  const stopBars = app.live.listen((_, live) => {
    for (const [timer, bar, seconds] of bars) {
      const [now, preset] = [live.values.get(timer.accumulated), timer.preset ? live.values.get(timer.preset) : undefined];
      if (typeof now !== "number" || typeof preset !== "number") continue;
      bar.value = preset > 0 ? Math.max(0, Math.min(1, now / preset)) : 0;
      const text = timer.base ? `${(now * timer.base).toFixed(2)} of ${(preset * timer.base).toFixed(2)} s` : "";
      if (seconds.textContent !== text) seconds.textContent = text;
    }
  });
  return () => {
    stop();
    stopBars();
  };
}

/** All forces, and whether they act. */
export function forces(app, view) {
  const body = el("tbody");
  const enabled = el("button", { type: "button", on: { click: () => control({ do: "forces", enabled: !app.live.status.forces_enabled }) } });
  const address = el("input", { type: "text", ariaLabel: "Address to force", placeholder: "I:0.0/3", size: 12, autocomplete: "off" });
  const install = async (state) => {
    if (!address.value.trim()) tell("Enter the address of an input or output.", "wrong");
    else post("/api/force", { address: await app.address(address.value), state });
  };
  view.replaceChildren(el("h2", {}, "Forces"),
    app.readOnly ? null : el("div", { class: "row" }, enabled, button("Remove all", "Remove all forces", () => control({ do: "clear-forces" }))),
    app.readOnly ? null : el("div", { class: "row" }, address, button("Force on", "Force on", () => install(true)), button("Force off", "Force off", () => install(false))),
    el("table", {}, el("thead", {}, el("tr", {}, ["Address", "Symbol", "Forced to", "Value", "Action"].map((text) => el("th", {}, text)))), body));
  let last = null;
  let stopValues = null;
  const symbols = new Map(app.project.points.map((point) => [point.address, point.symbol]));
  const stop = app.live.listen((_, live) => {
    enabled.textContent = live.status.forces_enabled ? "Disable forces" : "Enable forces";
    const now = JSON.stringify(live.status.forces);
    if (now === last) return;
    last = now;
    stopValues?.();
    const rows = live.status.forces.map(([at, on]) => el("tr", {}, el("th", { scope: "row" }, link(app, at)), el("td", { class: "symbol" }, symbols.get(at) ?? ""), el("td", {}, on ? "ON" : "OFF"),
      el("td", {}, cell(app, at)),
      el("td", {}, app.readOnly ? null : button("Remove", `Remove the force of ${at}`, () => post("/api/force", { address: at, state: null })))));
    body.replaceChildren(...(rows.length ? rows : [el("tr", {}, el("td", { colSpan: 5 }, "No forces are installed."))]));
    stopValues = follow(app, body, "forces");
  });
  return () => {
    stop();
    stopValues?.();
  };
}

/** Addresses a person follows; they are kept in this browser. */
export async function watch(app, view) {
  const address = el("input", { type: "text", ariaLabel: "Address to watch", placeholder: "T4:0.ACC", size: 14, autocomplete: "off" });
  const again = () => app.show(() => watch(app, view));
  const known = (text) => app.uses(text);
  const form = el("form", { class: "row", on: { submit: async (event) => {
    event.preventDefault();
    const text = address.value.trim();
    if (!text) return;
    try {
      // Symbols are followed by their address.
      await app.watch((await known(text)).address);
      await again();
      byId("view").querySelector("form input")?.focus();
    } catch (problem) {
      tell(problem.message, "wrong");
    }
  } } }, address, el("button", { type: "submit" }, "Watch"));
  const about = await Promise.all(app.watched.map((one) => known(one).catch(() => ({ symbol: "", description: "not in this program" }))));
  const rows = app.watched.map((one, index) => el("tr", {}, el("th", { scope: "row" }, link(app, one)), el("td", { class: "symbol" }, about[index].symbol), el("td", {}, cell(app, one)),
    el("td", { class: "description" }, about[index].description),
    el("td", {}, button("Remove", `Remove ${one}`, () => {
      app.unwatch(one);
      again();
    }))));
  view.replaceChildren(el("h2", {}, "Watch list"), form,
    el("div", { class: "scroll", tabIndex: 0, role: "region", ariaLabel: "Watch list" }, el("table", {},
      el("thead", {}, el("tr", {}, ["Address", "Symbol", "Value", "Description", "Action"].map((text) => el("th", {}, text)))),
      el("tbody", {}, rows.length ? rows : el("tr", {}, el("td", { colSpan: 5 }, "Nothing is watched yet."))))));
  return follow(app, view, "table");
}
