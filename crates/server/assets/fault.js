// Why the controller has stopped: the fault, the rung it stands at, and how to go on.

import { control, get, tell } from "./api.js";
import { button, el } from "./dom.js";
import { Rung } from "./rung.js";

/** The view of the fault; it follows what happens. */
export function fault(app, view) {
  const place = el("section", { class: "rung rung-place", ariaLabel: "Rung of the fault" });
  const about = el("div");
  view.replaceChildren(el("h2", {}, "Fault"), about);
  let last = "";
  let rung = null;

  const mode = (name) => control({ do: "mode", mode: name });
  const ways = () => (app.readOnly ? [] : [
    el("h3", {}, "How to go on"),
    el("div", { class: "ways" }, [
      [button("One scan back", "The scan before the fault", () => app.back(1), { id: "fault-back" }), "Look at the values before the fault, change one, and scan again. A simulation can go back; the controller cannot."],
      [button("Clear and run", "Clear the fault and enter run mode", () => mode("run"), { id: "fault-run" }), "Clears the fault and enters run mode with the data as it stands. It comes back if its cause is still there."],
      [button("Program mode", "Leave run mode", () => mode("program"), { id: "fault-program" }), "Outputs stay off. The fault is cleared when run mode is entered."],
      [button("Begin again", "Data of the project, program mode, no forces", () => control({ do: "restart" }), { id: "fault-restart" }), "Data of the project, no forces, no fault."],
    ].map(([does, text]) => el("p", {}, does, el("span", {}, text)))),
  ]);

  async function show(status) {
    rung = null;
    app.live.see("fault", null);
    if (!status.fault) {
      about.replaceChildren(el("p", {}, "The controller has no fault."));
      return;
    }
    const site = status.fault_site;
    const fact = (name, ...value) => [el("dt", {}, name), el("dd", {}, ...value)];
    about.replaceChildren(
      el("p", { class: "fault-title" }, status.fault),
      el("dl", { class: "facts" },
        status.fault_code ? fact("Code (S:6)", `${status.fault_code}h`) : [],
        fact("Where", site ? button(`${app.routineName(site[0])} rung ${site[1]}`, "Go to the rung", () => app.goto(site[0], site[1]), { class: "link" }) : "no rung is known for it"),
        status.advice ? fact("What to look at", status.advice) : []),
      site ? el("h3", {}, "The rung, with its values now") : "", site ? place : "", ...ways());
    if (!site) return;
    try {
      const [one] = await get(`/api/routines/${site[0]}/rungs?from=${site[1]}&count=1&width=${view.clientWidth < 800 ? 60 : 100}`);
      if (!one) return;
      rung = new Rung(app, site[0], one, place);
      rung.paint();
      app.live.see("fault", { rungs: [rung.place], values: rung.values });
    } catch (problem) {
      tell(problem.message, "wrong");
    }
  }

  const stop = app.live.listen((_, live) => {
    const now = JSON.stringify([live.status.fault, live.status.fault_site]);
    if (now !== last) {
      last = now;
      show(live.status);
    }
    rung?.paint();
  });
  return () => {
    stop();
    app.live.see("fault", null);
  };
}
