// Search, keyboard and folding of a report. The page is whole without it.
(() => {
  "use strict";
  const root = document.documentElement;
  root.dataset.script = "";
  const one = (selector, from = document) => from.querySelector(selector);
  const box = one("#search"), found = one("#found"), list = one("#found ol"), count = one("#found p");
  const main = one("main"), help = one("#help");
  const SHOWN = 100;

  // ---- Index -------------------------------------------------------------------------------------
  // Made from the page itself when it is first needed, so that nothing stands in the file twice.
  let index = null;
  const address = (link) => link.getAttribute("href").slice(3)
    .replace(/~([0-9A-F]{2})/g, (_, hex) => String.fromCharCode(parseInt(hex, 16)));
  const texts = (element) => {
    const parts = [];
    const walk = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const text = walk.currentNode.nodeValue.trim();
      if (text) parts.push(text);
    }
    return parts.join(" ");
  };
  const build = () => {
    index = [];
    let number = 0;
    for (const section of main.querySelectorAll("section")) {
      const where = section.dataset.short;
      for (const item of section.querySelectorAll(".g, .r, tbody tr, dl > div, .tree li > span, .note, h3")) {
        const group = item.closest(".g");
        if (group && group !== item) continue;
        let name, text;
        if (item.matches(".g")) {
          const head = one("p", item);
          name = one("b", head).textContent;
          text = texts(head);
        } else if (item.matches(".r")) {
          name = item.dataset.rung;
          const inside = new Set();
          for (const link of item.querySelectorAll("a")) if (link.getAttribute("href")?.startsWith("#x-")) inside.add(address(link));
          text = `${texts(item)} ${[...inside].join(" ")}`;
        } else if (item.matches("tr")) {
          name = item.cells[0]?.textContent ?? "";
          text = texts(item);
        } else if (item.matches("div")) {
          name = one("dt", item).textContent;
          text = texts(item);
        } else {
          name = "";
          text = item.textContent;
        }
        // The same number in the same page every time: a link with it can be kept.
        if (!item.id) item.id = `q${number}`;
        number += 1;
        index.push({ item, where, name, text, low: text.toLowerCase(), key: name.toLowerCase(), group: item.matches(".g") });
      }
    }
    return index;
  };

  // ---- Search ------------------------------------------------------------------------------------
  // People leave out word 0 of a slot: I:1/3 is I:1.0/3.
  const forms = (word) => {
    const long = word.replace(/^([io]:\d+)(?=\/|$)/, "$1.0");
    return long === word ? [word] : [word, long];
  };
  const rank = (entry, whole) => {
    if (entry.key === whole) return entry.group ? 0 : 2;
    // A symbol is the second thing said of an address.
    if (entry.group && entry.low.split(" ")[1] === whole) return 1;
    if (entry.key.startsWith(whole)) return entry.group ? 3 : 4;
    return entry.group ? 5 : 6;
  };
  const search = (query) => {
    const words = query.toLowerCase().split(/\s+/).filter(Boolean);
    if (!words.length) return [];
    const wanted = words.map(forms), whole = wanted.map((all) => all.at(-1)).join(" ");
    const hits = [];
    (index ?? build()).forEach((entry, at) => {
      if (wanted.every((all) => all.some((word) => entry.low.includes(word) || entry.key.includes(word)))) {
        hits.push({ entry, at, rank: rank(entry, whole) });
      }
    });
    return hits.sort((a, b) => a.rank - b.rank || a.at - b.at).map((hit) => hit.entry);
  };
  // Texts only ever become text nodes: nothing of a project is taken for marks.
  const marked = (into, text, words) => {
    const low = text.toLowerCase();
    let at = 0;
    while (at < text.length) {
      let next = -1, length = 0;
      for (const word of words) {
        const place = low.indexOf(word, at);
        if (place >= 0 && (next < 0 || place < next)) { next = place; length = word.length; }
      }
      if (next < 0) break;
      into.append(text.slice(at, next));
      const mark = document.createElement("mark");
      mark.textContent = text.slice(next, next + length);
      into.append(mark);
      at = next + length;
    }
    into.append(text.slice(at));
  };
  const excerpt = (entry, words) => {
    const places = words.map((word) => entry.low.indexOf(word)).filter((place) => place >= 0);
    const first = places.length ? Math.min(...places) : 0;
    const from = first > 60 ? first - 30 : 0;
    return (from ? "…" : "") + entry.text.slice(from, from + 200);
  };
  const show = () => {
    const query = box.value.trim();
    list.replaceChildren();
    found.hidden = !query;
    if (!query) return;
    const words = query.toLowerCase().split(/\s+/).filter(Boolean).flatMap(forms);
    const hits = search(query);
    const all = hits.length.toLocaleString("en");
    count.textContent = !hits.length ? "nothing found" : hits.length > SHOWN ? `${all} found, the first ${SHOWN} shown` : `${all} found`;
    hits.slice(0, SHOWN).forEach((entry, at) => {
      const line = document.createElement("li"), link = document.createElement("a");
      const name = document.createElement("b"), text = document.createElement("span"), where = document.createElement("i");
      line.setAttribute("role", "option");
      line.setAttribute("aria-selected", at === 0);
      link.href = `#${entry.item.id}`;
      marked(name, entry.name, words);
      marked(text, excerpt(entry, words), words);
      where.textContent = entry.where;
      link.append(name, text, where);
      line.append(link);
      list.append(line);
    });
  };
  const step = (by) => {
    const lines = [...list.children];
    if (!lines.length) return;
    const at = lines.findIndex((line) => line.getAttribute("aria-selected") === "true");
    const next = Math.min(Math.max(at + by, 0), lines.length - 1);
    lines[at]?.setAttribute("aria-selected", "false");
    lines[next].setAttribute("aria-selected", "true");
    lines[next].scrollIntoView({ block: "nearest" });
  };
  const close = () => { found.hidden = true; };
  let waiting = 0;
  box.addEventListener("input", () => { clearTimeout(waiting); waiting = setTimeout(show, 40); });
  box.addEventListener("focus", () => { if (!index) setTimeout(() => index ?? build(), 0); if (box.value.trim()) found.hidden = false; });
  box.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") { step(event.key === "ArrowDown" ? 1 : -1); event.preventDefault(); }
    if (event.key === "Enter") {
      clearTimeout(waiting);
      if (found.hidden || waiting) show();
      one("[aria-selected=true] a", list)?.click();
      event.preventDefault();
    }
    if (event.key === "Escape") {
      if (found.hidden) { box.value = ""; box.blur(); } else { close(); box.blur(); }
      event.preventDefault();
      event.stopPropagation();
    }
  });
  document.addEventListener("click", (event) => { if (!event.target.closest(".find")) close(); });
  list.addEventListener("click", (event) => { if (event.target.closest("a")) { close(); box.blur(); } });

  // ---- Places ------------------------------------------------------------------------------------
  const arrive = () => {
    close();
    const id = decodeURIComponent(location.hash.slice(1));
    if (!id) return;
    if (/^q\d+$/.test(id) && !index) build();
    const place = document.getElementById(id);
    if (!place) return;
    for (let fold = place.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    const fold = place.matches("section") ? one("details", place) : null;
    if (fold) fold.open = true;
    place.scrollIntoView({ block: "start" });
    // Sizes of what was never drawn are estimates: once more when the neighbours are known.
    requestAnimationFrame(() => {
      const top = place.getBoundingClientRect().top;
      if (top < 0 || top > innerHeight * .6) place.scrollIntoView({ block: "start" });
    });
  };
  addEventListener("hashchange", arrive);
  // A link to where one already is must go there all the same.
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[href^='#']");
    if (link && link.getAttribute("href") === location.hash) arrive();
  });
  // Only what stands in the section in sight is measured: to measure what is out of sight, it would have to
  // be laid out.
  const leap = (by) => {
    const top = (stop) => stop.getBoundingClientRect().top - 90;
    const stops = (section) => !section ? [] : one("details", section).open ? [section, ...section.querySelectorAll(".r")] : [section];
    const sections = [...main.querySelectorAll("section")];
    const at = sections.findLastIndex((section) => top(section) <= 2);
    const next = by > 0
      ? [...stops(sections[at]), sections[at + 1]].find((stop) => stop && top(stop) > 2)
      : stops(sections[at]).findLast((stop) => top(stop) < -2) ?? stops(sections[at - 1]).at(-1);
    if (!next) return;
    one(".here")?.classList.remove("here");
    if (next.matches(".r")) next.classList.add("here");
    scrollBy({ top: top(next) });
  };
  const folds = () => main.querySelectorAll("section > details");
  const foldAll = () => {
    const open = ![...folds()].some((fold) => fold.open);
    for (const fold of folds()) fold.open = open;
  };
  let closedBefore = [];
  addEventListener("beforeprint", () => {
    closedBefore = [...folds()].filter((fold) => !fold.open);
    for (const fold of closedBefore) fold.open = true;
  });
  addEventListener("afterprint", () => { for (const fold of closedBefore) fold.open = false; });

  // ---- Keyboard ----------------------------------------------------------------------------------
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, textarea, select")) return;
    if (help.open) { if (event.key === "?") { help.close(); event.preventDefault(); } return; }
    const act = {
      "/": () => { box.focus(); box.select(); },
      "j": () => leap(1), "k": () => leap(-1),
      "c": foldAll, "t": turnTheme, "?": () => help.showModal(),
      "Escape": close,
    }[event.key];
    if (act) { act(); event.preventDefault(); }
  });
  one("#theme").addEventListener("click", turnTheme);
  one("#fold").addEventListener("click", foldAll);
  one("#keys").addEventListener("click", () => help.showModal());
  if (location.hash) arrive();
})();
