// Views that are tables of values: data files, points, timers, forces, the watch list.

import { get, post, control, tell } from "./api.js";
import { button, el } from "./dom.js";
import { shown, typed } from "./values.js";

/** Asks for a value in a dialog and writes it. */
function edit(app, address) {
  if (app.readOnly) return;
  app.ask(`New value of ${address}`, shown(app.live.values.get(address)).replaceAll(" ", ""), (text) =>
    post("/api/write", { address, value: typed(text) }));
}

/** A cell that shows a value and can be edited. */
function cell(app, address, radix) {
  return el("button", {
    type: "button", class: "cell", title: `${address}: edit`, data: { address, radix: radix ?? "decimal" },
    on: { click: () => edit(app, address) },
  }, "…");
}

/** Keeps all cells below a node up to date; answers how to stop. */
function follow(app, node, part) {
  const cells = [...node.querySelectorAll("[data-address]")];
  app.live.see(part, { values: cells.map((one) => one.dataset.address) });
  const stop = app.live.listen((_, live) => {
    for (const one of cells) {
      const now = live.values.get(one.dataset.address);
      if (one.classList.contains("lamp")) {
        one.setAttribute("aria-checked", String(Boolean(now)));
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

/** A data file; words in the radix chosen. */
export async function dataFile(app, view, label, from = 0, radix) {
  const data = await get(`/api/data/${encodeURIComponent(label)}?from=${from}&count=${PAGE}`);
  const file = app.project.data_files.find((one) => one.label === data.label);
  const chosen = radix ?? data.radix;
  const choose = el("select", { ariaLabel: "Radix", on: { change: () => app.show(() => dataFile(app, view, label, from, choose.value)) } },
    ["decimal", "binary", "hex"].map((one) => el("option", { value: one, selected: one === chosen }, one)));
  const page = (to, text) => button(text, text, () => app.show(() => dataFile(app, view, label, to, chosen)), { disabled: to < 0 || to >= file.elements });
  const rows = data.elements.map((element) => el("tr", {},
    el("th", { scope: "row" }, link(app, element.address)),
    data.columns.map((column) => el("td", {}, cell(app, element.address + column, column === "" ? chosen : "decimal"))),
    el("td", { class: "symbol" }, element.symbol), el("td", { class: "description" }, element.description)));
  view.replaceChildren(
    el("h2", {}, `${data.label} ${file.title}`),
    el("div", { class: "row" }, el("label", {}, "Radix ", choose),
      file.elements > PAGE ? [page(from - PAGE, "Previous"), page(from + PAGE, "Next"), `${from} to ${Math.min(from + PAGE, file.elements) - 1} of ${file.elements}`] : null),
    el("div", { class: "scroll" }, el("table", {},
      el("thead", {}, el("tr", {}, el("th", {}, "Address"), data.columns.map((column) => el("th", {}, column || "Value")), el("th", {}, "Symbol"), el("th", {}, "Description"))),
      el("tbody", {}, rows))));
  return follow(app, view, "table");
}

/** Switches and lamps, sliders and numbers for every point the program uses. */
export function points(app, view) {
  const item = (point) => {
    const name = el("span", { class: "name" }, link(app, point.address), el("span", { class: "symbol" }, point.symbol), el("span", { class: "description" }, point.description));
    if (point.analog) {
      const slider = el("input", { type: "range", min: 0, max: 32767, ariaLabel: `${point.address} ${point.symbol}`, on: {
        input: () => post("/api/write", { address: point.address, value: Number(slider.value) }) } });
      return el("li", {}, name, cell(app, point.address), point.input && !app.readOnly ? slider : null);
    }
    const lamp = el("button", {
      type: "button", role: "switch", class: `lamp ${point.input ? "input" : "output"}`, ariaLabel: `${point.address} ${point.symbol}`,
      data: { address: point.address }, disabled: !point.input || app.readOnly,
      on: { click: () => post("/api/write", { address: point.address, value: lamp.getAttribute("aria-checked") !== "true" }) },
    });
    return el("li", {}, lamp, name);
  };
  const list = (input) => el("ul", { class: "points" }, app.project.points.filter((point) => point.input === input).map(item));
  view.replaceChildren(el("h2", {}, "Inputs and outputs"),
    el("div", { class: "columns" }, el("section", {}, el("h3", {}, "Inputs"), list(true)), el("section", {}, el("h3", {}, "Outputs"), list(false))),
    el("div", { id: "gauges" }));
  return follow(app, view, "table");
}

/** Timers and counters with bars. */
export function timers(app, view) {
  const bars = [];
  const rows = app.project.timers.map((timer) => {
    const bar = el("meter", { min: 0, max: 1, value: 0, ariaLabel: `${timer.address} progress` });
    const seconds = el("span", { class: "seconds" });
    bars.push([timer, bar, seconds]);
    return el("tr", {}, el("th", { scope: "row" }, link(app, timer.address)), el("td", {}, timer.kind), el("td", { class: "symbol" }, timer.symbol),
      el("td", {}, cell(app, timer.accumulated)), el("td", {}, timer.preset ? cell(app, timer.preset) : "in the rung"), el("td", {}, bar, seconds), el("td", {}, cell(app, timer.done)));
  });
  view.replaceChildren(el("h2", {}, "Timers and counters"), el("div", { class: "scroll" }, el("table", {},
    el("thead", {}, el("tr", {}, ["Address", "Kind", "Symbol", "Accum", "Preset", "Progress", "Done"].map((text) => el("th", {}, text)))),
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
  const install = (state) => post("/api/force", { address: address.value.trim(), state });
  view.replaceChildren(el("h2", {}, "Forces"),
    app.readOnly ? null : el("div", { class: "row" }, enabled, button("Remove all", "Remove all forces", () => control({ do: "clear-forces" }))),
    app.readOnly ? null : el("div", { class: "row" }, address, button("Force on", "Force on", () => install(true)), button("Force off", "Force off", () => install(false))),
    el("table", {}, el("thead", {}, el("tr", {}, el("th", {}, "Address"), el("th", {}, "Forced to"), el("th", {}, ""))), body));
  let last = null;
  return app.live.listen((_, live) => {
    enabled.textContent = live.status.forces_enabled ? "Disable forces" : "Enable forces";
    const now = JSON.stringify(live.status.forces);
    if (now === last) return;
    last = now;
    const rows = live.status.forces.map(([at, on]) => el("tr", {}, el("th", { scope: "row" }, link(app, at)), el("td", {}, on ? "ON" : "OFF"),
      el("td", {}, app.readOnly ? null : button("Remove", `Remove the force of ${at}`, () => post("/api/force", { address: at, state: null })))));
    body.replaceChildren(...(rows.length ? rows : [el("tr", {}, el("td", { colSpan: 3 }, "No forces are installed."))]));
  });
}

/** Addresses a person follows. */
export function watch(app, view) {
  const address = el("input", { type: "text", ariaLabel: "Address to watch", placeholder: "T4:0.ACC", size: 14, autocomplete: "off" });
  const again = () => app.show(() => watch(app, view));
  const form = el("form", { class: "row", on: { submit: async (event) => {
    event.preventDefault();
    const text = address.value.trim();
    try {
      await get(`/api/uses?address=${encodeURIComponent(text)}`);
      app.watch(text);
      again();
    } catch (problem) {
      tell(problem.message, "wrong");
    }
  } } }, address, el("button", { type: "submit" }, "Watch"));
  const rows = app.watched.map((one) => el("tr", {}, el("th", { scope: "row" }, link(app, one)), el("td", {}, cell(app, one)),
    el("td", {}, button("Remove", `Remove ${one}`, () => {
      app.unwatch(one);
      again();
    }))));
  view.replaceChildren(el("h2", {}, "Watch list"), form,
    el("table", {}, el("thead", {}, el("tr", {}, el("th", {}, "Address"), el("th", {}, "Value"), el("th", {}, ""))), el("tbody", {}, rows)));
  return follow(app, view, "table");
}
