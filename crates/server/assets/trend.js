// Trends: chosen values over simulated time, with a cursor, as a table and as a picture.

import { get, post, tell } from "./api.js";
import { button, colour, el, time } from "./dom.js";

/** Seconds a chart spans. */
const SPANS = [5, 10, 30, 60, 300, 1800];

/** A line is told from others by its dashes, not only by its colour. */
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [14, 4], [4, 4, 1, 4]];

function save(name, blob) {
  const anchor = el("a", { href: URL.createObjectURL(blob), download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 1000);
}

/** The value of a trace at a time. */
function at(trace, seconds) {
  let low = 0;
  let high = trace.points.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (trace.points[middle][1] <= seconds) low = middle + 1;
    else high = middle;
  }
  return low > 0 ? trace.points[low - 1][2] : undefined;
}

export function trend(app, view) {
  let traces = [];
  let cursor = null;
  let busy = false;
  let span = 30;
  const canvas = el("canvas", { role: "img", ariaLabel: "Chart of the values followed; left and right move the cursor", tabIndex: 0 });
  const legend = el("tbody");
  const address = el("input", { type: "text", ariaLabel: "Address to follow", placeholder: "T4:0.ACC", size: 14, autocomplete: "off" });
  const followed = () => traces.map((trace) => trace.address);
  const follow = async (addresses) => {
    if (await post("/api/trend", { addresses })) await load();
  };
  const spans = el("select", { ariaLabel: "Span", on: { change: () => {
    span = Number(spans.value);
    draw();
  } } }, SPANS.map((one) => el("option", { value: one, selected: one === span }, `${one} s`)));
  const csv = () => {
    const times = [...new Set(traces.flatMap((trace) => trace.points.map((point) => point[1])))].sort((a, b) => a - b);
    const quoted = (text) => `"${String(text).replaceAll('"', '""')}"`;
    const lines = [["time_s", ...followed()].map(quoted).join(",")];
    for (const seconds of times) lines.push([seconds, ...traces.map((trace) => at(trace, seconds) ?? "")].join(","));
    save("trend.csv", new Blob([lines.join("\n") + "\n"], { type: "text/csv" }));
  };
  view.replaceChildren(el("h2", {}, "Trend"),
    el("form", { class: "row", on: { submit: async (event) => {
      event.preventDefault();
      const one = address.value.trim() && (await app.address(address.value));
      if (one) await follow([...new Set([...followed(), one])]);
    } } }, app.readOnly ? null : [address, el("button", { type: "submit" }, "Follow")],
      el("label", {}, "Span ", spans),
      button("CSV", "Save as a table", csv),
      button("PNG", "Save as a picture", () => canvas.toBlob((blob) => blob && save("trend.png", blob)))),
    canvas,
    el("table", {}, el("thead", {}, el("tr", {}, ["Line", "Address", "Now", "At the cursor", "Action"].map((text) => el("th", {}, text)))), legend));

  function style(index) {
    return { ink: colour(`--line-${index % 6}`), dash: DASHES[index % DASHES.length] };
  }

  function rows() {
    legend.replaceChildren(...traces.map((trace, index) => {
      const sample = el("canvas", { width: 40, height: 12, ariaHidden: "true" });
      const context = sample.getContext("2d");
      const { ink, dash } = style(index);
      Object.assign(context, { strokeStyle: ink, lineWidth: 2 });
      context.setLineDash(dash);
      context.beginPath();
      context.moveTo(0, 6);
      context.lineTo(40, 6);
      context.stroke();
      return el("tr", {}, el("td", {}, sample),
        el("th", { scope: "row" }, button(trace.address, "Uses and value", () => app.open(trace.address), { class: "link address" }), trace.forgotten ? ` (${trace.forgotten} older points forgotten)` : ""),
        el("td", { class: "now" }), el("td", { class: "at" }),
        el("td", {}, app.readOnly ? null : button("Remove", `Remove ${trace.address}`, () => follow(followed().filter((one) => one !== trace.address)))));
    }));
    draw();
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width) return;
    if (canvas.width !== width * ratio || canvas.height !== height * ratio) {
      canvas.width = width * ratio;
      canvas.height = height * ratio;
    }
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = colour("--paper");
    context.fillRect(0, 0, width, height);
    const end = app.live.status?.time ?? 0;
    const start = end - span;
    const scale = Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
    const x = (seconds) => ((seconds - start) / span) * width;
    context.strokeStyle = colour("--line");
    context.fillStyle = colour("--faint");
    context.font = `${12 * scale}px sans-serif`;
    context.lineWidth = 1;
    for (let step = 0; step <= 5; step += 1) {
      const seconds = start + (span * step) / 5;
      context.beginPath();
      context.moveTo(x(seconds), 0);
      context.lineTo(x(seconds), height);
      context.stroke();
      if (seconds >= 0) context.fillText(time(seconds), Math.min(x(seconds) + 3, width - 60), height - 4);
    }
    const lane = (height - 18) / Math.max(traces.length, 1);
    for (let index = 1; index < traces.length; index += 1) context.strokeRect(0, Math.round(index * lane), width, 0);
    traces.forEach((trace, index) => {
      const [top, bottom] = [index * lane + 6, (index + 1) * lane - 6];
      const seen = trace.points.filter((point, at) => point[1] >= start || (trace.points[at + 1]?.[1] ?? Infinity) >= start);
      const values = seen.map((point) => point[2]);
      const least = Math.min(0, ...values);
      const most = Math.max(1, ...values);
      const y = (value) => bottom - ((value - least) / (most - least)) * (bottom - top);
      const { ink, dash } = style(index);
      Object.assign(context, { strokeStyle: ink, fillStyle: ink, lineWidth: 2 });
      context.setLineDash(dash);
      context.beginPath();
      seen.forEach(([, seconds, value], number) => {
        if (number === 0) context.moveTo(Math.max(0, x(seconds)), y(value));
        else {
          context.lineTo(x(seconds), y(seen[number - 1][2]));
          context.lineTo(x(seconds), y(value));
        }
      });
      if (seen.length) context.lineTo(x(end), y(seen.at(-1)[2]));
      context.stroke();
      context.setLineDash([]);
      context.fillText(`${trace.address}  ${least} … ${most}`, 4, top + 10);
      const cells = legend.children[index];
      if (cells) {
        cells.querySelector(".now").textContent = trace.points.at(-1)?.[2] ?? "–";
        cells.querySelector(".at").textContent = cursor === null ? "" : (at(trace, start + cursor * span) ?? "–");
      }
    });
    if (cursor !== null) {
      context.strokeStyle = colour("--ink");
      context.lineWidth = 1;
      context.beginPath();
      context.moveTo(cursor * width, 0);
      context.lineTo(cursor * width, height);
      context.stroke();
      context.fillStyle = colour("--ink");
      context.fillText(`${(start + cursor * span).toFixed(3)} s`, Math.min(cursor * width + 4, width - 70), 12);
    }
  }

  async function load() {
    if (busy) return;
    busy = true;
    try {
      const before = followed().join();
      traces = (await get("/api/trend")).traces;
      if (followed().join() === before) draw();
      else rows();
    } catch (problem) {
      tell(problem.message, "wrong");
    }
    busy = false;
  }

  const point = (event) => {
    cursor = Math.max(0, Math.min(1, event.offsetX / canvas.clientWidth));
    draw();
  };
  canvas.addEventListener("pointermove", point);
  canvas.addEventListener("pointerdown", point);
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -0.01, ArrowRight: 0.01 }[event.key];
    if (!step) return;
    event.preventDefault();
    cursor = Math.max(0, Math.min(1, (cursor ?? 1) + step));
    draw();
  });
  let scans = -1;
  const stop = app.live.listen((_, live) => {
    if (live.status.scans !== scans) {
      scans = live.status.scans;
      load();
    }
  });
  load();
  addEventListener("resize", draw);
  addEventListener("themechange", rows);
  return () => {
    stop();
    removeEventListener("resize", draw);
    removeEventListener("themechange", rows);
  };
}
