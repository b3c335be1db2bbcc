// One rung: the drawing the server made, and what changes in it.

import { post } from "./api.js";
import { drawing, el } from "./dom.js";
import { actions, menu } from "./menu.js";
import { shown, typed } from "./values.js";

/** Bits of the power flow of an instruction. */
const [EXECUTED, AFTER, CHANGED] = [1, 4, 8];

const SVG = "http://www.w3.org/2000/svg";

function draw(name, attributes) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}

/** Units of a drawing are sixteenths of the size of text, so that drawings grow with it. */
export const rem = (units) => `${units / 16}rem`;

/**
 * The rectangle around parts of a drawing, from what they say of themselves: left, top, right, bottom. The browser would lay
 * out everything to answer.
 */
function extent(nodes) {
  const [xs, ys] = [[], []];
  for (const node of nodes) {
    const number = (name) => Number(node.getAttribute(name));
    if (node.localName === "text") {
      xs.push(number("x"), number("x") + number("textLength"));
      ys.push(number("y") - 12, number("y") + 4);
    } else if (node.localName === "rect" && !node.classList.contains("bar")) {
      xs.push(number("x"), number("x") + number("width"));
      ys.push(number("y"), number("y") + number("height"));
    } else if (node.localName === "path") {
      for (const [, command, rest] of node.getAttribute("d").matchAll(/([MLHVC])([^MLHVC]*)/g)) {
        const numbers = rest.trim().split(/[\s,]+/).map(Number);
        if (command === "H") xs.push(...numbers);
        else if (command === "V") ys.push(...numbers);
        else numbers.forEach((value, at) => (at % 2 ? ys : xs).push(value));
      }
    }
  }
  return xs.length && ys.length ? [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)] : null;
}

/** What a word in a box can be the address of; labels are none. */
const isAddress = (text) => /^[A-Za-z_$#][\w$#:./[\]-]*$/.test(text ?? "") && !/^Q\d+:\d+$/.test(text);

/** The program file (`U:3`) or code block (its name) an operand is, or nothing. */
const called = (app, text) => app.project.routines.find(({ number, title }) =>
  (app.project.dialect === "slc" ? text === `U:${number}` : text && title.endsWith(` ${text}`)));

export class Rung {
  #bits = null;

  /** Draws a rung of `/api/routines/…/rungs` into a section of the page. */
  constructor(app, routine, view, section) {
    this.app = app;
    this.section = section;
    this.key = `${routine}:${view.rung}`;
    this.place = [routine, view.rung];
    this.wires = view.wires;
    this.shorts = view.shorts;
    const picture = drawing(view.svg);
    // It holds what can be worked with: it is no picture to those who hear it.
    picture.setAttribute("role", "group");
    if (picture.hasAttribute("width")) {
      const width = Number(picture.getAttribute("width"));
      picture.style.width = rem(width);
      // A little smaller is better than a bar under every rung.
      picture.style.maxWidth = `max(100%, ${rem(0.8 * width)})`;
      picture.style.height = "auto";
    }
    this.nodes = [...picture.querySelectorAll("path.w[data-n]")].map((node) => [Number(node.dataset.n), node]);
    this.parts = view.instructions.map((instruction, number) => this.#part(picture, instruction, number));
    section.replaceChildren(picture);
    section.style.minHeight = "";
  }

  #part(picture, instruction, number) {
    const node = picture.querySelector(`g[data-i="${number}"]`) ?? el("span");
    this.#marks(node);
    const values = instruction.values.map(({ address, operand, instead }) => {
      const texts = [...node.querySelectorAll(`text.${instead ? "operand" : "value"}[data-o="${operand}"]`)];
      for (const text of texts) {
        // Values end where they were drawn to end, however long they become.
        text.setAttribute("x", Number(text.getAttribute("x")) + Number(text.getAttribute("textLength")));
        text.removeAttribute("textLength");
        text.classList.add("live");
      }
      return [address, texts];
    });
    const flags = node.querySelector(".frame") ? this.#flags(node, instruction) : [];
    const title = node.querySelector("title");
    const words = (title?.textContent ?? instruction.mnemonic).replace(/ \((true|false|forced on|forced off)\)/g, "");
    const part = { node, values, flags, title, words, instruction, bit: instruction.bit, flow: -1, forced: undefined, told: null };
    node.tabIndex = -1;
    node.setAttribute("role", "button");
    node.addEventListener("click", (event) => this.#click(event, part));
    node.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      this.menu(part);
    });
    return part;
  }

  /** The flags of a box (EN, DN): a sign and the letters behind it, as the drawing has them. */
  #flags(node, instruction) {
    return instruction.flags.map(({ name, address }) => {
      const text = [...node.querySelectorAll("text.mnemonic")].find(
        (one) => one.textContent === name && one.previousElementSibling?.classList.contains("sign"));
      if (!text) return [address, null];
      const flag = draw("g", { class: address ? "flag" : "flag unknown" });
      const [x, y, width] = ["x", "y", "textLength"].map((key) => Number(text.getAttribute(key)));
      flag.append(draw("rect", { class: "lit", x: x - 7, y: y - 12, width: width + 14, height: 16, rx: 7 }), text.previousElementSibling, text);
      node.append(flag);
      return [address, flag];
    });
  }

  /** What is hit between the strokes of an instruction, and the marks of what changed. */
  #marks(node) {
    const box = extent([...node.children]);
    if (!box) return;
    const [left, top, right, bottom] = box;
    // A finger needs some room.
    const [x, y] = [Math.max(2, (32 - right + left) / 2), Math.max(2, (32 - bottom + top) / 2)];
    node.prepend(draw("rect", { class: "hit", x: left - x, y: top - y, width: right - left + 2 * x, height: bottom - top + 2 * y }));
    const sign = node.querySelector(":scope > .sign, :scope > .frame");
    const at = sign && extent([sign]);
    if (!at) return;
    const [mark, line] = [at[2] + 2, at[1] - 2];
    node.append(draw("path", { class: "rise", d: `M${mark} ${line + 7}h9l-4.5 -8z` }), draw("path", { class: "fall", d: `M${mark} ${line - 1}h9l-4.5 8z` }));
  }

  /** What the live connection must tell for this rung. */
  get values() {
    return this.parts.flatMap((part) => [
      ...part.values.map(([address]) => address), ...part.flags.map(([address]) => address).filter(Boolean), ...(part.bit ? [part.bit] : []),
    ]);
  }

  paint() {
    const live = this.app.live;
    const bits = live.rungs.get(this.key) ?? "";
    const forces = this.app.forces;
    this.parts.forEach((part, number) => {
      const flow = Number.parseInt(bits[number] ?? "0", 16);
      const forced = part.bit ? forces.get(part.bit) : undefined;
      if (part.flow !== flow || part.forced !== forced) {
        part.flow = flow;
        part.forced = forced;
        const list = part.node.classList;
        list.toggle("idle", !(flow & EXECUTED));
        list.toggle("on", Boolean(flow & AFTER));
        list.toggle("edge", Boolean(flow & CHANGED));
        list.toggle("forced-on", forced === true);
        list.toggle("forced-off", forced === false);
        this.#tell(part);
      }
      for (const [address, nodes] of part.values) {
        const text = shown(live.values.get(address));
        for (const node of nodes) if (node.textContent !== text) node.textContent = text;
      }
      for (const [address, flag] of part.flags) {
        if (address) flag?.classList.toggle("set", live.values.get(address) === 1);
      }
    });
    if (this.#bits === bits) return;
    this.#bits = bits;
    const power = new Set([0]);
    for (const [number, , leaves] of this.wires) if ((this.parts[number]?.flow ?? 0) & AFTER) power.add(leaves);
    for (const [from, to] of this.shorts) if (power.has(from)) power.add(to);
    const executed = this.parts.some((part) => part.flow & EXECUTED);
    for (const [wire, node] of this.nodes) node.classList.toggle("on", executed && power.has(wire));
    this.section.classList.toggle("not-executed", !executed);
  }

  /** What is drawn, in words. */
  #tell(part) {
    const { flow, forced } = part;
    const told = [
      flow & EXECUTED ? (flow & AFTER ? "true" : "false") : "not executed",
      flow & CHANGED ? `${flow & AFTER ? "became true" : "became false"} in the last scan` : null,
      forced === undefined ? null : `forced ${forced ? "on" : "off"}`,
    ].filter(Boolean).join(", ");
    if (part.told === told || !part.title) return;
    part.told = told;
    part.title.textContent = `${part.words} (${told})`;
  }

  #click(event, part) {
    event.preventDefault();
    const target = event.target;
    const value = part.values.find(([, nodes]) => nodes.includes(target));
    if (value && !this.app.readOnly && !event.shiftKey) this.edit(part, value[0]);
    else if (target.matches?.("text.address, text.symbol, text.operand") && !event.shiftKey) this.#uses(part, target);
    else if (event.shiftKey) this.menu(part);
    else this.act(part);
  }

  #uses(part, target) {
    const operand = part.instruction.operands[Number(target.dataset.o ?? 0)];
    const routine = called(this.app, operand);
    const address = isAddress(operand) ? operand : part.bit;
    if (routine) this.app.goto(routine.number, 0);
    else if (address) this.app.open(address);
    else this.menu(part);
  }

  /** What a click or Enter does: a contact is toggled, a value is edited, everything else says what can be done. */
  act(part) {
    const { app } = this;
    if (part.instruction.contact && !app.readOnly) {
      post(`${app.api}/write`, { address: part.bit, value: app.live.values.get(part.bit) ? 0 : 1 });
    } else this.menu(part);
  }

  /** Everything that can be done with an instruction. */
  menu(part) {
    const { bit, forcible, values, operands, mnemonic } = part.instruction;
    const { app } = this;
    const to = operands.map((text) => called(app, text)).filter(Boolean);
    const addresses = operands.filter((text) => isAddress(text) && !/^U:\d+$/.test(text) && !called(app, text) && !/^(0x)?[\dA-F]+h$/i.test(text));
    const items = actions(app, { bit, forcible, addresses, values: values.map((one) => one.address) }, (address) => this.edit(part, address));
    items.unshift(...to.map(({ number }) => [`Go to ${app.routineName(number)}`, () => app.goto(number, 0)]));
    if (items.length) menu(part.node, `${mnemonic} ${operands[0] ?? ""}`.trim(), items);
  }

  /** Edits a value where it stands. Enter writes it, Tab writes it and goes on to the next one, Escape does not. */
  edit(part, address) {
    const { app, section } = this;
    const [, texts] = part.values.find(([one]) => one === address) ?? [];
    const anchor = texts?.[0];
    if (!anchor) {
      app.edit(address);
      return;
    }
    const before = shown(app.live.values.get(address));
    const input = el("input", { type: "text", class: "inplace", value: before, ariaLabel: `New value of ${address}`, autocomplete: "off" });
    const [place, origin] = [anchor.getBoundingClientRect(), section.getBoundingClientRect()];
    input.style.right = `${origin.right - place.right - section.scrollLeft - 6}px`;
    input.style.top = `${place.top - origin.top - 6}px`;
    let open = true;
    const close = (focus) => {
      if (!open) return;
      open = false;
      input.remove();
      if (focus) part.node.focus({ preventScroll: true });
    };
    const write = () => {
      if (input.value.trim() !== before) post(`${app.api}/write`, { address, value: typed(input.value) });
    };
    input.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") {
        write();
        close(true);
      } else if (event.key === "Escape") close(true);
      else if (event.key === "Tab") {
        const all = part.values.map(([one]) => one);
        const next = all[all.indexOf(address) + (event.shiftKey ? -1 : 1)];
        write();
        close(true);
        if (next) this.edit(part, next);
      } else return;
      event.preventDefault();
    });
    input.addEventListener("blur", () => close(false));
    section.append(input);
    input.focus();
    input.select();
  }
}
