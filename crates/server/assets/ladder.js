// The ladder of a program file: drawn by the server, coloured here by the power flow.

import { get, tell } from "./api.js";
import { el } from "./dom.js";
import { Rung, rem } from "./rung.js";

/** Rungs asked for at once. */
const CHUNK = 20;

/** Rungs out of sight that stay drawn: scrolling back a little costs nothing, and a long file does not fill the page. */
const KEPT = 100;

/** Milliseconds of drawing between two pictures: scrolling stays smooth while rungs appear. */
const BUDGET = 6;

/** The fewest columns a drawing can have. */
const NARROWEST = 60;

/** Columns of a drawing that fit. Padding, the mark of the rung a link led to, and the bar that scrolls take their part. */
function columns(view) {
  const column = 8 * (Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 16);
  const style = getComputedStyle(view);
  const padding = Number.parseFloat(style.paddingLeft) + Number.parseFloat(style.paddingRight);
  return Math.max(NARROWEST, Math.min(160, Math.floor((view.clientWidth - padding - 24) / column)));
}

export async function ladder(app, view, routine, goal, mark = true) {
  const file = app.project.routines.find((one) => one.number === routine);
  if (!file) throw new Error(`There is no program file or code block ${routine}.`);
  const width = columns(view);
  const heights = await get(`${app.api}/routines/${routine}/heights?width=${width}`);
  const rungs = [];
  for (let index = 0; index < file.rungs; index += 1) {
    const rung = el("section", { class: "rung rung-place", data: { rung: index }, ariaLabel: `Rung ${index}` });
    rung.style.minHeight = rem(heights[index]);
    rungs.push(rung);
  }
  view.replaceChildren(
    el("h2", {}, `${file.title}`, el("span", { class: "description" }, ` ${file.description}`)),
    el("p", { class: "print-only" }, "Rungs that were not on the screen are not printed; `rungs report` prints the whole program."),
    ...rungs);
  /** Rungs as the server drew them, those that are in the page, and those that are to be. */
  const known = new Map();
  const drawn = new Map();
  const waiting = new Set();
  const later = new Set();
  const visible = new Set();
  const asked = new Map();
  /** The one instruction that Tab leads to; arrows lead from there to the others. */
  let current = null;

  const reveal = (index) => rungs[index].scrollIntoView({ block: rungs[index].offsetHeight < view.clientHeight ? "center" : "start" });

  const see = () => {
    const shown = [...visible].map((index) => drawn.get(index)).filter(Boolean);
    app.live.see("ladder", { rungs: [...visible].map((index) => [routine, index]), values: [...new Set(shown.flatMap((one) => one.values))] });
  };

  const enter = (part) => {
    if (current) current.node.tabIndex = -1;
    current = part;
    if (part) part.node.tabIndex = 0;
  };

  async function chunk(from) {
    const views = await get(`${app.api}/routines/${routine}/rungs?from=${from}&count=${CHUNK}&width=${width}`);
    for (const one of views) {
      known.set(one.rung, one);
      later.add(one.rung);
    }
  }

  function draw(index) {
    if (drawn.has(index) || !known.has(index)) return;
    const rung = new Rung(app, routine, known.get(index), rungs[index]);
    drawn.set(index, rung);
    rung.paint();
    if (!current && rung.parts.length) enter(rung.parts[0]);
  }

  let drawing = 0;
  function soon(index) {
    waiting.add(index);
    drawing ||= requestAnimationFrame(work);
  }

  /** Draws what came into sight, and then what is beside it, as much as one picture has time for. */
  function work() {
    drawing = 0;
    const end = performance.now() + BUDGET;
    for (const queue of [waiting, later]) {
      for (const index of queue) {
        if (performance.now() > end) break;
        queue.delete(index);
        if (visible.has(index) || (queue === later && drawn.size < KEPT)) draw(index);
      }
    }
    if (waiting.size + later.size) drawing = requestAnimationFrame(work);
    else tidy();
    see();
  }

  /** Takes rungs out of the page that are far away; their places keep their heights. */
  function tidy() {
    const size = Number.parseFloat(getComputedStyle(document.documentElement).fontSize);
    const [first, last] = [Math.min(...visible), Math.max(...visible)];
    const busy = [document.activeElement, current?.node].map((node) => node?.closest?.(".rung-place"));
    const away = [...drawn.keys()].filter((index) => !visible.has(index) && !busy.includes(rungs[index]));
    away.sort((a, b) => Math.max(first - b, b - last) - Math.max(first - a, a - last));
    const gone = away.slice(0, Math.max(0, away.length - KEPT)).map((index) => [index, rungs[index].offsetHeight]);
    for (const [index, height] of gone) {
      rungs[index].style.minHeight = `${height / size}rem`;
      rungs[index].replaceChildren();
      drawn.delete(index);
    }
  }

  async function load(index) {
    await fetched(index);
    draw(index);
    see();
  }

  function fetched(index) {
    const from = Math.floor(index / CHUNK) * CHUNK;
    if (!asked.has(from)) {
      asked.set(from, chunk(from).catch((problem) => {
        // It is asked for again when it comes into sight again.
        asked.delete(from);
        tell(problem.message, "wrong");
      }));
    }
    return asked.get(from);
  }

  async function arrive(index) {
    reveal(index);
    await load(index);
    if (mark) rungs[index].classList.add("goal");
    const first = drawn.get(index)?.parts[0];
    if (first) enter(first);
    reveal(index);
  }

  const middle = (part) => {
    const sign = part.node.querySelector?.(".sign, .frame") ?? part.node;
    const { left, right, top } = sign.getBoundingClientRect();
    return [(left + right) / 2, top];
  };

  async function focus(part) {
    if (!part) return;
    enter(part);
    part.node.focus({ preventScroll: true });
    part.node.scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  /** The instructions of the next rung, upwards or downwards, that has some. */
  async function beyond(index, step) {
    for (let at = index + step; at >= 0 && at < rungs.length; at += step) {
      await load(at);
      const { parts } = drawn.get(at) ?? { parts: [] };
      if (parts.length) return parts;
    }
    return [];
  }

  async function move(index, part, key) {
    const { parts } = drawn.get(index);
    const at = parts.indexOf(part);
    if (key === "ArrowRight") return focus(parts[at + 1] ?? (await beyond(index, 1))[0]);
    if (key === "ArrowLeft") return focus(parts[at - 1] ?? (await beyond(index, -1)).at(-1));
    const down = key === "ArrowDown";
    const [x, y] = middle(part);
    const towards = (all) => {
      const places = all.map((one) => [one, ...middle(one)]).filter(([, , top]) => (down ? top > y + 6 : top < y - 6));
      const row = down ? Math.min(...places.map((place) => place[2])) : Math.max(...places.map((place) => place[2]));
      const near = places.filter((place) => Math.abs(place[2] - row) < 24);
      return near.sort((a, b) => Math.abs(a[1] - x) - Math.abs(b[1] - x))[0]?.[0];
    };
    return focus(towards(parts) ?? towards(await beyond(index, down ? 1 : -1)));
  }

  function key(event) {
    const node = event.target.closest?.("g.i");
    const section = event.target.closest?.(".rung-place");
    if (!node || !section || event.altKey || event.ctrlKey || event.metaKey) return;
    const index = Number(section.dataset.rung);
    const rung = drawn.get(index);
    const part = rung?.parts.find((one) => one.node === node);
    if (!part) return;
    const address = part.bit ?? part.instruction.values[0]?.address;
    const does = {
      Enter: () => rung.act(part), " ": () => rung.act(part), m: () => rung.menu(part), F10: () => event.shiftKey && rung.menu(part),
      e: () => part.values.length && !app.readOnly && rung.edit(part, part.values[0][0]),
      x: () => address && app.open(address),
    }[event.key] ?? (event.key.startsWith("Arrow") ? () => move(index, part, event.key) : null);
    if (!does) return;
    event.preventDefault();
    event.stopPropagation();
    does();
  }

  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const index = Number(entry.target.dataset.rung);
      if (entry.isIntersecting) {
        visible.add(index);
        if (drawn.has(index)) drawn.get(index).paint();
        else fetched(index).then(() => soon(index));
      } else visible.delete(index);
    }
    see();
  }, { root: view, rootMargin: "300px" });
  rungs.forEach((rung) => watcher.observe(rung));
  view.addEventListener("keydown", key);
  const focused = (event) => {
    const node = event.target.closest?.("g.i");
    const section = node?.closest(".rung-place");
    const part = section && drawn.get(Number(section.dataset.rung))?.parts.find((one) => one.node === node);
    if (part) enter(part);
  };
  view.addEventListener("focusin", focused);
  if (goal !== null && rungs[goal]) await arrive(goal);
  else await load(0);

  let lastForces = null;
  const stop = app.live.listen((news) => {
    const forces = JSON.stringify(news.status.forces);
    const all = forces !== lastForces || Object.keys(news.values ?? {}).length;
    lastForces = forces;
    if (all) for (const index of visible) drawn.get(index)?.paint();
    else for (const key of Object.keys(news.rungs ?? {})) {
      const [of, index] = key.split(":").map(Number);
      if (of === routine && visible.has(index)) drawn.get(index)?.paint();
    }
  });

  // Another width has other drawings; the rung on top stays.
  let timer = 0;
  const resized = new ResizeObserver(function look() {
    clearTimeout(timer);
    timer = setTimeout(() => {
      if (columns(view) === width) return;
      // What a person types would go with the drawing.
      if (view.querySelector("input:focus")) return look();
      const top = view.getBoundingClientRect().top;
      const at = rungs.findIndex((rung) => rung.getBoundingClientRect().bottom > Math.max(top, 0));
      app.show(() => ladder(app, view, routine, at > 0 ? at : null, false));
    }, 250);
  });
  resized.observe(view);
  return () => {
    clearTimeout(timer);
    cancelAnimationFrame(drawing);
    resized.disconnect();
    watcher.disconnect();
    view.removeEventListener("keydown", key);
    view.removeEventListener("focusin", focused);
    stop();
    app.live.see("ladder", null);
  };
}
