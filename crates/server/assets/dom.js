// Small helpers for building pages. Texts are always set as text, never as markup.

/** An element with properties and children; `on` holds listeners, `data` data attributes. */
export function el(name, properties = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (key === "on") for (const [event, listener] of Object.entries(value)) node.addEventListener(event, listener);
    else if (key === "data") for (const [name, text] of Object.entries(value)) node.dataset[name] = text;
    else if (key === "class") node.className = value;
    else if (key in node && key !== "list" && key !== "form") node[key] = value;
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

/** A button that does something. */
export const button = (text, title, click, more = {}) =>
  el("button", { type: "button", title, on: { click }, ...more }, text);

/** The one element with this id. */
export const byId = (id) => document.getElementById(id);

/** A drawing that the server made, as an element. Nothing in it runs: it is read in a document of its own. */
export function drawing(text) {
  const svg = new DOMParser().parseFromString(text, "text/html").querySelector("svg");
  return svg ? document.importNode(svg, true) : el("p", { class: "wrong" }, "This rung could not be drawn.");
}

/** Seconds as a person reads them. */
export function time(seconds) {
  const whole = Math.floor(seconds);
  const part = (seconds - whole).toFixed(3).slice(1);
  const pad = (number) => String(number).padStart(2, "0");
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  return h ? `${h}:${pad(m)}:${pad(s)}${part}` : `${m}:${pad(s)}${part}`;
}

/** A colour of the style sheet as canvases take it: what the theme makes of it. */
export function colour(name) {
  const probe = byId("probe");
  probe.style.color = `var(${name})`;
  return getComputedStyle(probe).color;
}
