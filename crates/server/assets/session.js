// Everything about the run that is used less often: conditions, snapshots, recordings, the plant, power.

import { control, post, tell } from "./api.js";
import { button, el } from "./dom.js";
import { showGauges } from "./tables.js";

/** The view. */
export function session(app, view) {
  const field = (label, node) => el("label", {}, label, " ", node);
  const text = (placeholder, size = 14) => el("input", { type: "text", placeholder, size, autocomplete: "off" });
  const [address, value, name, title] = [text("T4:0.ACC"), text("100", 8), text("before start"), text("pump starts", 24)];
  const relation = el("select", { ariaLabel: "Relation" }, ["=", "<>", "<", "<=", ">", ">="].map((one) => el("option", { value: one }, one)));
  const until = el("form", { class: "row", on: { submit: async (event) => {
    event.preventDefault();
    if (!address.value.trim() || !value.value.trim() || !Number.isFinite(Number(value.value))) {
      tell(value.value.trim() && address.value.trim() ? `${value.value} is no number.` : "Enter an address and a number to compare it with.", "wrong");
      return;
    }
    control({ do: "until", address: await app.address(address.value), relation: relation.value, value: Number(value.value), scans: null });
  } } }, field("Address", address), relation, field("Value", value), el("button", { type: "submit", id: "until" }, "Run until"));
  const kept = el("ul", { class: "plain" });
  const keep = el("form", { class: "row", on: { submit: (event) => {
    event.preventDefault();
    control({ do: "keep", name: name.value.trim() || `scan ${app.live.status.scans}` });
  } } }, field("Name", name), el("button", { type: "submit", id: "keep" }, "Keep this state"));
  const scenario = el("pre", { tabIndex: 0, ariaLabel: "Scenario", role: "region" });
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
  const body = [
    el("h3", {}, "Run until"), until,
    el("h3", {}, "Snapshots"), keep, kept,
    el("h3", {}, "Recording"), recording, problems, saveButton, scenario,
    el("h3", {}, "Plant"), el("div", { class: "row" }, field("Plant file", plant), button("No plant", "Take the plant away", () => control({ do: "plant", text: null }))), gauges,
    el("h3", {}, "Power"), el("div", { class: "row" },
      button("Power cycle", "Power is lost and comes back", () => control({ do: "mode", mode: "power-cycle" }), { id: "power-cycle" }),
      "Power is lost and comes back; what is retentive stays."),
    el("h3", {}, "Begin again"), el("div", { class: "row" },
      button("Restart", "Data of the project, program mode, no forces", () => control({ do: "restart" }), { id: "restart" }),
      "Data of the project, program mode, no forces, no history."),
  ];
  view.replaceChildren(el("h2", {}, "Run and recording"), ...(app.readOnly ? [el("p", {}, "This page is read-only."), el("h3", {}, "Plant"), gauges] : body));
  let last = "";
  return app.live.listen(({ status }) => {
    const now = JSON.stringify(status.snapshots);
    if (now !== last) {
      last = now;
      kept.replaceChildren(...status.snapshots.map((one) => el("li", {}, button("Go on from here", `Go on from ${one}`, () => control({ do: "resume", name: one })), " ", one)));
    }
    showGauges(gauges, status.plant);
  });
}
