// Control of the run: the toolbar, the state beside it, banners, recording, the plant.

import { control, post, tell } from "./api.js";
import { button, byId, el, time } from "./dom.js";

const SPEEDS = [["0.1", "slow ×0.1"], ["1", "real time"], ["10", "×10"], ["100", "×100"], ["max", "as fast as possible"]];

function run(speed) {
  return control(speed === "max" ? { do: "run", speed: null } : { do: "run", speed: Number(speed) });
}

/** The toolbar. */
export function toolbar(app) {
  const speed = el("select", { ariaLabel: "Speed", on: { change: () => {
    if (app.live.status.pace !== "paused") run(speed.value);
  } } }, SPEEDS.map(([value, text]) => el("option", { value, selected: value === "1" }, text)));
  const go = el("button", { type: "button", id: "run", title: "Run or pause (Space)", on: { click: () => app.toggleRun() } }, "Run");
  app.toggleRun = () => (app.live.status.pace === "paused" ? run(speed.value) : control({ do: "pause" }));
  app.step = (count) => control({ do: "scan", count });
  app.back = async (count) => {
    const done = await control({ do: "back", count });
    if (done && done.scans < count) tell(`Only ${done.scans} scans are kept to go back to.`);
  };
  const mode = el("select", { ariaLabel: "Mode of the controller", on: { change: () => control({ do: "mode", mode: mode.value }) } },
    [["program", "Program"], ["run", "Run"], ["test", "Test"], ["power-cycle", "Power cycle"]].map(([value, text]) => el("option", { value }, text)));
  const scan = el("input", { type: "number", min: 0.1, max: 10000, step: "any", ariaLabel: "Milliseconds from one scan to the next",
    on: { change: () => control({ do: "scan-time", ms: Number(scan.value) }) } });
  const more = button("More…", "Run to a condition, snapshots, recording, plant, begin again", () => app.show(() => session(app, byId("view")), "session"), { id: "more" });
  byId("controls").replaceChildren(...(app.readOnly ? [el("span", {}, "read-only")] : [
    go,
    button("◀ 1", "One scan back (B)", () => app.back(1), { id: "back", ariaLabel: "One scan back" }),
    button("1 ▶", "One scan (S)", () => app.step(1), { id: "step", ariaLabel: "One scan" }),
    el("label", {}, "Speed ", speed), el("label", {}, "Mode ", mode), el("label", {}, "Scan ", scan, " ms"), more]));
  const status = byId("status");
  let notices = "";
  app.live.listen(({ status: now }) => {
    go.textContent = now.pace === "paused" ? "Run" : "Pause";
    go.classList.toggle("running", now.pace !== "paused");
    if (document.activeElement !== mode) mode.value = ["program", "run", "test"].includes(now.mode) ? now.mode : "program";
    if (document.activeElement !== scan) scan.value = now.scan_ms;
    status.textContent = `${now.mode.toUpperCase()} · scan ${now.scans} · ${time(now.time)}${now.slow ? " · slower than asked" : ""}`;
    status.dataset.mode = now.mode;
    const next = JSON.stringify([now.fault, now.forces.length, now.forces_enabled, now.recording !== null, now.ended, now.plant?.wrong]);
    if (next !== notices) {
      notices = next;
      banners(app, now);
    }
  });
}

/** What a person must not overlook stays in sight: faults, forces, a recording. */
function banners(app, now) {
  byId("banners").querySelectorAll(".state").forEach((old) => old.remove());
  const banner = (kind, ...children) => byId("banners").prepend(el("p", { class: `banner state ${kind}` }, children));
  if (now.plant?.wrong) banner("wrong", `Plant: ${now.plant.wrong}`);
  if (now.recording !== null) banner("note", "● Recording. Only what goes forward can be recorded.");
  if (now.ended && !now.fault) banner("note", `Paused: ${now.ended}.`);
  if (now.forces.length) {
    banner("forces", `${now.forces.length} ${now.forces.length === 1 ? "force is" : "forces are"} installed and ${now.forces_enabled ? "ENABLED" : "disabled"}. `,
      button("Show", "Show forces", () => app.goView("forces")));
  }
  if (now.fault) {
    const site = now.fault_site;
    banner("wrong fault", `Fault: ${now.fault}. `, site ? button("Go to the rung", "Go to the rung", () => app.goto(site[0], site[1])) : null);
  }
}

/** Everything about the run that is used less often. */
export function session(app, view) {
  const field = (label, node) => el("label", {}, label, " ", node);
  const text = (placeholder, size = 14) => el("input", { type: "text", placeholder, size, autocomplete: "off" });
  const [address, value, name, title] = [text("T4:0.ACC"), text("100", 8), text("before start"), text("pump starts", 24)];
  const relation = el("select", { ariaLabel: "Relation" }, ["=", "<>", "<", "<=", ">", ">="].map((one) => el("option", { value: one }, one)));
  const until = el("form", { class: "row", on: { submit: (event) => {
    event.preventDefault();
    control({ do: "until", address: address.value.trim(), relation: relation.value, value: Number(value.value), scans: null });
  } } }, field("Address", address), relation, field("Value", value), el("button", { type: "submit" }, "Run until"));
  const kept = el("ul");
  const keep = el("form", { class: "row", on: { submit: (event) => {
    event.preventDefault();
    control({ do: "keep", name: name.value.trim() });
  } } }, field("Name", name), el("button", { type: "submit" }, "Keep this state"));
  const scenario = el("pre", { tabIndex: 0 });
  const problems = el("ul", { class: "problems" });
  const saveButton = button("Save the scenario", "Save as a file", () => {
    const anchor = el("a", { href: URL.createObjectURL(new Blob([scenario.textContent], { type: "application/toml" })), download: "recording.toml" });
    anchor.click();
  }, { hidden: true });
  /** One request takes a thousand addresses. */
  const expect = async (addresses) => {
    for (let from = 0; from < addresses.length; from += 1000) await post("/api/record", { do: "expect", addresses: addresses.slice(from, from + 1000) });
  };
  const recording = el("div", { class: "row" },
    button("Begin recording", "Begins again with the data of the project", () => post("/api/record", { do: "start" }), { id: "record" }),
    button("Expect watched values here", "The scenario will expect what the watch list and the outputs hold now", () =>
      expect([...new Set([...app.watched, ...app.project.points.filter((point) => !point.input).map((point) => point.address)])]), { id: "expect" }),
    field("Name", title),
    button("End recording", "Gives the scenario", async () => {
      const done = await post("/api/record", { do: "stop", name: title.value.trim() || "recorded" });
      if (!done) return;
      scenario.textContent = done.scenario;
      problems.replaceChildren(...done.problems.map((one) => el("li", { class: "wrong" }, one)));
      if (!done.problems.length) problems.append(el("li", {}, "Replayed on a fresh machine: all expectations are met."));
      saveButton.hidden = false;
    }, { id: "record-stop" }));
  const plant = el("input", { type: "file", accept: ".toml", ariaLabel: "Plant file", on: { change: async () => {
    const file = plant.files[0];
    if (file && (await control({ do: "plant", text: await file.text() }))) tell(`The controller is wired to ${file.name}.`);
  } } });
  const gauges = el("dl", { class: "gauges" });
  view.replaceChildren(el("h2", {}, "Run"),
    el("h3", {}, "Run until"), until,
    el("h3", {}, "Snapshots"), keep, kept,
    el("h3", {}, "Recording"), recording, problems, saveButton, scenario,
    el("h3", {}, "Plant"), el("div", { class: "row" }, field("Plant file", plant), button("No plant", "Take the plant away", () => control({ do: "plant", text: null }))), gauges,
    el("h3", {}, "Begin again"), button("Restart", "Data of the project, program mode, no forces", () => control({ do: "restart" }), { id: "restart" }));
  let last = "";
  return app.live.listen(({ status }) => {
    const now = JSON.stringify(status.snapshots);
    if (now !== last) {
      last = now;
      kept.replaceChildren(...status.snapshots.map((one) => el("li", {}, one, " ", button("Go on from here", `Go on from ${one}`, () => control({ do: "resume", name: one })))));
    }
    gauges.replaceChildren(...(status.plant?.gauges ?? []).flatMap(([element, quantity, value, unit]) =>
      [el("dt", {}, `${element} ${quantity}`), el("dd", {}, `${Number(value.toFixed(2))} ${unit}`)]));
  });
}
