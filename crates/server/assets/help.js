// Keys of the page, and the signs it uses.

import { button, byId, el } from "./dom.js";

const KEYS = [
  ["Space", "run or pause"], ["S", "one scan (Shift: ten)"], ["B", "one scan back (Shift: ten)"],
  ["Ctrl K", "search everything, go to any view"], ["Arrows", "from instruction to instruction in a ladder"],
  ["Enter", "toggle a contact; elsewhere what can be done"], ["E", "edit the value of a box in its place; Tab goes to its next value"],
  ["M, Shift F10", "everything that can be done with an instruction: toggle, force, edit, cross reference, watch, trend"],
  ["X", "cross reference of an instruction"], ["Escape", "close what was opened"], ["?", "this page"],
];

const SIGNS = [
  ["on", "Thick and filled: it conducts, or its coil is on. Wires with power are thick."],
  ["rise", "Triangle up: became true in the last scan. Triangle down: became false."],
  ["idle", "Pale: not executed in the last scan."],
  ["forced", "Heavy dashed outline: its point is forced. A bar at the top of every view says so too."],
  ["set", "Filled flag beside a box: EN, TT, DN, ... is 1."],
];

/** Makes the help dialog and what opens it. */
export function help(app) {
  const dialog = byId("help");
  const theme = el("select", { id: "theme", on: { change: () => globalThis.rungsTheme.choose(theme.value) } },
    [["system", "as the system"], ["light", "light"], ["dark", "dark"]].map(([value, text]) => el("option", { value }, text)));
  const list = (rows, name) => el("dl", { class: "keys" }, rows.flatMap(([term, text]) => [el("dt", {}, name(term)), el("dd", {}, text)]));
  dialog.replaceChildren(
    el("div", { class: "row" }, el("h2", {}, "Keys and signs"), button("×", "Close", () => dialog.close(), { class: "close", ariaLabel: "Close" })),
    el("p", {}, el("label", {}, "Theme ", theme)),
    el("h3", {}, "Keys"), list(KEYS, (keys) => keys.split(", ").flatMap((one, at) => [at ? ", " : "", el("kbd", {}, one)])),
    el("h3", {}, "Signs"), list(SIGNS, (name) => el("span", { class: `sample ${name}`, ariaHidden: "true" })),
    el("h3", {}, "With a pointer"),
    el("p", {}, "Click a contact to toggle its bit, a value to edit it, an address for its cross reference. A right click, or Shift and a click, shows everything."));
  app.help = () => {
    if (dialog.open) return;
    theme.value = globalThis.rungsTheme.chosen();
    dialog.showModal();
  };
  byId("help-button").addEventListener("click", app.help);
}
