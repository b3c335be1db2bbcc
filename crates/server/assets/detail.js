// One address: its value, what can be done with it, who writes and reads it.

import { get, post, tell } from "./api.js";
import { button, byId, el } from "./dom.js";
import { shown, typed } from "./values.js";

let stop = null;
let opener = null;

export function close(app) {
  const panel = byId("detail");
  const inside = panel.contains(document.activeElement);
  panel.hidden = true;
  stop?.();
  stop = null;
  app.live.see("detail", null);
  // Keys go on where they came from.
  if (inside) (opener?.isConnected ? opener : byId("view")).focus({ preventScroll: true });
}

/** Addresses of the members of a whole element: of `T4:0` its bits and words. */
export async function parts(app, address) {
  const label = (/^([A-Z]+\d*):\d+$/i.exec(address) ?? (app.project.dialect === "slc" ? null : /^([A-Z]+)\d+$/i.exec(address)))?.[1].toUpperCase();
  const file = app.project.data_files.find((one) => one.label.toUpperCase() === label);
  if (!file) return [];
  const { columns } = await get(`${app.api}/data/${encodeURIComponent(file.label)}?from=0&count=1`).catch(() => ({ columns: [] }));
  return columns.filter((column) => column !== "").map((column) => address + column);
}

/** Opens the panel on an address. `app` is the page. */
export async function open(app, address) {
  const panel = byId("detail");
  if (!panel.contains(document.activeElement)) opener = document.activeElement;
  let found;
  try {
    found = await get(`${app.api}/uses?address=${encodeURIComponent(address)}`);
  } catch (problem) {
    tell(problem.message, "wrong");
    return;
  }
  const members = await parts(app, found.address);
  stop?.();
  const value = el("output", { class: "value" }, "…");
  const outputs = members.map((at) => [at, el("output", { class: "value" }, "…")]);
  const link = (at) => button(at.slice(found.address.length), `${at}: value, uses, watch, trend`, () => open(app, at), { class: "link address" });
  const forced = el("strong", { class: "forced-word" });
  const bit = (on) => button(on ? "1" : "0", `Write ${on}`, () => post(`${app.api}/write`, { address: found.address, value: on }));
  const input = el("input", { type: "text", ariaLabel: `New value of ${found.address}`, size: 10, autocomplete: "off" });
  const write = el("form", { on: { submit: (event) => {
    event.preventDefault();
    post(`${app.api}/write`, { address: found.address, value: typed(input.value) });
  } } }, input, el("button", { type: "submit" }, "Write"));
  const force = (state, text) =>
    button(text, `${text} ${found.address}`, () => post(`${app.api}/force`, { address: found.address, state }));
  const point = app.project.points.some((point) => point.address === found.address && !point.analog) || /^[IOXY]/.test(found.address);
  panel.replaceChildren(...[
    el("div", { class: "row" }, el("h2", {}, found.address), button("×", "Close", () => close(app), { class: "close", ariaLabel: "Close" })),
    el("p", { class: "symbol" }, found.symbol),
    el("p", { class: "description" }, found.description),
    members.length ? el("dl", { class: "facts members" }, outputs.flatMap(([at, node]) => [el("dt", {}, link(at)), el("dd", {}, node)]))
      : el("p", {}, "Value: ", value, " ", forced),
    app.readOnly || members.length ? null : el("div", { class: "row" }, bit(0), bit(1), write),
    app.readOnly || !point ? null
      : el("div", { class: "row", role: "group", ariaLabel: "Force" }, force(true, "Force on"), force(false, "Force off"), force(null, "Remove force")),
    members.length ? null : el("div", { class: "row" },
      button("Watch", "Add to the watch list", () => app.watch(found.address)),
      app.readOnly ? null : button("Trend", "Add to the trend", () => app.trend(found.address))),
    el("h3", {}, `Cross reference (${found.uses.length + found.left_out})`),
    el("ul", { class: "uses" }, found.uses.map((use) => el("li", {},
      button(`${app.routineName(use.routine)} rung ${use.rung}`, "Go to the rung", () => app.goto(use.routine, use.rung), { class: "link" }),
      el("span", { class: `access ${use.access.includes("write") ? "writes" : "reads"}` }, use.access),
      el("code", {}, use.text)))),
    found.left_out ? el("p", {}, `${found.left_out} more are not listed.`) : null,
  ].filter(Boolean));
  panel.ariaLabel = `Address ${found.address}`;
  panel.hidden = false;
  panel.focus({ preventScroll: true });
  app.live.see("detail", { values: members.length ? members : [found.address] });
  stop = app.live.listen((_, live) => {
    const now = live.values.get(found.address);
    value.textContent = shown(now);
    for (const [at, node] of outputs) node.textContent = shown(live.values.get(at));
    const state = app.forces.get(found.address);
    forced.textContent = state === undefined ? "" : `forced ${state ? "ON" : "OFF"}`;
  });
}
