// Search everywhere: Ctrl-K.

import { get } from "./api.js";
import { byId, el } from "./dom.js";

export function palette(app) {
  const dialog = byId("palette");
  const input = el("input", { type: "search", role: "combobox", ariaLabel: "Search addresses, symbols, comments, instructions, views", ariaExpanded: "true",
    ariaAutoComplete: "list", "aria-controls": "found", placeholder: "T4:0, a symbol, a word, TON * 0.01 >=500 *", autocomplete: "off" });
  const list = el("ul", { role: "listbox", id: "found", ariaLabel: "Found" });
  let asked = 0;
  let at = 0;
  const choose = (index) => {
    at = Math.max(0, Math.min(list.children.length - 1, index));
    [...list.children].forEach((item, number) => item.setAttribute("aria-selected", String(number === at)));
    list.children[at]?.scrollIntoView({ block: "nearest" });
    if (list.children[at]) input.setAttribute("aria-activedescendant", `found-${at}`);
    else input.removeAttribute("aria-activedescendant");
  };
  const places = (text) => app.places.filter(([name]) => name.toLowerCase().includes(text.toLowerCase())).slice(0, 12)
    .map(([name, kind, hash]) => item(name, kind, () => app.goView(hash)));
  const note = (text) => el("li", { role: "option", ariaDisabled: "true", class: "more" }, text);
  const show = (items) => {
    items.forEach((one, number) => { one.id = `found-${number}`; });
    list.replaceChildren(...items);
    choose(0);
  };
  const item = (text, kind, open) => el("li", { role: "option", ariaDisabled: open ? null : "true", on: { click: () => {
    if (!open) return;
    dialog.close();
    open();
  } } }, el("span", { class: "kind" }, kind), el("span", {}, text));
  /** Where a hit leads; a text that belongs to nothing in the program leads nowhere. */
  const leads = (side, { routine, rung, address, data }) => {
    if (routine !== null) return () => side.goto(routine, rung ?? 0);
    if (address !== null) return () => side.open(address);
    return data !== null && side === app ? () => app.goView(`data/${encodeURIComponent(data)}`) : null;
  };
  const look = async () => {
    const mine = ++asked;
    const text = input.value.trim();
    if (!text) {
      show(places(""));
      return;
    }
    // Of two programs side by side both are searched.
    const sides = app.other ? [app, app.other] : [app];
    const all = await Promise.all(sides.map((side) => get(`${side.api}/search?q=${encodeURIComponent(text)}`)
      .catch((problem) => ({ named: null, hits: [], left_out: 0, problem: problem.message }))));
    if (mine !== asked) return;
    const items = [];
    const views = places(text);
    all.forEach(({ named }, number) => {
      const side = sides[number];
      if (named) items.push(item(`${named.address} ${named.symbol}`, `address, ${named.uses} uses`, () => side.open(named.address)));
    });
    items.push(...views);
    all.forEach((found, number) => {
      const side = sides[number];
      const name = side === app ? "" : `${side.project.file}, `;
      for (const hit of found.hits.slice(0, 100)) {
        const where = hit.rung === null ? name : `${name}${side.routineName(hit.routine)} rung ${hit.rung}: `;
        items.push(item(where + hit.text, hit.kind, leads(side, hit)));
      }
      const more = found.hits.length - 100 + found.left_out;
      if (more > 0) items.push(note(`${name}${more} more; search for something narrower`));
    });
    if (!items.length) items.push(note(all[0].problem ?? "Nothing found."));
    show(items);
  };
  let timer = 0;
  let waits = false;
  input.addEventListener("input", () => {
    clearTimeout(timer);
    waits = true;
    timer = setTimeout(now, 120);
  });
  const now = async () => {
    clearTimeout(timer);
    waits = false;
    await look();
  };
  input.addEventListener("keydown", async (event) => {
    if (event.key === "ArrowDown") choose(at + 1);
    else if (event.key === "ArrowUp") choose(at - 1);
    else if (event.key === "Escape") dialog.close();
    else if (event.key === "Enter") {
      event.preventDefault();
      // What was typed counts, not what was found before.
      if (waits) await now();
      list.children[at]?.click();
      return;
    } else return;
    event.preventDefault();
  });
  dialog.replaceChildren(input, list);
  app.search = () => {
    if (dialog.open) return;
    dialog.showModal();
    input.select();
    look();
  };
  byId("search-button").addEventListener("click", app.search);
}
