"use strict";
// Comfort only: everything on the page is there without it. Whoever follows a link to a claim finds it open.
(() => {
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const reveal = () => {
    let name = "";
    try { name = decodeURIComponent(location.hash.slice(1)); } catch { return; }
    const chosen = document.getElementById(name);
    if (!chosen) return;
    for (let up = chosen; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
    const own = chosen.querySelector("details.more");
    if (own) own.open = true;
    chosen.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  if (location.hash) reveal();

  // The graph shows what a claim rests on while it is pointed at; of a refuted one, what falls with it.
  // A finger cannot point without a tap: the first tap shows this, the second follows the link.
  for (const graph of all(".claim-graph")) {
    const edges = all(".edge", graph), boxes = all(".box", graph);
    let tapped = "";
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
      const name = box.dataset.claim, mouse = (event) => event.pointerType !== "touch";
      box.addEventListener("pointerenter", (event) => mouse(event) && light(name));
      box.addEventListener("pointerleave", (event) => mouse(event) && light(""));
      box.addEventListener("focus", () => light(name));
      box.addEventListener("blur", () => light(tapped = ""));
      box.addEventListener("click", (event) => {
        if (mouse(event) || tapped === name) return;
        event.preventDefault();
        light(tapped = name);
      });
    }
  }
})();
