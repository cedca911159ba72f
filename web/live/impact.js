/* impact.js - the page of the impact: choices, the worker's frames on a canvas, curves, verdict.
   SPDX-License-Identifier: MIT */
"use strict";

/* What points are coloured by: their place in a frame, the colour map, its range, and the words of the bar. */
const LIVE_COLOURS = {
  strain: { at: 3, map: 0, range: () => [0, 4], what: "plastic strain", unit: "" },
  temperature: { at: 4, map: 1, range: (s) => [s.cold, s.hot], what: "temperature", unit: "K" },
  pressure: { at: 5, map: 2, range: (s) => [-s.pressure, s.pressure], what: "pressure", unit: "GPa" },
  velocity: { at: 6, map: 2, range: (s) => [-s.speed, s.speed], what: "velocity", unit: "along z, m/s" },
  bond: { at: 7, map: 0, range: () => [0, 1], what: "bond D", unit: "" },
};

/* The table's words, as build/impact says them. */
const LIVE_SAID = {
  nodes: "PBCP: of the surface that touched the other body, the part whose bond variable D is 1 or more. ABP: D " +
    "of that surface on the mean. Held: pairs of nodes that the bond kept from parting in the last step.",
  surface: "Bonded: of the area that touched, the part with adhesion that is not spent. Held: markers that " +
    "adhesion drew to the other surface in the last step.",
};

function liveImpact(worker) {
  const find = (id) => document.getElementById(id);
  const form = find("choices"), input = form.elements, canvas = find("stage");
  let ready, begun = false, wanted = false, running = false, finished = false; // begun: the worker has this choice
  let number = 0; // of the run: what the worker says of an earlier one comes too late
  let scale, frame, colors, samples = [], waiting = false, metals;
  const panels = [
    livePanel("Mean velocity of the particle", "m/s", [{ name: "along z", key: "velocity" }]),
    livePanel("Energy", "% of that of the impact", [["kinetic", "kinetic"], ["plastic work", "plastic"],
      ["elastic", "elastic"], ["dampers", "dampers"], ["contact", "contact"], ["bond", "bond"]]
      .map(([name, key]) => ({ name, key, scale: 100 }))),
    livePanel("Area of the particle", "µm²", [{ name: "touched", key: "area" }, { name: "bonded", key: "bonded" }]),
  ];
  find("panels").append(...panels.map((panel) => panel.element));

  // ---- choices

  const choice = () => ({ material: input.material.value, substrate: input.substrate.value, model: input.model.value,
    diameter: Number(input.diameter.value), velocity: Number(input.velocity.value), contact: input.contact.value,
    bond: input.bond.value, grid: Number(input.grid.value) });

  function options(select, rows) {
    const before = select.value;
    select.replaceChildren(...rows.map(([value, words]) => html("option", { value }, words)));
    if (rows.some(([value]) => value === before)) select.value = before;
  }

  /* Bonds and grids of this contact; strengths that both metals have. */
  function offer() {
    const c = choice(), metal = (name) => metals.find((one) => one.name === name);
    const both = [metal(c.material), metal(c.substrate || c.material)];
    const models = both[0].models.filter((model) => both[1].models.includes(model));
    const own = both[0].own === both[1].own ? both[0].own : both.map((one) => one.own).join(" and ");
    options(input.model, [["preset", `its own (${own})`], ...models.map((model) => [model, model])]);
    options(input.bond, LIVE_BONDS[c.contact]);
    options(input.grid, LIVE_GRIDS[c.contact].map((grid, i) =>
      [String(i), grid.words + (grid.usual ? ", as build/impact" : "")]));
  }

  function title(c) {
    const on = c.substrate && c.substrate !== c.material ? ` on ${c.substrate}` : "";
    return `${c.material}${on}, ${c.diameter} µm at ${c.velocity} m/s`;
  }

  /* The choice has changed: the next run begins with it. */
  function changed() {
    offer();
    find("adheres").hidden = input.contact.value !== "surface" || input.bond.value === "none";
    find("command").textContent = "build/impact " + liveWords(choice()).join(" ");
    begun = wanted = false;
    if (form.checkValidity()) restart();
    else buttons();
  }

  function restart() {
    find("fault").hidden = true;
    headline("Does it bond?", "", "A metal particle hits a plate. Choose, run, and see: the C library computes it " +
      "here, in your browser, as it does on the desktop.");
    find("outcome").hidden = true;
    samples = [];
    running = finished = false;
    worker.postMessage({ kind: "begin", words: liveWords(choice()), number: ++number });
  }

  function headline(words, mood, lead) {
    find("headline").textContent = words;
    find("headline").className = mood;
    find("lead").textContent = lead;
  }

  // ---- the run

  function buttons() {
    find("run").textContent = running ? "Stop" : "Run";
    find("run").disabled = !ready || !form.checkValidity();
    find("step-one").disabled = !begun || finished;
    find("again").disabled = !begun;
  }

  function runOrStop() {
    if (!begun || finished) {
      wanted = true; // as soon as the worker has it
      return restart();
    }
    running = !running;
    worker.postMessage({ kind: running ? "run" : "stop" });
    buttons();
  }

  function stepOne() {
    if (!begun || finished) return;
    running = false;
    worker.postMessage({ kind: "step", steps: 1 });
    buttons();
  }

  find("run").onclick = runOrStop;
  find("step-one").onclick = stepOne;
  find("again").onclick = restart;
  canvas.onkeydown = (event) => {
    const act = { " ": runOrStop, ArrowRight: stepOne }[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act();
  };
  form.onsubmit = (event) => event.preventDefault();
  form.onchange = changed;
  form.oninput = (event) => {
    const of = event.target.dataset.of;
    if (of) input[of].value = event.target.value;
    else if (event.target.type === "number") {
      const slider = form.querySelector(`[data-of="${event.target.name}"]`);
      slider.value = event.target.value;
    }
  };

  // ---- the picture

  const colour = () => LIVE_COLOURS[find("field").value];

  function paintBar() {
    const { map, range, what, unit } = colour(), [low, high] = range(scale);
    const flat = matchMedia("(max-width: 40rem)").matches;
    const stops = colors[map].filter((_, i) => i % 15 === 0).map((c) => `rgb(${c})`);
    const strip = html("span", { class: "colours" });
    strip.style.background = `linear-gradient(to ${flat ? "right" : "top"}, ${stops.join(", ")})`;
    const marks = ticks(low, high, 5).map((at) => {
      const mark = html("span", { class: "tick" }, shown(at, 3)), place = 100 * (at - low) / (high - low) + "%";
      if (flat) mark.style.left = place;
      else mark.style.bottom = place;
      return mark;
    });
    find("bar").replaceChildren(html("div", { class: "what" }, what, html("small", {}, unit)),
      html("div", { class: "scale" }, strip, ...marks));
  }

  /* The canvas at the screen's resolution, and how it maps: x and z in um to pixels. */
  function place() {
    const ratio = devicePixelRatio || 1, wide = canvas.clientWidth;
    const tall = wide * (scale.top - scale.bottom) / 2 / scale.edge;
    canvas.style.height = tall + "px";
    if (canvas.width !== Math.round(wide * ratio) || canvas.height !== Math.round(tall * ratio)) {
      canvas.width = Math.round(wide * ratio);
      canvas.height = Math.round(tall * ratio);
    }
    const per = canvas.width / 2 / scale.edge;
    return { per, x: (x) => canvas.width / 2 + per * x, z: (z) => per * (scale.top - z), ratio };
  }

  /* Points of like colour together: one path each. */
  function paintPoints(pen, at) {
    const { at: field, map, range } = colour(), [low, high] = range(scale), shades = 64;
    const heaps = Array.from({ length: shades }, () => []);
    for (let i = 0; i < frame.points.length; i += 8) {
      const t = (frame.points[i + field] - low) / (high - low);
      heaps[Math.max(0, Math.min(shades - 1, Math.round(t * (shades - 1)))) || 0].push(i);
    }
    const fill = (share, alpha) => heaps.forEach((heap, shade) => {
      const size = share * scale.spacing * at.per, radius = size / 1.8;
      pen.globalAlpha = alpha;
      pen.fillStyle = `rgb(${colors[map][Math.round(shade * 255 / (shades - 1))]})`;
      pen.beginPath();
      for (const i of heap) for (const side of [1, -1]) {
        const x = at.x(side * frame.points[i]), z = at.z(frame.points[i + 1]);
        if (frame.points[i + 2]) pen.rect(x - size / 2, z - size / 2, size, size);
        else pen.moveTo(x + radius, z), pen.arc(x, z, radius, 0, 7);
      }
      pen.fill();
    });
    fill(1.4, 0.45); // what lies between the points
    fill(0.85, 1);
    pen.globalAlpha = 1;
  }

  /* Surfaces thin, and thick where they adhere. */
  function paintLines(pen, at, ink, strong) {
    for (const [holds, color, width] of [[0, ink, 1], [1, ink, 4.5], [1, strong, 2]]) {
      pen.beginPath();
      for (let i = 0; i < frame.lines.length; i += 5) {
        const [x0, z0, x1, z1, held] = frame.lines.subarray(i, i + 5);
        if (held !== holds) continue;
        for (const side of [1, -1]) pen.moveTo(at.x(side * x0), at.z(z0)), pen.lineTo(at.x(side * x1), at.z(z1));
      }
      pen.strokeStyle = color;
      pen.lineWidth = width * at.ratio;
      pen.stroke();
    }
  }

  function paintGrid(pen, at, ink) {
    const cell = choice().diameter / LIVE_GRIDS[input.contact.value][Number(input.grid.value)].cells;
    pen.strokeStyle = ink;
    pen.globalAlpha = 0.35;
    pen.lineWidth = 1;
    pen.beginPath();
    for (let k = 0; k * cell < scale.edge; k++) for (const side of [1, -1])
      pen.moveTo(at.x(side * k * cell), 0), pen.lineTo(at.x(side * k * cell), canvas.height);
    for (let k = Math.ceil(scale.bottom / cell); k * cell < scale.top; k++)
      pen.moveTo(0, at.z(k * cell)), pen.lineTo(canvas.width, at.z(k * cell));
    pen.stroke();
    pen.globalAlpha = 1;
  }

  /* A bar of a round length, and the time. */
  function paintWords(pen, at, ink) {
    const length = ticks(0, scale.edge / 2, 2)[1], now = samples[samples.length - 1]?.time ?? 0, edge = 12 * at.ratio;
    pen.fillStyle = pen.strokeStyle = ink;
    pen.font = `${13 * at.ratio}px ${getComputedStyle(document.body).fontFamily}`;
    pen.fillText(`${now.toFixed(1)} ns`, edge, 22 * at.ratio);
    pen.textAlign = "right";
    pen.fillText(`${shown(length)} µm`, canvas.width - edge, 22 * at.ratio);
    pen.textAlign = "left";
    pen.fillRect(canvas.width - edge - length * at.per, 30 * at.ratio, length * at.per, 2 * at.ratio);
  }

  function paint() {
    if (!frame || !scale) return;
    const style = getComputedStyle(document.documentElement), ink = style.getPropertyValue("--ink");
    const at = place(), pen = canvas.getContext("2d");
    pen.clearRect(0, 0, canvas.width, canvas.height);
    paintPoints(pen, at);
    if (frame.lines.length) paintLines(pen, at, ink, style.getPropertyValue("--series-4"));
    if (find("grid-lines").checked) paintGrid(pen, at, ink);
    paintWords(pen, at, ink);
    const end = samples[0]?.end ?? 1;
    for (const panel of panels) panel.draw(samples, end);
    canvas.setAttribute("aria-label",
      `Section of the impact, ${colour().what}, after ${shown(samples[samples.length - 1]?.time ?? 0, 3)} ns`);
  }

  /* At most one drawing per frame of the screen; then the worker may send the next. */
  function repaint() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      paint();
      worker.postMessage({ kind: "drawn" });
    });
  }

  find("field").append(...Object.entries(LIVE_COLOURS).map(([value, { what }]) =>
    html("option", { value }, what)));
  find("field").onchange = () => {
    if (!scale) return;
    paintBar();
    repaint();
  };
  find("grid-lines").onchange = repaint;
  addEventListener("resize", () => {
    if (!scale) return;
    paintBar();
    repaint();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

  function state(left, total, computed) {
    const last = samples[samples.length - 1] ?? { time: 0, end: 1 };
    const points = samples[0]?.points ?? 0;
    find("progress").value = 1 - left / total;
    find("state").textContent = `${last.time.toFixed(1)} of ${last.end.toFixed(1)} ns · ` +
      `step ${total - left} of ${total} · ${points} points · ${(computed / 1000).toFixed(1)} s`;
  }

  // ---- what the worker says

  const said = {
    ready(what) {
      ({ metals, colors } = what);
      find("version").textContent = what.version;
      options(input.material, metals.map(({ name }) => [name, name]));
      options(input.substrate, [["", "the same"], ...metals.map(({ name }) => [name, name])]);
      for (const name of ["material", "diameter", "velocity", "contact"]) input[name].value = LIVE_START[name];
      for (const slider of form.querySelectorAll("[data-of]")) slider.value = LIVE_START[slider.dataset.of];
      ready = true;
      changed();
    },
    begun(what) {
      ({ scale } = what);
      begun = true;
      paintBar();
      if (wanted) {
        running = true;
        worker.postMessage({ kind: "run" });
      }
      wanted = false;
      buttons();
    },
    frame(what) {
      frame = what;
      samples.push(...what.samples);
      state(what.left, what.total, what.computed);
      repaint();
    },
    done({ result, computed }) {
      const c = choice(), rows = Object.fromEntries(result.rows.map(([what, , value]) => [what, value]));
      const bonded = c.bond === "none" ? "without a bond" : `${shown(rows["bonded area"], 3)} of ` +
        `${shown(rows["contact area"], 3)} µm² that touched bonded`;
      running = false;
      finished = true;
      const back = shown(rows["rebound velocity, mean"], 3), stays = result.verdict === "stays";
      headline(stays ? "It stays." : `It rebounds at ${back} m/s.`, stays ? "good" : "other",
        `${title(c)}: after ${shown(samples[0].end, 3)} ns its mean velocity is ${back} m/s; ${bonded}. Mean plastic ` +
        `strain ${shown(rows["mean plastic strain"], 3)}, hottest point ${shown(rows["highest temperature"], 4)} K. ` +
        `${(computed / 1000).toFixed(1)} s of computing.`);
      find("said").textContent = LIVE_SAID[c.contact];
      find("numbers").tBodies[0].replaceChildren(...result.rows.map(([what, unit, value]) =>
        html("tr", {}, html("th", { scope: "row" }, what), html("td", { class: "number" }, shown(value, 5)),
          html("td", { class: "unit" }, unit.replace("um2", "µm²").replace("um", "µm").replace("m2", "m²")))));
      find("outcome").hidden = false;
      find("spoken").textContent = find("headline").textContent + " " + find("lead").textContent;
      buttons();
    },
    fault({ message }) {
      begun = running = wanted = false;
      find("fault").textContent = message;
      find("fault").hidden = false;
      buttons();
    },
  };
  const late = (what) => what.kind !== "ready" && what.number !== number;
  return Object.fromEntries(Object.entries(said).map(([kind, hear]) => [kind, (what) => late(what) || hear(what)]));
}
