"use strict";
// Comfort only: everything on the page is there without it. Whoever follows a link to a claim finds it open.
(() => {
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
})();
