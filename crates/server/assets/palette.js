// Search everywhere: Ctrl-K.

import { get } from "./api.js";
import { byId, el } from "./dom.js";

export function palette(app) {
  const dialog = byId("palette");
  const input = el("input", { type: "search", ariaLabel: "Search addresses, symbols, comments, instructions", placeholder: "T4:0, a symbol, a word, TON * 0.01 >=500 *", autocomplete: "off" });
  const list = el("ul", { role: "listbox", ariaLabel: "Found" });
  let asked = 0;
  let at = 0;
  const choose = (index) => {
    at = Math.max(0, Math.min(list.children.length - 1, index));
    [...list.children].forEach((item, number) => item.setAttribute("aria-selected", String(number === at)));
    list.children[at]?.scrollIntoView({ block: "nearest" });
  };
  const item = (text, kind, open) => el("li", { role: "option", on: { click: () => {
    dialog.close();
    open();
  } } }, el("span", { class: "kind" }, kind), el("span", {}, text));
  const look = async () => {
    const mine = ++asked;
    const text = input.value.trim();
    if (!text) {
      list.replaceChildren();
      return;
    }
    const [uses, found] = await Promise.all([
      get(`/api/uses?address=${encodeURIComponent(text)}`).catch(() => null),
      get(`/api/search?q=${encodeURIComponent(text)}`).catch((problem) => ({ hits: [], left_out: 0, problem: problem.message })),
    ]);
    if (mine !== asked) return;
    const items = [];
    if (uses) items.push(item(`${uses.address} ${uses.symbol}`, `address, ${uses.uses.length + uses.left_out} uses`, () => app.open(uses.address)));
    for (const hit of found.hits.slice(0, 100)) {
      const where = hit.rung === null ? "" : `${app.routineName(hit.routine)} rung ${hit.rung}: `;
      items.push(item(where + hit.text, hit.kind, () => (hit.rung === null ? app.open(hit.text) : app.goto(hit.routine, hit.rung))));
    }
    const more = found.hits.length - 100 + found.left_out;
    if (more > 0) items.push(el("li", { class: "more" }, `${more} more; search for something narrower`));
    if (!items.length) items.push(el("li", { class: "more" }, found.problem ?? "Nothing found."));
    list.replaceChildren(...items);
    choose(0);
  };
  let timer = 0;
  input.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(look, 120);
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown") choose(at + 1);
    else if (event.key === "ArrowUp") choose(at - 1);
    else if (event.key === "Enter") list.children[at]?.click();
    else return;
    event.preventDefault();
  });
  dialog.replaceChildren(input, list);
  app.search = () => {
    if (dialog.open) return;
    dialog.showModal();
    input.select();
  };
  byId("search-button").addEventListener("click", app.search);
}
