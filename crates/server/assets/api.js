// Requests to the server, and the live connection.

import { byId, el } from "./dom.js";

/** Shows a sentence for some seconds; problems stay until they are clicked away. */
export function tell(text, kind = "note") {
  const close = () => note.remove();
  const note = el("p", { class: `banner ${kind}`, on: { click: close }, title: "Click to dismiss" }, text);
  byId("banners").append(note);
  if (kind === "note") setTimeout(close, 6000);
  while (byId("banners").querySelectorAll(".wrong").length > 3) byId("banners").querySelector(".wrong").remove();
}

async function request(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch {
    throw new Error("The server does not answer. Is `rungs serve` still running?");
  }
  const body = await response.json().catch(() => ({}));
  if (!response.ok) throw new Error(body.error ?? `the server answered ${response.status}`);
  return body;
}

/** Asks for something. */
export const get = (path) => request(path, {});

/** Has something done. Problems are shown; answers what was done, or nothing. */
export async function post(path, body) {
  try {
    return await request(path, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
  } catch (problem) {
    tell(problem.message, "wrong");
    return null;
  }
}

export const control = (body) => post("/api/control", body);

/**
 * The live connection. What a page shows is said with `see`; listeners get what changed. It comes back by itself when
 * it was lost, and says again what is shown.
 */
export class Live {
  #socket = null;
  #sources = new Map();
  #listeners = new Set();
  #queued = false;
  #wait = 250;
  /** Called when the server was started again: its state is a new one. */
  restarted = () => {};
  /** What was told last. */
  status = null;
  rungs = new Map();
  values = new Map();
  /** Of two programs side by side: power flow of the other one, and the values of both by row. */
  otherRungs = new Map();
  rows = new Map();

  constructor() {
    this.#connect();
  }

  #connect() {
    const socket = new WebSocket(`ws://${location.host}/api/live`);
    this.#socket = socket;
    socket.onopen = () => {
      this.#wait = 250;
      document.body.classList.remove("offline");
      this.#send();
    };
    socket.onmessage = (event) => this.#told(JSON.parse(event.data));
    socket.onclose = () => {
      document.body.classList.add("offline");
      setTimeout(() => this.#connect(), this.#wait);
      this.#wait = Math.min(this.#wait * 2, 5000);
    };
  }

  #told(news) {
    if (this.status && this.status.server !== news.status.server) {
      // What was told before was another run.
      this.rungs.clear();
      this.values.clear();
      this.restarted();
    }
    this.status = news.status;
    for (const [rung, bits] of Object.entries(news.rungs ?? {})) this.rungs.set(rung, bits);
    for (const [address, value] of Object.entries(news.values ?? {})) this.values.set(address, value);
    for (const [rung, bits] of Object.entries(news.other_rungs ?? {})) this.otherRungs.set(rung, bits);
    for (const [row, values] of Object.entries(news.rows ?? {})) this.rows.set(Number(row), values);
    for (const listener of this.#listeners) listener(news, this);
  }

  /** Calls `listener(news, live)` with everything told from now on; answers how to stop that. */
  listen(listener) {
    this.#listeners.add(listener);
    if (this.status) listener({ status: this.status, rungs: {}, values: {} }, this);
    return () => this.#listeners.delete(listener);
  }

  /**
   * Says what a part of the page shows: rungs as [routine, rung], addresses; of two programs rungs of the other one and
   * rows. Nothing shown: `null`.
   */
  see(part, shown) {
    if (shown) this.#sources.set(part, shown);
    else this.#sources.delete(part);
    if (this.#queued) return;
    this.#queued = true;
    queueMicrotask(() => this.#send());
  }

  #send() {
    this.#queued = false;
    if (this.#socket.readyState !== WebSocket.OPEN) return;
    const rungs = new Map();
    const values = new Set();
    const others = new Map();
    const rows = new Set();
    for (const shown of this.#sources.values()) {
      for (const rung of shown.rungs ?? []) rungs.set(rung.join(":"), rung);
      for (const address of shown.values ?? []) values.add(address);
      for (const rung of shown.otherRungs ?? []) others.set(rung.join(":"), rung);
      for (const row of shown.rows ?? []) rows.add(row);
    }
    // The server refuses more; what is beyond is not on the screen.
    const see = { rungs: [...rungs.values()].slice(0, 500), values: [...values].slice(0, 5000) };
    if (others.size) see.other_rungs = [...others.values()].slice(0, 500);
    if (rows.size) see.rows = [...rows].slice(0, 5000);
    this.#socket.send(JSON.stringify(see));
  }
}
