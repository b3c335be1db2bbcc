// The theme of a page: what the reader chose last, else what the system says. Gives what turns it.
const turnTheme = (() => {
  "use strict";
  const root = document.documentElement;
  const stored = (value) => {
    // A page opened as a file may have no storage.
    try {
      if (value !== undefined) localStorage.setItem("rungs-theme", value);
      return localStorage.getItem("rungs-theme");
    } catch { return null; }
  };
  const theme = stored();
  if (theme === "dark" || theme === "light") root.dataset.theme = theme;
  return () => {
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    stored(root.dataset.theme);
  };
})();
