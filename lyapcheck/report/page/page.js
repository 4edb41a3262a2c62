"use strict";
// Comfort only: everything on the page is there without it.
(() => {
  const root = document.documentElement;
  root.classList.add("scripted");
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const byId = (id) => document.getElementById(id);

  // Whoever follows a link to a claim finds it open.
  const reveal = () => {
    let name = "";
    try { name = decodeURIComponent(location.hash.slice(1)); } catch { return; }
    const chosen = byId(name);
    if (!chosen) return;
    if (chosen.matches("input[name=m]")) { chosen.checked = true; byId("claims").scrollIntoView(); return; }
    for (let up = chosen; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
    const own = chosen.querySelector("details.more");
    if (own) own.open = true;
    chosen.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  if (location.hash) reveal();

  // Filters.
  const find = byId("find"), shown = byId("shown");
  const selects = ["verdict", "grade"].map((name) => [name, byId(`by-${name}`)]);
  const rows = all("table.claims tbody tr");
  const filter = () => {
    const words = find.value.trim().toLowerCase();
    let count = 0;
    for (const row of rows) {
      const fits = selects.every(([name, select]) => !select.value || row.dataset[name].split(/[ ,]+/).includes(select.value));
      row.hidden = !(fits && (!words || row.textContent.toLowerCase().includes(words)));
      count += !row.hidden;
    }
    const narrowed = count < rows.length;
    for (const group of all("details.group")) {
      const any = all("tbody tr", group).some((row) => !row.hidden);
      group.hidden = !any;
      if (narrowed && any) group.open = true;
    }
    shown.value = narrowed ? `${count} of ${rows.length} claims` : `${rows.length} claims`;
  };
  if (find) {
    find.addEventListener("input", filter);
    selects.forEach(([, select]) => select.addEventListener("input", filter));
    filter();
  }

  // Sorting by a column, up, down, and back to the order of the text.
  for (const table of all("table.claims")) {
    const body = table.tBodies[0], order = [...body.rows];
    const buttons = all("button.sort", table);
    buttons.forEach((button, column) => button.addEventListener("click", () => {
      const next = { ascending: "descending", descending: "" }[button.getAttribute("aria-sort")] ?? "ascending";
      buttons.forEach((other) => other.removeAttribute("aria-sort"));
      const key = (row) => row.cells[column].textContent;
      const sorted = next ? [...order].sort((a, b) => key(a).localeCompare(key(b), "en", { numeric: true })) : order;
      if (next) button.setAttribute("aria-sort", next);
      if (next === "descending") sorted.reverse();
      body.append(...sorted);
    }));
  }

  // The graph shows what a claim rests on while it is pointed at; of a refuted one, what falls with it.
  for (const graph of all(".claim-graph")) {
    const edges = all(".edge", graph), boxes = all(".box", graph);
    const light = (name) => {
      const on = new Set([name]);
      const falls = boxes.some((box) => box.dataset.claim === name && box.classList.contains("refuted"));
      const [to, from] = falls ? ["from", "to"] : ["to", "from"];
      for (let size = 0; size !== on.size;) {
        size = on.size;
        edges.forEach((edge) => on.has(edge.dataset[to]) && on.add(edge.dataset[from]));
      }
      graph.classList.toggle("lit", Boolean(name));
      graph.classList.toggle("falls", falls);
      edges.forEach((edge) => edge.classList.toggle("on", on.has(edge.dataset[to])));
      boxes.forEach((box) => box.classList.toggle("on", on.has(box.dataset.claim)));
    };
    for (const box of boxes) {
      for (const event of ["pointerenter", "focus"]) box.addEventListener(event, () => light(box.dataset.claim));
      for (const event of ["pointerleave", "blur"]) box.addEventListener(event, () => light(""));
    }
  }
})();
