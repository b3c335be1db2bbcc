// The theme of the page: light, dark or what the system says. Not a module, so that the page is never painted in the
// wrong one; reports keep the choice under the same name.
"use strict";
globalThis.rungsTheme = (() => {
  const root = document.documentElement;
  const show = (theme) => {
    if (theme === "light" || theme === "dark") root.dataset.theme = theme;
    else delete root.dataset.theme;
    dispatchEvent(new Event("themechange"));
  };
  // A browser can be told to keep nothing.
  const stored = () => {
    try {
      return localStorage.getItem("rungs-theme") ?? "system";
    } catch {
      return root.dataset.theme ?? "system";
    }
  };
  const choose = (theme) => {
    try {
      if (theme === "system") localStorage.removeItem("rungs-theme");
      else localStorage.setItem("rungs-theme", theme);
    } catch { /* It holds until the page is left. */ }
    show(theme);
  };
  show(stored());
  addEventListener("storage", (event) => event.key === "rungs-theme" && show(stored()));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => dispatchEvent(new Event("themechange")));
  // Paper is white, drawings on canvases included.
  addEventListener("beforeprint", () => show("light"));
  addEventListener("afterprint", () => show(stored()));
  return { chosen: stored, choose };
})();
