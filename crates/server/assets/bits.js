// Words as the vendor shows binary files: a column for every bit.

import { post } from "./api.js";
import { el } from "./dom.js";

/** Words of one page: every bit is a button. */
export const WORDS = 64;

/** The heads of the columns, 15 at the left. */
export const heads = () => Array.from({ length: 16 }, (_, at) => el("th", { class: place(15 - at), scope: "col" }, String(15 - at)));

const place = (bit) => (bit % 4 === 3 ? "bit nibble" : "bit");

/** The bits of a word; `data-bit` says which, `data-address` of which word. Arrows lead from bit to bit. */
export function bits(app, address) {
  return Array.from({ length: 16 }, (_, at) => {
    const bit = 15 - at;
    const one = el("button", {
      type: "button", title: `${address}/${bit}`, tabIndex: bit === 15 ? 0 : -1, data: { address, bit }, disabled: app.readOnly, ariaPressed: "false",
      on: { click: () => post("/api/write", { address: `${address}/${bit}`, value: one.ariaPressed === "true" ? 0 : 1 }), keydown: move },
    }, "…");
    return el("td", { class: place(bit) }, one);
  });
}

/** What a bit is now, from the value of its word. */
export function show(one, word) {
  const text = typeof word === "number" ? String((word >> Number(one.dataset.bit)) & 1) : "–";
  if (one.textContent === text) return;
  one.textContent = text;
  one.ariaPressed = String(text === "1");
}

function move(event) {
  const cell = event.currentTarget.closest("td");
  const beside = { ArrowLeft: cell.previousElementSibling, ArrowRight: cell.nextElementSibling };
  const rows = { ArrowUp: cell.parentElement.previousElementSibling, ArrowDown: cell.parentElement.nextElementSibling };
  const to = beside[event.key] ?? rows[event.key]?.children[cell.cellIndex];
  const next = to?.querySelector("button[data-bit]");
  if (!next) return;
  event.preventDefault();
  event.stopPropagation();
  next.focus();
}
