// The search for a difference, and the tape that leads to one.

import { control, get, post, tell } from "./api.js";
import { button, el } from "./dom.js";

const count = (number) => number.toLocaleString("en");

/** Loads a scenario as a tape. */
async function play(text) {
  const done = await control({ do: "tape", text });
  if (done) tell("The tape is loaded: step through it scan by scan, or run to the difference.");
  return done;
}

/** The search. */
export function search(app) {
  const seed = el("input", { type: "number", min: 0, value: 1, size: 6 });
  const scans = el("input", { type: "number", min: 1, max: 10000000, value: 100000, step: 1 });
  const start = button("Look for a difference", "Runs a proof in the background: random and directed inputs from this seed", () => begin(), { id: "prove" });
  const stop = button("Stop the search", "What was seen so far is its result", () => post("/api/pair/proof", { do: "stop" }), { id: "prove-stop", hidden: true });
  const progress = el("progress", { max: 1, value: 0, ariaLabel: "Scans of the search", hidden: true });
  const state = el("span", { id: "prove-state", role: "status" });
  const file = el("input", { type: "file", accept: ".toml", on: { change: async () => {
    const chosen = file.files[0];
    if (chosen) await play(await chosen.text());
    file.value = "";
  } } });
  const result = el("div", { id: "verdict" });
  let timer = 0;
  let mine = false;
  let last = "";

  async function begin() {
    if (!(await post("/api/pair/proof", { do: "start", seed: Number(seed.value), scans: Number(scans.value) }))) return;
    mine = true;
    look();
  }

  function verdict(now) {
    const found = now.found;
    const save = (name, text) => button(`Save ${name}`, "Save as a scenario file", () => el("a", { href: URL.createObjectURL(new Blob([text], { type: "application/toml" })), download: name }).click());
    result.replaceChildren(
      el("p", { class: `verdict ${now.verdict === "different" ? "differs" : ""}` }, el("strong", {}, now.verdict), ` – seed ${now.seed}, ${count(now.scans)} of ${count(now.of)} scans of both`),
      found ? el("p", {}, `${found.what}, after ${found.scans} scans with ${found.changes} changes of inputs. `) : "",
      found ? el("div", { class: "row" }, app.readOnly ? null : button("Step through it", "Begins again with this counterexample as a tape", () => play(found.original), { id: "play" }),
        save("original.toml", found.original), save("converted.toml", found.other)) : "",
      el("ul", { class: "coverage" }, now.coverage.map(([what, reached, all]) => el("li", {}, `${what}: ${count(reached)} of ${count(all)} reached (${(Math.floor((1000 * reached) / all) / 10).toFixed(1)} %)`))),
      el("details", {}, el("summary", {}, "The whole report"), el("pre", { tabIndex: 0 }, now.text)));
  }

  async function look() {
    clearTimeout(timer);
    let now;
    try {
      now = await get("/api/pair/proof");
    } catch (problem) {
      state.textContent = problem.message;
      return;
    }
    const busy = ["running", "arguing", "shortening", "stopping"].includes(now.state);
    start.hidden = busy;
    stop.hidden = !busy || app.readOnly;
    progress.hidden = !busy;
    progress.value = busy ? now.scans / now.of : 0;
    state.textContent = {
      idle: "", done: "",
      running: now.scans ? `${count(now.scans)} of ${count(now.of)} scans` : "Preparing…",
      arguing: `${count(now.scans)} of ${count(now.of)} scans; looking for what cannot happen`,
      shortening: "A difference was found; the way to it is being made shorter.",
      stopping: "Stopping…",
      broken: "The search broke off without a result.",
    }[now.state];
    const text = JSON.stringify([now.verdict, now.scans, now.seed, now.of]);
    if (now.state === "done" && text !== last) {
      last = text;
      verdict(now);
      if (mine && now.found) play(now.found.original);
    }
    if (busy) {
      result.replaceChildren();
      last = "";
    } else mine = false;
    // Somebody else may begin one.
    timer = setTimeout(look, busy ? 300 : 3000);
  }
  look();
  const node = el("section", { class: "pair-search" },
    el("div", { class: "row" }, app.readOnly ? el("span", {}, "Search for a difference") : [start, el("label", {}, "Seed ", seed), el("label", {}, "Scans ", scans)], stop, progress, state,
      app.readOnly ? null : el("label", { class: "pair-file" }, "or play a scenario ", file)), result);
  return [node, () => clearTimeout(timer)];
}

/** The tape, and how far it is. It stays in sight in every view: nothing can be changed by hand while it is played. */
export function tape(app) {
  const name = el("strong");
  const at = el("span", { class: "seconds" });
  const bar = el("progress", { max: 1, value: 0, ariaLabel: "Scans of the tape that have run" });
  const start = button("|◀ Start", "Before the first scan of the tape", () => control({ do: "back", count: app.live.status.tape?.at ?? 0 }), { id: "tape-start" });
  const playing = el("section", { class: "row tape", ariaLabel: "Tape", hidden: true }, el("span", {}, "Tape: ", name), bar, at, app.readOnly ? null : [start,
    button("◀ Back", "One scan back (B)", () => app.back(1)), button("Scan ▶", "The next scan of the tape (S)", () => app.step(1), { id: "tape-step" }),
    app.other ? button("To the difference ▶|", "Runs the tape up to the first difference", () => toDifference(app), { id: "tape-difference" })
      : button("To the end ▶|", "Runs the rest of the tape", () => control({ do: "run", speed: null }), { id: "tape-end" }),
    button("Leave the tape", "Go on by hand from here", () => control({ do: "tape", text: null }), { id: "tape-leave" })]);
  app.live.listen(({ status: { tape: now } }) => {
    playing.hidden = !now;
    if (!now) return;
    name.textContent = now.name || "scenario";
    at.textContent = `scan ${now.at} of ${now.scans}`;
    bar.value = now.at / now.scans;
  });
  return playing;
}

/** Goes to the scan of the first difference: back where it was passed, else on until it comes. */
export async function toDifference(app) {
  const { pair, scans } = app.live.status;
  if (pair.first) {
    if (scans > pair.first.scan) await app.back(scans - pair.first.scan);
    return;
  }
  if (!pair.stop_at_difference && !(await control({ do: "stop-at-difference", on: true }))) return;
  await control({ do: "run", speed: null });
}
