// Control of the run: the toolbar, the state beside it, banners.

import { control, tell } from "./api.js";
import { button, byId, el, time } from "./dom.js";

const SPEEDS = [["0.1", "×0.1"], ["1", "real time"], ["10", "×10"], ["100", "×100"], ["max", "fastest"]];

function run(speed) {
  return control(speed === "max" ? { do: "run", speed: null } : { do: "run", speed: Number(speed) });
}

/** The toolbar. */
export function toolbar(app) {
  const speed = el("select", { id: "speed", ariaLabel: "Speed", on: { change: () => {
    if (app.live.status.pace !== "paused") run(speed.value);
  } } }, SPEEDS.map(([value, text]) => el("option", { value, selected: value === "1" }, text)));
  const go = el("button", { type: "button", id: "run", title: "Run or pause (Space)", on: { click: () => app.toggleRun() } }, "Run");
  app.toggleRun = () => (app.live.status.pace === "paused" ? run(speed.value) : control({ do: "pause" }));
  app.step = (count) => control({ do: "scan", count });
  app.back = async (count) => {
    const done = await control({ do: "back", count });
    if (done && done.scans < count) tell(`Only ${done.scans} scans are kept to go back to.`);
  };
  const mode = el("select", { id: "mode", ariaLabel: "Mode of the controller", on: { change: () => control({ do: "mode", mode: mode.value }) } },
    [["program", "Program"], ["run", "Run"], ...(app.project.dialect === "slc" ? [["test", "Test"]] : [])].map(([value, text]) => el("option", { value }, text)));
  // What a controller comes to, but is not switched to.
  for (const [value, text] of [["fault", "Fault"], ["suspend", "Suspend"]]) mode.append(el("option", { value, hidden: true, disabled: true }, text));
  const scan = el("input", { id: "scan-time", type: "number", min: 0.1, max: 10000, step: "any", ariaLabel: "Milliseconds from one scan to the next",
    on: { change: () => control({ do: "scan-time", ms: Number(scan.value) }) } });
  const more = button("More…", "Run to a condition, snapshots, recording, plant, power cycle, begin again", () => app.goView("session"), { id: "more" });
  byId("controls").replaceChildren(...(app.readOnly ? [el("span", {}, "read-only")] : [
    go,
    button("◀ Back", "One scan back (B)", () => app.back(1), { id: "back" }),
    button("Scan ▶", "One scan (S)", () => app.step(1), { id: "step" }),
    el("label", {}, "Mode ", mode), el("label", {}, "Speed ", speed), el("label", {}, "Every ", scan, " ms"), more]));
  const status = byId("status");
  let notices = "";
  app.live.listen(({ status: now }) => {
    go.textContent = now.pace === "paused" ? "Run" : "Pause";
    go.classList.toggle("running", now.pace !== "paused");
    if (document.activeElement !== mode) mode.value = now.mode;
    if (document.activeElement !== scan) scan.value = now.scan_ms;
    const text = `${now.mode.toUpperCase()} · scan ${now.scans} · ${time(now.time)}${now.slow ? " · slower than asked" : ""}`;
    if (status.textContent !== text) status.textContent = text;
    status.dataset.mode = now.mode;
    const next = JSON.stringify([now.fault, now.forces, now.forces_enabled, now.recording !== null, now.ended, now.plant?.wrong]);
    if (next !== notices) {
      notices = next;
      banners(app, now);
    }
  });
}

/** What a person must not overlook stays in sight: faults, forces, a recording. */
function banners(app, now) {
  byId("banners").querySelectorAll(".state").forEach((old) => old.remove());
  const banner = (kind, ...children) => byId("banners").prepend(el("div", { class: `banner state ${kind}` }, children));
  if (now.plant?.wrong) banner("wrong", `Plant: ${now.plant.wrong}`);
  if (now.recording !== null) banner("note", "● Recording. Only what goes forward can be recorded.");
  if (now.ended && !now.fault) banner("note", `Paused: ${now.ended}.`);
  if (now.forces.length) {
    const first = now.forces.slice(0, 6).map(([address, on]) => `${address} ${on ? "ON" : "OFF"}`).join(", ");
    const more = now.forces.length > 6 ? ` and ${now.forces.length - 6} more` : "";
    banner("forces", `${now.forces.length} ${now.forces.length === 1 ? "force is" : "forces are"} installed and ${now.forces_enabled ? "ENABLED" : "disabled"}: ${first}${more}. `,
      button("Show", "Show forces", () => app.goView("forces")));
  }
  if (now.fault) {
    const site = now.fault_site;
    banner("wrong fault", `Fault: ${now.fault}. `, button("What to do", "Show the fault", () => app.goView("fault"), { id: "fault-show" }),
      site ? button("Go to the rung", "Go to the rung", () => app.goto(site[0], site[1])) : null);
  }
}
