/* lesson.js - one step of the method, phase by phase: the picture, the words, and the arithmetic of the worked point of
   docs/method.md, with the numbers that the phases of mpm.h give. SPDX-License-Identifier: MIT */
"use strict";

/* A number as docs/method.md prints it. */
function fixed(value, digits) {
  return (Math.abs(value) < 1e-9 ? 0 : value).toFixed(digits);
}

const dotted = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/* "m_I" with its I below the line. */
function subscripts(text) {
  return text.split(/_(\w)/).map((part, k) => k % 2 ? html("sub", {}, part) : part);
}

/* What the arithmetic speaks of: the worked point and its nodes in the looks of all phases. */
function liveWorked({ looks, chosen }) {
  const after = (phase) => looks[phase + 1];
  const point = (phase) => after(phase).points.find((p) => p.id === chosen);
  const support = after(0).support;
  const node = (phase, k) => after(phase).nodes.get(support[k].slot);
  const pair = after(4).pairs.find((p) => p.a === support[1].slot);
  const other = (phase) => after(phase).nodes.get(pair.b);
  const name = (k) => node(0, k).x.map((x) => Math.round(x)).join(" ");
  return { PG: 1e3, after, point, node, support, pair, other, name, chosen }; // 1 ng is 1e3 pg
}

/* The phases: name, section of docs/method.md, words, formula, arithmetic in lines, caption of the picture. */
const LIVE_PHASES = [
  {
    name: "Nodes", call: "mpm_locate", section: "1-a-point-and-its-nodes", title: "A point and its nodes",
    words: "The grid is empty. Every point finds the eight corners of the cell it is in. Its share in each of " +
      "them, N, is a product of three hats, one per direction; together they make 1.",
    formula: "N = (1 − |u|) (1 − |v|) (1 − |w|)",
    caption: "Discs as large as N. The dashed box is the cell: its far corners lie half a micrometre and more " +
      "behind the section.",
    lines(w) {
      const p = w.point(0), at = w.node(0, 1).x, u = p.x.map((x, i) => Math.abs(x - at[i]));
      return [`x_p = ${p.x.map((x) => fixed(x, 4)).join(" ")} um`, "",
        `N of node ${w.name(1)}`,
        `  = (1 - ${fixed(u[0], 4)}) (1 - ${fixed(u[1], 4)}) (1 - ${fixed(u[2], 4)})`,
        `  = ${fixed(w.support[1].N, 5)}`, "",
        `sum of all eight = ${fixed(w.support.reduce((sum, s) => sum + s.N, 0), 5)}`];
    },
  },
  {
    name: "To nodes", call: "mpm_p2g", section: "2-mass-and-momentum-to-the-nodes",
    title: "Mass and momentum to the nodes",
    words: "Points lend their mass and momentum to their nodes. Each body has nodes of its own, blue for the " +
      "ball, orange for the block: so bodies can slide on each other and part again.",
    formula: "m_I = Σ m_p N,   P_I = Σ m_p v_p N",
    caption: "Discs as large as a node's mass, arrows its momentum.",
    lines(w) {
      const p = w.point(0), n = w.node(1, 1), N = w.support[1].N, m = w.PG * p.mass;
      return [`m_p = ${fixed(m, 4)} pg, v_z = ${fixed(p.v[2], 3)} m/s`, "",
        `to node ${w.name(1)} the point gives`,
        `  mass   ${fixed(m, 4)} * ${fixed(N, 5)} = ${fixed(m * N, 5)} pg`,
        `  P_z    ${fixed(m * N, 5)} * ${fixed(p.v[2], 3)} = ${fixed(m * N * p.v[2], 4)} pg m/s`, "",
        "with all others the node has",
        `  m_I = ${fixed(w.PG * n.mass, 5)} pg`,
        `  P_z = ${fixed(w.PG * n.momentum[2], 4)} pg m/s`];
    },
  },
  {
    name: "Forces", call: "mpm_forces", section: "3-forces", title: "Forces",
    words: "The stress of a point pushes on its nodes, along the slope of N. m_p / ρ_p is the volume that the " +
      "point stands for. The forces on a free body add up to nothing.",
    formula: "f_I = − Σ m_p / ρ_p  σ_p grad N",
    caption: "Arrows: the force on each node of ball and block.",
    lines(w) {
      const p = w.point(0), n = w.node(2, 1), G = w.support[1].G, s = p.stress, row = [s[4], s[3], s[2]];
      const volume = p.mass / p.density;
      return [`m_p / rho_p = ${fixed(p.mass, 7)} / ${fixed(p.density, 6)} = ${fixed(volume, 5)} um3`,
        `sigma_xz, yz, zz = ${row.map((x) => fixed(x, 1)).join(", ")} MPa`,
        `grad N of ${w.name(1)} = ${G.map((x) => fixed(x, 5)).join(" ")}`, "",
        "the point's part of f_z",
        `  -${fixed(volume, 5)} * ${fixed(dotted(row, G), 1)} = ${fixed(-volume * dotted(row, G), 2)} uN`, "",
        "with all others the node has",
        `  f_z = ${fixed(n.force[2], 4)} uN`];
    },
  },
  {
    name: "Momentum", call: "mpm_grid_update", section: "4-the-nodes-move", title: "The nodes move",
    words: "Each node gets the momentum that its force gives in the time step. The lowest layer of nodes, the " +
      "floor, is held.",
    formula: "P_I ← P_I + f_I dt",
    caption: "Pale: momentum before; full: after the forces.",
    lines(w) {
      const was = w.node(2, 1), n = w.node(3, 1);
      return ["dt = 8e-6 us; 1 uN us is 1000 pg m/s", "",
        `node ${w.name(1)}`,
        `  P_z + f_z dt = ${fixed(w.PG * was.momentum[2], 4)} + (${fixed(was.force[2], 4)} * 8e-3)`,
        `               = ${fixed(w.PG * n.momentum[2], 4)} pg m/s`];
    },
  },
  {
    name: "Meeting", call: "mpm_contact_find", section: "5-where-bodies-meet", title: "Where bodies meet",
    words: "A node that carries mass of both is a contact node. Its normal comes from the block's slope of mass, " +
      "g = Σ m grad N, which points out of the block where its points lie on one side.",
    formula: "n = − g_b / |g_b|",
    caption: "Rings: nodes of both bodies; arrows: the normal, out of the ball.",
    lines(w) {
      const g = w.other(4).gradient, size = Math.sqrt(dotted(g, g));
      return [`node ${w.name(1)}: ball and block`, "",
        `  g_b  = ${g.map((x) => fixed(w.PG * x, 5)).join(" ")} pg/um`,
        `  |g_b| = ${fixed(w.PG * size, 5)} pg/um`, "",
        `  n = ${w.pair.normal.map((x) => fixed(x, 5)).join(" ")}`];
    },
  },
  {
    name: "Contact", call: "mpm_contact_apply", section: "6-contact", title: "Contact",
    words: "Where the two approach, they get one velocity along the normal: what the ball loses, the block gains. " +
      "Without friction nothing happens along the surface.",
    formula: "j = (m_b P_a − m_a P_b) · n / (m_a + m_b)",
    caption: "Arrows: the momentum that contact takes from one body and gives to the other.",
    lines(w) {
      const a = w.node(4, 1), b = w.other(4), n = w.pair.normal;
      const j = w.PG * (b.mass * dotted(a.momentum, n) - a.mass * dotted(b.momentum, n)) / (a.mass + b.mass);
      const three = (v) => v.map((x) => fixed(w.PG * x, 4)).join(" ");
      return [`node ${w.name(1)}, in pg and pg m/s`,
        `  m_a = ${fixed(w.PG * a.mass, 5)}, P_a = ${three(a.momentum)}`,
        `  m_b = ${fixed(w.PG * b.mass, 5)}, P_b = ${three(b.momentum)}`,
        `  n   = ${n.map((x) => fixed(x, 5)).join(" ")}`, "",
        `  j = ${fixed(j, 4)} > 0: they approach`,
        `  P_a - j n = ${three(w.node(5, 1).momentum)}`];
    },
  },
  {
    name: "Back", call: "mpm_g2p", section: "7-back-to-the-points-and-to-the-nodes-again",
    title: "Back to the points",
    words: "The point takes the increment of the grid's velocity, not the velocity itself: that would smear it " +
      "over the cell in every step.",
    formula: "v_p ← v_p + dt Σ f_I N / m_I",
    caption: "Arrows: by how much each point's velocity changes.",
    lines(w) {
      let sum = 0;
      const rows = w.support.map((s, k) => {
        const before = w.node(1, k), n = w.node(5, k);
        const part = s.N * (n.momentum[2] - before.momentum[2]) / n.mass;
        sum += part;
        const delta = fixed(w.PG * (n.momentum[2] - before.momentum[2]), 4);
        return `${w.name(k)}  ${fixed(s.N, 5)} * ${delta.padStart(8)} / ${fixed(w.PG * n.mass, 5)} = ${
          fixed(part, 4).padStart(7)}`;
      });
      return ["N (P after contact - P) / m_I, along z, m/s", ...rows,
        `together ${fixed(sum, 4)}: v_z = ${fixed(w.point(5).v[2], 3)} becomes ${fixed(w.point(6).v[2], 3)}`];
    },
  },
  {
    name: "Again", call: "mpm_musl", section: "7-back-to-the-points-and-to-the-nodes-again",
    title: "And to the nodes again",
    words: "The new velocities of the points go to the nodes once more: a mean of theirs, and bounded, also at a " +
      "node that a point only just reaches. P / m would not be.",
    formula: "v_I = Σ m_p v_p N / m_I",
    caption: "Arrows: the nodes' velocities, for the strain alone.",
    lines(w) {
      return ["v_I along z, m/s", ...w.support.map((_, k) =>
        `  ${w.name(k)}  ${fixed(w.node(7, k).velocity[2], 3).padStart(9)}`)];
    },
  },
  {
    name: "Stress", call: "mpm_stress", section: "8-strain-and-stress", title: "Strain and stress",
    words: "The slope of the nodes' velocities strains and turns the point; its density follows. Then its " +
      "material has the word: here Hooke's law, the old stress turned along.",
    formula: "L = dt Σ v_I grad N,   ρ ← ρ / (1 + tr L)",
    caption: "Colours: the stress along z, red pressed, blue drawn.",
    lines(w) {
      const [xx, yy, zz, yz, xz, xy, wx, wy, wz] = w.after(8).strain.map((x) => 1e3 * x);
      const L = [[xx, xy - wz, xz + wy], [xy + wz, yy, yz - wx], [xz - wy, yz + wx, zz]];
      const s = w.point(8).stress, old = w.point(7);
      const six = [["xx", 0], ["yy", 1], ["zz", 2], ["yz", 3], ["xz", 4], ["xy", 5]];
      const of = (k) => `${six[k][0]} ${fixed(s[six[k][1]], 1)}`;
      return ["L, 1e-3", ...L.map((row) => "  " + row.map((x) => fixed(x, 4).padStart(8)).join(" ")),
        `tr L = ${fixed(xx + yy + zz, 4)}e-3`,
        `rho = ${fixed(old.density, 6)} becomes ${fixed(w.point(8).density, 6)} ng/um3`,
        `sigma = ${of(0)}, ${of(1)}, ${of(2)},`, `        ${of(3)}, ${of(4)}, ${of(5)} MPa`];
    },
  },
  {
    name: "Move", call: "mpm_move", section: "9-the-points-move", title: "The points move",
    words: "The points move with the grid's velocity, which is continuous: points of one body never pass through " +
      "each other. Then the grid is forgotten, and the next step begins.",
    formula: "x_p ← x_p + dt Σ P_I N / m_I",
    caption: "Arrows: how far each point moves, drawn far too long.",
    lines(w) {
      const was = w.point(8), is = w.point(9), three = (x) => x.map((c) => fixed(c, 4)).join(" ");
      return [`x = ${three(was.x)} um`, `  becomes`, `    ${three(is.x)} um`, "",
        `v = ${is.v.map((c) => fixed(c, 3)).join(" ")} m/s`, "",
        `z by ${fixed(is.x[2] - was.x[2], 4)} um in dt = 8e-6 us`];
    },
  },
];

/* The columns of the table: head, phase from which on it is known, value as text. */
const LIVE_COLUMNS = [
  ["N", 0, (w, k) => fixed(w.support[k].N, 5)],
  ["dN/dx", 0, (w, k) => fixed(w.support[k].G[0], 5)],
  ["dN/dy", 0, (w, k) => fixed(w.support[k].G[1], 5)],
  ["dN/dz", 0, (w, k) => fixed(w.support[k].G[2], 5)],
  ["m_I", 1, (w, k) => fixed(w.PG * w.node(1, k).mass, 5)],
  ["P_z", 1, (w, k) => fixed(w.PG * w.node(1, k).momentum[2], 4)],
  ["f_z", 2, (w, k) => fixed(w.node(2, k).force[2], 4)],
  ["P_z + f_z dt", 3, (w, k) => fixed(w.PG * w.node(3, k).momentum[2], 4)],
  ["after contact", 5, (w, k) => fixed(w.PG * w.node(5, k).momentum[2], 4)],
  ["v_I, z", 7, (w, k) => fixed(w.node(7, k).velocity[2], 3)],
];

/* ---- the picture ----------------------------------------------------------------------------------------------- */

const BODY = ["var(--series-0)", "var(--series-1)"];

/* A place in the section; what lies behind it goes up and to the right. */
const seen = ([x, y, z]) => [x + 0.34 * (y - 5), -z - 0.24 * (y - 5)];

function arrow(from, along, scale, color, faint) {
  const [x0, y0] = seen(from), x1 = x0 + scale * along[0], y1 = y0 - scale * along[2];
  const length = Math.hypot(x1 - x0, y1 - y0), head = Math.min(0.11, length / 2);
  if (length < 0.03) return [];
  const ux = (x1 - x0) / length, uy = (y1 - y0) / length;
  const wing = (s) => `${x1 - head * (ux - s * 0.5 * uy)} ${y1 - head * (uy + s * 0.5 * ux)}`;
  return [svg("path", { d: `M${x0} ${y0}L${x1} ${y1}M${wing(1)}L${x1} ${y1}L${wing(-1)}`, stroke: color, fill: "none",
    "stroke-width": 0.036, "stroke-linecap": "round", "stroke-linejoin": "round", opacity: faint ? 0.4 : 1 })];
}

/* Arrows of [place, vector, color, faint], the longest 0.8 cells. */
function arrows(list) {
  const longest = Math.max(...list.map(([, v]) => Math.hypot(v[0], v[2])), 1e-30);
  return list.flatMap(([from, along, color, faint]) => arrow(from, along, 0.8 / longest, color, faint));
}

function label(place, text, here, dx, dy) {
  const [x, y] = seen(place), anchor = dx < 0 ? "end" : "start";
  return svg("text", { x: x + dx, y: y + dy, class: here ? "here" : "", "text-anchor": anchor }, text);
}

/* The cell of the worked point. */
function cube(w) {
  const corner = w.support.map((_, k) => seen(w.node(0, k).x)), edges = [];
  for (let a = 0; a < 8; a++) for (const bit of [1, 2, 4]) if (!(a & bit)) edges.push([corner[a], corner[a | bit]]);
  return edges.map(([[x1, y1], [x2, y2]]) => svg("line", { x1, y1, x2, y2, stroke: "var(--ink)", "stroke-width": 0.018,
    "stroke-dasharray": "0.07 0.06", opacity: 0.7 }));
}

/* What each phase shows over points and nodes. */
const LIVE_OVERLAYS = [
  (w) => w.support.flatMap((s, k) => {
    const place = w.node(0, k).x, [cx, cy] = seen(place), [x1, y1] = seen(w.point(0).x);
    return [svg("line", { x1, y1, x2: cx, y2: cy, stroke: BODY[0], "stroke-width": 0.02, opacity: 0.6 }),
      svg("circle", { cx, cy, r: 0.42 * Math.sqrt(s.N), fill: BODY[0], opacity: 0.55 }),
      label(place, fixed(s.N, 3), k === 1, (k & 1 ? 1 : -1) * (0.06 + 0.42 * Math.sqrt(s.N)), 0.06)];
  }),
  (w, front) => [...front(1).map(({ x, mass, body }) => {
    const [cx, cy] = seen(x);
    return svg("circle", { cx, cy, r: 0.17 * Math.sqrt(w.PG * mass / 2.7), fill: BODY[body], opacity: 0.3 });
  }), ...arrows(front(1).map((n) => [n.x, n.momentum, BODY[n.body]]))],
  (w, front) => arrows(front(2).map((n) => [n.x, n.force, BODY[n.body]])),
  (w, front) => arrows([...front(2).map((n) => [n.x, n.momentum, BODY[n.body], true]),
    ...front(3).map((n) => [n.x, n.momentum, BODY[n.body]])]),
  (w, front) => w.after(4).pairs.filter((p) => w.after(4).nodes.get(p.a)?.x[1] === 5).flatMap((p) => {
    const place = w.after(4).nodes.get(p.a).x, [cx, cy] = seen(place);
    return [svg("circle", { cx, cy, r: 0.13, fill: "none", stroke: "var(--ink)", "stroke-width": 0.03 }),
      ...arrow(place, p.normal, 0.62, BODY[0])];
  }),
  (w) => arrows(w.after(5).pairs.filter((p) => w.after(5).nodes.get(p.a)?.x[1] === 5).flatMap((p) => {
    const place = w.after(5).nodes.get(p.a).x;
    return [[place, p.impulse, BODY[0]], [place, p.impulse.map((j) => -j), BODY[1]]];
  })),
  (w) => arrows(w.after(6).points.map((p, i) =>
    [p.x, p.v.map((v, c) => v - w.after(5).points[i].v[c]), BODY[p.body]])),
  (w, front) => arrows(front(7).map((n) => [n.x, n.velocity, BODY[n.body]])),
  () => [],
  (w) => arrows(w.after(9).points.map((p, i) =>
    [w.after(8).points[i].x, p.x.map((x, c) => x - w.after(8).points[i].x[c]), BODY[p.body]])),
];

const LIVE_WINDOW = { low: 3.45, high: 8.05, bottom: 2.55, top: 6.3 };

function liveDrawing(w, phase, colors) {
  const { low, high, bottom, top } = LIVE_WINDOW, parts = [];
  const inside = ([x, , z]) => x > low - 0.3 && x < high + 0.3 && z > bottom - 0.3 && z < top + 0.3;
  const front = (k) => [...w.after(k).nodes.values()].filter((n) => n.x[1] === 5 && inside(n.x));
  const line = (x1, y1, x2, y2) => svg("line", { x1, y1, x2, y2, stroke: "var(--line)", "stroke-width": 0.02 });
  for (let x = Math.ceil(low); x < high; x++) parts.push(line(x, -top, x, -bottom));
  for (let z = Math.ceil(bottom); z < top; z++) parts.push(line(low, -z, high, -z));
  for (const p of w.after(phase).points.filter((one) => inside(one.x))) {
    const [x, y] = seen(p.x), mine = p.id === w.chosen, t = 0.5 + p.stress[2] / 14000;
    const fill = phase === 8 ? `rgb(${colors[2][Math.round(255 * Math.min(1, Math.max(0, 1 - t)))]})` : BODY[p.body];
    const look = { fill, opacity: mine || phase === 8 ? 1 : 0.38, stroke: mine ? "var(--ink)" : "none",
      "stroke-width": 0.03 };
    parts.push(p.body ? svg("rect", { x: x - 0.1, y: y - 0.1, width: 0.2, height: 0.2, ...look })
      : svg("circle", { cx: x, cy: y, r: mine ? 0.13 : 0.11, ...look }));
  }
  parts.push(...cube(w));
  for (const n of front(phase)) {
    const [cx, cy] = seen(n.x);
    parts.push(svg("circle", { cx, cy, r: 0.038, fill: "var(--ink)" }));
  }
  w.support.forEach((_, k) => {
    const [cx, cy] = seen(w.node(0, k).x);
    if (w.node(0, k).x[1] === 6) parts.push(svg("circle", { cx, cy, r: 0.033, fill: "var(--paper)",
      stroke: "var(--ink)", "stroke-width": 0.018 }));
  });
  parts.push(...LIVE_OVERLAYS[phase](w, front));
  if (phase !== 0) parts.push(label(w.node(0, 1).x, w.name(1), true, 0.1, 0.24));
  return parts;
}

/* ---- the page ---------------------------------------------------------------------------------------------------- */

function liveLesson(worker) {
  const find = (id) => document.getElementById(id);
  const drawing = find("drawing"), { low, high, bottom, top } = LIVE_WINDOW;
  let worked, colors, phase = 0, asked = false;
  drawing.setAttribute("viewBox", `${low} ${-top} ${high - low} ${top - bottom}`);

  const dots = LIVE_PHASES.map((one, k) => {
    const button = html("button", { type: "button" }, one.name);
    button.onclick = () => go(k);
    find("phases").append(html("li", {}, button));
    return button;
  });

  function paintTable() {
    const known = LIVE_COLUMNS.filter(([, from]) => from <= phase);
    const now = ([, from]) => from === phase ? "number now" : "number";
    const head = html("tr", {}, html("th", { scope: "col" }, "node"), ...known.map((column) =>
      html("th", { scope: "col", class: now(column) }, ...subscripts(column[0]))));
    const rows = worked.support.map((_, k) => html("tr", k === 1 ? { class: "here" } : {},
      html("th", { scope: "row" }, worked.name(k)),
      ...known.map((column) => html("td", { class: now(column) }, column[2](worked, k)))));
    find("nodes").replaceChildren(html("thead", {}, head), html("tbody", {}, ...rows));
  }

  function paint() {
    if (!worked) return;
    const one = LIVE_PHASES[phase];
    dots.forEach((dot) => dot.removeAttribute("aria-current"));
    dots[phase].setAttribute("aria-current", "step");
    find("step-title").textContent = `${phase + 1} of ${LIVE_PHASES.length}: ${one.title}`;
    find("step-words").replaceChildren(...subscripts(one.words));
    find("formula").replaceChildren(...subscripts(one.formula));
    find("arithmetic").textContent = one.lines(worked).join("\n");
    find("drawing-words").textContent = one.caption;
    find("step-link").replaceChildren(html("code", {}, one.call), " in mpm.h; ",
      html("a", { href: "method.html#" + one.section }, "this section of the method"));
    drawing.replaceChildren(...liveDrawing(worked, phase, colors));
    find("back").disabled = phase === 0;
    find("forward").disabled = phase === LIVE_PHASES.length - 1;
    paintTable();
  }

  function go(k) {
    phase = Math.max(0, Math.min(LIVE_PHASES.length - 1, k));
    history.replaceState(null, "", "#step-" + (phase + 1));
    paint();
  }

  find("back").onclick = () => go(phase - 1);
  find("forward").onclick = () => go(phase + 1);
  addEventListener("keydown", (event) => {
    if (find("step").hidden || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.target.closest?.("[role=region]")) return; // what scrolls sideways keeps its arrows
    const to = { ArrowRight: phase + 1, ArrowLeft: phase - 1 }[event.key];
    if (to === undefined || !worked) return;
    event.preventDefault();
    go(to);
  });
  addEventListener("live-step", () => {
    const wanted = Number(location.hash.slice("#step-".length));
    if (wanted >= 1 && wanted <= LIVE_PHASES.length) phase = wanted - 1;
    if (!asked) worker.postMessage({ kind: "lesson" });
    asked = true;
    paint();
  });
  return {
    lesson(what) {
      worked = liveWorked(what);
      paint();
    },
    ready(what) { ({ colors } = what); },
  };
}
