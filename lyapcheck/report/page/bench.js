"use strict";
// Gains to try. Floating point, decides nothing: the gate and the certificates do.
(() => {
  const form = document.getElementById("sliders"), source = document.getElementById("bench");
  if (!form || !source) return;
  const arm = JSON.parse(source.textContent), n = arm.joints.length;
  if (!n) return;
  const SVG = "http://www.w3.org/2000/svg";
  const COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7f7f7f"];
  const first = arm.sets[0] ?? { m: 1, kp: Array(n).fill(10), kv: Array(n).fill(1) };
  const state = { m: first.m, kp: [...first.kp], kv: [...first.kv], friction: 1, posture: 0 };

  const h = (m, x) => {
    const s = Math.abs(Math.sinh(Math.max(-30, Math.min(30, x))));
    if (m === 1 || s > 1e8) return m === 1 ? Math.tanh(x) : Math.sign(x);
    return Math.sign(x) * (s ** (2 * m - 1) * Math.cosh(x)) / (1 + s ** (2 * m));
  };
  const short = (x) => (Math.abs(x) >= 1e5 || (x && Math.abs(x) < 1e-3) ? x.toExponential(2) : String(+x.toPrecision(4)));

  // The form: a slider and a number for each gain.
  const inputs = [];
  const slider = (label, get, set, low, high, logarithmic) => {
    const box = document.createElement("label"), range = document.createElement("input"), value = document.createElement("output");
    Object.assign(range, { type: "range", min: 0, max: 1000, step: 1 });
    range.setAttribute("aria-label", label);
    const to = (k) => (logarithmic ? low * (high / low) ** (k / 1000) : low + ((high - low) * k) / 1000);
    const from = (x) => (logarithmic ? 1000 * Math.log(x / low) / Math.log(high / low) : 1000 * (x - low) / (high - low));
    const show = () => { value.value = short(get()); range.setAttribute("aria-valuetext", value.value); };
    range.addEventListener("input", () => { set(+to(+range.value).toPrecision(3)); show(); draw(); });
    inputs.push(() => { range.value = from(get()); show(); });
    box.append(label, value, range);
    form.append(box);
  };
  if (arm.sets.length) {
    const box = document.createElement("label"), choice = document.createElement("select");
    choice.id = "start-from";
    arm.sets.forEach((set, k) => choice.add(new Option(set.name, k)));
    choice.addEventListener("input", () => {
      const { m, kp, kv } = arm.sets[choice.value];
      Object.assign(state, { m, kp: [...kp], kv: [...kv] });
      refresh();
    });
    box.append("start from", choice);
    form.append(box);
  }
  slider("m", () => state.m, (x) => { state.m = Math.round(x); }, 1, arm.gamma.length);
  arm.joints.forEach((joint, i) => {
    slider(`k_p ${joint} [N·m]`, () => state.kp[i], (x) => { state.kp[i] = x; }, 0.1, 200, true);
    slider(`k_v ${joint} [N·m]`, () => state.kv[i], (x) => { state.kv[i] = x; }, 0.01, 50, true);
  });
  slider("friction, share of nominal", () => state.friction, (x) => { state.friction = x; }, 0.1, 3);
  slider("posture, all joints at [rad]", () => state.posture, (x) => { state.posture = x; }, 0, Math.PI);
  const copy = document.createElement("button");
  Object.assign(copy, { type: "button", className: "act", id: "copy-gains", textContent: "Copy the gain file" });
  copy.addEventListener("click", async () => {
    const text = gainFile();
    file.textContent = text;
    file.hidden = false;
    try { await navigator.clipboard.writeText(text); copy.textContent = "Copied"; } catch { copy.textContent = "Select and copy below"; }
  });
  const file = document.createElement("pre");
  file.id = "gain-file";
  file.hidden = true;
  form.append(copy, file);
  const gainFile = () => [
    `robot = ${JSON.stringify(arm.robot)}`, "", "[[gains]]", 'name = "mine"', `m = ${state.m}`,
    `kp = [${state.kp.map(short).join(", ")}]  # N·m`, `kv = [${state.kv.map(short).join(", ")}]  # N·m`, "",
  ].join("\n");

  // Drawing.
  const mark = (name, attributes, text) => {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const frame = (name, xs, ys) => {
    const svg = document.getElementById(`plot-${name}`);
    svg.replaceChildren();
    const [x0, x1] = xs, [y0, y1] = ys;
    const at = (x, y) => [36 + (276 * (x - x0)) / (x1 - x0), 168 - (156 * (y - y0)) / (y1 - y0 || 1)];
    for (let k = 0; k <= 4; k++) {
      const y = y0 + ((y1 - y0) * k) / 4, x = x0 + ((x1 - x0) * k) / 4;
      svg.append(mark("line", { x1: 36, x2: 312, y1: at(x0, y)[1], y2: at(x0, y)[1], stroke: "var(--grid)" }));
      svg.append(mark("text", { x: 33, y: at(x0, y)[1] + 3, "text-anchor": "end" }, short(+y.toPrecision(3))));
      svg.append(mark("text", { x: at(x, y0)[0], y: 182, "text-anchor": "middle" }, short(+x.toPrecision(3))));
    }
    const line = (points, colour, dashed) => svg.append(mark("polyline", {
      points: points.map(([x, y]) => at(x, Math.max(y0, Math.min(y1, y))).map((c) => c.toFixed(1)).join(",")).join(" "),
      fill: "none", stroke: colour, "stroke-width": 1.8, "stroke-dasharray": dashed ? "5 4" : "",
    }));
    const words = (k, text, colour) => svg.append(mark("text", { x: 306, y: 20 + 12 * k, "text-anchor": "end", style: `fill:${colour}` }, text));
    return { svg, at, line, words };
  };
  const bars = (name, values, limits) => {
    const svg = document.getElementById(`plot-${name}`);
    svg.replaceChildren();
    const room = Math.max(44, 170 / n), high = Math.min(26, room - 26);
    svg.setAttribute("viewBox", `0 0 320 ${Math.max(190, 14 + room * n)}`);
    values.forEach((value, i) => {
      const y = 14 + room * i, limit = limits[i], share = limit > 0 ? value / limit : Infinity, good = share < 1;
      const said = limit === null ? "no limit known" : `${good ? "✓" : "✗"} ${short(value)} of ${short(limit)}`;
      svg.append(mark("text", { x: 8, y: y + 10 }, `${arm.joints[i]}: ${said}`));
      if (limit === null) return;
      const colour = good ? "var(--good)" : "var(--bad)";
      svg.append(mark("rect", { x: 8, y: y + 18, width: Math.min(300, 220 * share), height: high, fill: colour, opacity: 0.75 }));
      svg.append(mark("line", { x1: 228, x2: 228, y1: y + 14, y2: y + high + 22, stroke: "currentColor", "stroke-width": 2 }));
    });
  };

  const massAt = (i) => {
    const places = arm.posture, last = places.length - 1;
    const k = Math.min(last - 1, Math.floor((state.posture / places[last]) * last));
    const t = (state.posture - places[k]) / (places[k + 1] - places[k]);
    return arm.mass[k][i] * (1 - t) + arm.mass[k + 1][i] * t;
  };
  const run = (i) => {
    const inertia = massAt(i), b = arm.viscous[i] * state.friction, dt = 1e-3, found = [];
    const push = (e, w) => state.kp[i] * h(state.m, e) - state.kv[i] * h(state.m, w);
    const rate = ([e, w]) => [-w, (push(e, w) - b * w) / inertia];
    let now = [arm.goal[i], 0];
    for (let k = 0; k <= 3000; k++) {
      if (k % 10 === 0) found.push([k * dt, now[0] / arm.goal[i], Math.abs(push(...now))]);
      const step = (from, by) => [now[0] + by * from[0], now[1] + by * from[1]];
      const a = rate(now), c = rate(step(a, dt / 2)), d = rate(step(c, dt / 2)), f = rate(step(d, dt));
      now = now.map((x, j) => x + (dt / 6) * (a[j] + 2 * c[j] + 2 * d[j] + f[j]));
      if (!now.every(Number.isFinite)) break;
    }
    return found;
  };

  function draw() {
    const gamma = arm.gamma[state.m - 1], root = Math.sqrt(n), xs = Array.from({ length: 161 }, (_, k) => -4 + k / 20);
    const curve = frame("h", [-4, 4], [-1.5, 1.5]);
    curve.line(xs.map((x) => [x, h(state.m, x)]), COLOURS[0]);
    curve.line([[-4, gamma], [4, gamma]], "var(--quiet)", true);
    curve.words(0, `m = ${state.m}, γ = ${short(gamma)}`, "currentColor");
    bars("tau", state.kp.map((k, i) => k + state.kv[i]), arm.torque.map((most, i) => (most === null ? null : (most - arm.gravity[i]) / (root * gamma))));
    const least = Math.min(...arm.viscous) * state.friction;
    bars("damping", state.kv, state.kv.map(() => least / (root * gamma)));
    const runs = arm.joints.map((_, i) => run(i));
    const steps = frame("step", [0, 3], [-1, 1]);
    const shares = frame("share", [0, 3], [0, 1.2]);
    shares.line([[0, 1], [3, 1]], "var(--bad)", true);
    runs.forEach((points, i) => {
      const colour = COLOURS[i % COLOURS.length];
      steps.line(points.map(([t, e]) => [t, e]), colour);
      steps.words(i, arm.joints[i], colour);
      if (arm.torque[i] === null) return;
      shares.line(points.map(([t, , tau]) => [t, (tau + arm.gravity[i]) / arm.torque[i]]), colour);
      shares.words(i, arm.joints[i], colour);
    });
    const words = document.createElement("ul");
    arm.joints.forEach((joint, i) => {
      const line = document.createElement("li"), b = arm.viscous[i] * state.friction, inertia = massAt(i);
      const slope = state.m === 1 ? 1 : 0;
      const damping = (b + state.kv[i] * slope) / (2 * Math.sqrt(state.kp[i] * inertia));
      line.textContent = slope
        ? `${joint}: inertia ${short(inertia)} kg·m², damping ratio ${short(damping)}`
        : `${joint}: inertia ${short(inertia)} kg·m²; h′(0) = 0, so that near the goal only friction damps and k_p and k_v fade`;
      words.append(line);
    });
    document.getElementById("plot-words").replaceChildren(words);
  }
  const refresh = () => { inputs.forEach((show) => show()); draw(); };
  refresh();
})();
