// Steps between changes. The page is whole without it.
(() => {
  "use strict";
  const root = document.documentElement;
  root.dataset.script = "";
  const one = (selector, from = document) => from.querySelector(selector);
  one("#theme").addEventListener("click", turnTheme);

  const where = one("#where");
  const stops = [...document.querySelectorAll(".change")];
  let at = -1;
  const tell = () => { if (where) where.textContent = stops.length ? `${at < 0 ? "\u2013" : at + 1} / ${stops.length}` : "no change"; };
  const go = (next) => {
    if (!stops.length) return;
    stops[at]?.classList.remove("at");
    at = Math.min(Math.max(next, 0), stops.length - 1);
    const stop = stops[at];
    for (let fold = stop.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    stop.classList.add("at");
    const show = () => stop.scrollIntoView({ block: stop.offsetHeight > innerHeight * .7 ? "start" : "center" });
    show();
    // Heights of what was never drawn are estimates.
    requestAnimationFrame(show);
    tell();
  };
  // A link to a place that is folded away must show it.
  const arrive = () => {
    const place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!place) return;
    for (let fold = place.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    place.scrollIntoView({ block: "start" });
    const index = stops.indexOf(place);
    if (index >= 0) { stops[at]?.classList.remove("at"); at = index; tell(); }
  };
  addEventListener("hashchange", arrive);
  const fold = () => {
    const all = [...document.querySelectorAll(".same")], open = !all.some((one) => one.open);
    for (const one of all) one.open = open;
  };
  one("#on")?.addEventListener("click", () => go(at + 1));
  one("#back")?.addEventListener("click", () => go(at - 1));
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const act = { n: () => go(at + 1), p: () => go(at - 1), t: turnTheme, u: fold }[event.key];
    if (act) { act(); event.preventDefault(); }
  });
  tell();
  if (location.hash) arrive();
})();
