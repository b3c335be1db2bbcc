// The ladder of a program file: drawn by the server, coloured here by the power flow.

import { get, post } from "./api.js";
import { button, drawing, el } from "./dom.js";
import { shown } from "./values.js";

/** Rungs asked for at once. */
const CHUNK = 20;

/** Bits of the power flow of an instruction. */
const [EXECUTED, AFTER, CHANGED] = [1, 4, 8];

/** Columns of a drawing that fit. */
function columns(view) {
  // Padding, the mark of the rung a link led to, and the bar that scrolls.
  return Math.max(60, Math.min(160, Math.floor((view.clientWidth - 64) / 8)));
}

export async function ladder(app, view, routine, goal) {
  const file = app.project.routines.find((one) => one.number === routine);
  if (!file) throw new Error(`There is no program file or code block ${routine}.`);
  const width = columns(view);
  const heights = await get(`/api/routines/${routine}/heights?width=${width}`);
  const rungs = [];
  for (let index = 0; index < file.rungs; index += 1) {
    const rung = el("section", { class: "rung", data: { rung: index }, ariaLabel: `Rung ${index}` });
    rung.style.minHeight = `${heights[index]}px`;
    rungs.push(rung);
  }
  view.replaceChildren(el("h2", {}, `${file.title}`, el("span", { class: "description" }, ` ${file.description}`)), ...rungs);
  /** Rungs that are drawn: instructions, and what of them stands in the drawing. */
  const drawn = new Map();
  const visible = new Set();
  const asked = new Set();

  const reveal = (index) => rungs[index].scrollIntoView({ block: heights[index] < view.clientHeight ? "center" : "start" });

  const see = () => {
    const shownRungs = [...visible].map((index) => drawn.get(index)).filter(Boolean);
    const parts = shownRungs.flatMap((one) => one.parts);
    app.live.see("ladder", {
      rungs: [...visible].map((index) => [routine, index]),
      values: [...new Set(parts.flatMap((part) => [...part.values.map(([address]) => address), ...(part.bit ? [part.bit] : [])]))],
    });
  };

  function paint(index) {
    const one = drawn.get(index);
    if (!one) return;
    const bits = app.live.rungs.get(`${routine}:${index}`) ?? "";
    const forces = app.forces;
    one.parts.forEach((part, number) => {
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
      }
      for (const [address, nodes] of part.values) {
        const text = shown(app.live.values.get(address));
        for (const node of nodes) if (node.textContent !== text) {
          node.textContent = text;
          // It was stretched to the columns of the value it was drawn with.
          node.removeAttribute("textLength");
        }
      }
    });
    if (one.bits === bits) return;
    one.bits = bits;
    const power = new Set([0]);
    for (const [number, , leaves] of one.wires) if ((one.parts[number]?.flow ?? 0) & AFTER) power.add(leaves);
    for (const [from, to] of one.shorts) if (power.has(from)) power.add(to);
    const executed = one.parts.some((part) => part.flow & EXECUTED);
    for (const [wire, node] of one.nodes) node.classList.toggle("on", executed && power.has(wire));
  }

  async function load(index) {
    const from = Math.floor(index / CHUNK) * CHUNK;
    if (asked.has(from)) return;
    asked.add(from);
    const views = await get(`/api/routines/${routine}/rungs?from=${from}&count=${CHUNK}&width=${width}`);
    for (const rung of views) {
      const section = rungs[rung.rung];
      const picture = drawing(rung.svg);
      const parts = rung.instructions.map((instruction, number) => {
        const node = picture.querySelector(`g[data-i="${number}"]`) ?? el("span");
        const values = instruction.values.map(({ address, operand, instead }) =>
          [address, [...node.querySelectorAll(`text.${instead ? "operand" : "value"}[data-o="${operand}"]`)]]);
        node.tabIndex = 0;
        node.setAttribute("role", "button");
        node.addEventListener("click", (event) => act(event, instruction));
        node.addEventListener("keydown", (event) => {
          if (event.key === "Enter") act(event, instruction);
        });
        return { node, values, bit: instruction.bit, flow: -1 };
      });
      const nodes = [...picture.querySelectorAll("path.w[data-n]")].map((node) => [Number(node.dataset.n), node]);
      drawn.set(rung.rung, { parts, nodes, wires: rung.wires, shorts: rung.shorts, bits: null });
      section.replaceChildren(picture);
      paint(rung.rung);
    }
    see();
    if (goal !== null && drawn.has(goal)) {
      reveal(goal);
      rungs[goal].classList.add("goal");
      goal = null;
    }
  }

  /** A click on a contact or coil toggles its bit; with Shift, or on anything else, the panel opens. */
  function act(event, instruction) {
    event.preventDefault();
    const address = instruction.bit ?? instruction.values[0]?.address;
    if (!address) return;
    const input = instruction.bit && !app.readOnly && ["XIC", "XIO"].includes(instruction.mnemonic) && !event.shiftKey;
    if (input) post("/api/write", { address: instruction.bit, value: app.live.values.get(instruction.bit) ? 0 : 1 });
    app.open(address);
  }

  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const index = Number(entry.target.dataset.rung);
      if (entry.isIntersecting) {
        visible.add(index);
        load(index);
      } else visible.delete(index);
    }
    see();
  }, { root: view, rootMargin: "300px" });
  rungs.forEach((rung) => watcher.observe(rung));
  if (goal !== null && rungs[goal]) {
    reveal(goal);
    await load(goal);
  } else await load(0);

  let lastForces = null;
  const stop = app.live.listen((news) => {
    for (const key of Object.keys(news.rungs ?? {})) {
      const [of, index] = key.split(":").map(Number);
      if (of === routine && visible.has(index)) paint(index);
    }
    const forces = JSON.stringify(news.status.forces);
    const forced = forces !== lastForces;
    lastForces = forces;
    if (forced || Object.keys(news.values ?? {}).length) for (const index of visible) paint(index);
  });
  return () => {
    watcher.disconnect();
    stop();
    app.live.see("ladder", null);
  };
}
