// What can be done with one instruction or address, as a menu at its place.

import { post } from "./api.js";
import { byId, el } from "./dom.js";
import { shown } from "./values.js";

/** Opens a menu at an element. Items are `[text, what it does]`; nothing stands between groups. */
export function menu(anchor, title, items) {
  const box = byId("menu");
  const list = el("ul", { role: "menu", ariaLabel: title }, items.map((item) => (item
    ? el("li", { role: "menuitem", tabIndex: -1, on: { click: () => choose(item[1]) } }, item[0])
    : el("li", { role: "separator" }))));
  const choose = (does) => {
    box.hidePopover();
    anchor.focus?.({ preventScroll: true });
    does();
  };
  const entries = [...list.querySelectorAll("[role=menuitem]")];
  const move = (step) => {
    const at = entries.indexOf(document.activeElement);
    entries[(at + step + entries.length) % entries.length]?.focus();
  };
  list.addEventListener("keydown", (event) => {
    const does = {
      ArrowDown: () => move(1), ArrowUp: () => move(-1), Home: () => entries[0]?.focus(), End: () => entries.at(-1)?.focus(),
      Enter: () => document.activeElement.click(), " ": () => document.activeElement.click(), Tab: () => box.hidePopover(),
      Escape: () => {
        box.hidePopover();
        anchor.focus?.({ preventScroll: true });
      },
    }[event.key];
    if (!does) return;
    event.preventDefault();
    event.stopPropagation();
    does();
  });
  box.replaceChildren(el("p", { class: "menu-title" }, title), list);
  box.showPopover();
  const [place, own] = [anchor.getBoundingClientRect(), box.getBoundingClientRect()];
  const top = place.bottom + own.height + 4 < innerHeight ? place.bottom + 4 : Math.max(4, place.top - own.height - 4);
  box.style.left = `${Math.max(4, Math.min(place.left, innerWidth - own.width - 4))}px`;
  box.style.top = `${Math.max(4, Math.min(top, innerHeight - own.height - 4))}px`;
  entries[0]?.focus();
}

/**
 * The entries for what has a bit, a point that can be forced, values. `edit(address)` asks for a value in its own way;
 * without one a dialog does.
 */
export function actions(app, { bit = null, forcible = false, values = [], addresses = [] }, edit) {
  const items = [];
  const now = (address) => shown(app.live.values.get(address));
  if (!app.readOnly) {
    if (bit) {
      const on = Boolean(app.live.values.get(bit));
      items.push([`Toggle bit ${bit} (now ${Number(on)})`, () => post(`${app.api}/write`, { address: bit, value: !on })]);
    }
    if (bit && forcible) {
      const force = (state) => () => post(`${app.api}/force`, { address: bit, state });
      items.push([`Force on ${bit}`, force(true)], [`Force off ${bit}`, force(false)]);
      if (app.forces.has(bit)) items.push([`Remove the force of ${bit}`, force(null)]);
    }
    if (items.length && values.length) items.push(null);
    // What the simulation has no value for cannot be written.
    for (const address of values.filter((one) => app.live.values.get(one) !== null)) {
      items.push([`Edit ${address} (now ${now(address)})…`, () => (edit ?? ((one) => app.edit(one)))(address)]);
    }
    if (items.length) items.push(null);
  }
  const all = [...new Set([...(bit ? [bit] : []), ...addresses, ...values])];
  for (const address of all) items.push([`Cross reference of ${address}`, () => app.open(address)]);
  for (const address of all) items.push([`Watch ${address}`, () => app.watch(address)]);
  // What is followed is the same for all who look.
  if (!app.readOnly) for (const address of [...(bit ? [bit] : []), ...values]) items.push([`Trend of ${address}`, () => app.trend(address)]);
  return items;
}
