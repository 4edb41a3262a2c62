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
})();
