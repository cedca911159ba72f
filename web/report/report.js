/* report.js - what moves in report.html: the frames of a run, in section and in 3D, and curves over time.
   Numbers come with the page (report.h writes them): "meta" says what they are, "frames" holds them in base64. */
"use strict";
(function () {

const meta = JSON.parse(document.getElementById("meta").textContent);
const frames = JSON.parse(document.getElementById("frames").textContent);
const $ = (id) => document.getElementById(id);
const flat = meta.geometry !== "3d";             // points have x and z alone
const rings = meta.geometry === "axisymmetric";
const at = { frame: 0, field: null, view: "section", cut: true, surface: true };

/* ---- numbers ------------------------------------------------------------------------------------------- */

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}

/* 16 bits each, the low byte first, as numbers from low to high. */
function numbers(text, low, high) {
  const b = bytes(text), out = new Float32Array(b.length >> 1), unit = (high - low) / 65535;
  for (let i = 0; i < out.length; i++) out[i] = low + unit * (b[2 * i] | b[2 * i + 1] << 8);
  return out;
}

function places(object, n) {
  const axis = (k) => {
    const name = "xyz"[k];
    return object[name] === undefined ? new Float32Array(n)
      : numbers(object[name], meta.low[k], meta.low[k] + meta.size[k]);
  };
  return [axis(0), axis(1), axis(2)];
}

/* A frame's points, decoded when they are first asked for. */
function pointsOf(frame) {
  if (!frame.x3) {
    frame.x3 = places(frame, frame.points);
    frame.bodies = bytes(frame.body);
    frame.values = {};
  }
  return frame.x3;
}

function valuesOf(frame, field) {
  pointsOf(frame);
  if (!frame.values[field.name]) {
    const part = frame[field.name];
    frame.values[field.name] = numbers(part[2], part[0] || 0, part[1] || 0);
  }
  return frame.values[field.name];
}

function surfacesOf(frame) {
  if (frame.shells) return frame.shells;
  frame.shells = frame.surfaces.map((s) => {
    const mark = bytes(s.mark), b = bytes(s.face), face = new Uint32Array(b.length / 3);
    for (let i = 0; i < face.length; i++) face[i] = b[3 * i] | b[3 * i + 1] << 8 | b[3 * i + 2] << 16;
    return { x: places(s, mark.length), mark, face, body: s.body, corners: s.corners };
  });
  return frame.shells;
}

/* The value below which that share of some numbers lies. */
function quantile(list, share) {
  const sorted = Float32Array.from(list).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 0;
}

/* Steps of 1, 2 or 5 that part a range into about n. */
function step(range, n) {
  const raw = range / n, ten = Math.pow(10, Math.floor(Math.log10(raw))), part = raw / ten;
  return (part > 7 ? 10 : part > 3.5 ? 5 : part > 1.5 ? 2 : 1) * ten;
}

function ticks(low, high, n) {
  const out = [];
  if (!(high > low)) return [low];
  const by = step(high - low, n);
  for (let k = Math.ceil(low / by - 1e-6); k * by <= high + 1e-6 * by; k++) out.push(k * by);
  return out;
}

/* Short, with a true minus, for people. */
function words(value, digits) {
  if (value === null || value === undefined || !isFinite(value)) return "none";
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text = size >= 1e6 || size < 1e-4 ? size.toExponential(1)
    : size >= 1000 ? size.toFixed(0) : String(Number(size.toPrecision(digits || 4)));
  text = text.replace(/e\+?(-?)(\d+)/, (all, sign, n) => "\u00b710" + raised(sign + n));
  return (value < 0 ? "\u2212" : "") + text;
}
function raised(text) {
  const signs = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075",
    6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079" };
  return text.replace(/./g, (c) => signs[c]);
}
const spelled = (unit) => unit.replace(/^u(?=[mNJg])/, "\u00b5").replace(/([a-z])([23])$/,
  (all, letter, n) => letter + (n === "2" ? "\u00b2" : "\u00b3"));

/* ---- colours ------------------------------------------------------------------------------------------- */

/* Control points of even steps in lightness, those of mpm_draw.h. */
const maps = {
  deep: "083271 014486 03579a 076e9c 0284a4 029aa9 0cb1a9 08c99b 72db83 b1eb65 f7f449",
  heat: "2c274d 542b67 882375 bb1263 de2843 f14e38 ff702c ff963a ffb851 ffd580 fff0c2",
  diverging: "055987 0177b3 3a95d5 83b2e0 b8cfea f4eceb ecc4be e09c93 d1756a be4c44 a02626"
};
for (const name of Object.keys(maps)) {
  const point = maps[name].split(" ").map((h) => [0, 2, 4].map((k) => parseInt(h.slice(k, k + 2), 16)));
  maps[name] = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; i++) {
    const place = i / 255 * 10, k = Math.min(9, Math.floor(place));
    for (let c = 0; c < 3; c++) maps[name][3 * i + c] = point[k][c] + (point[k + 1][c] - point[k][c]) * (place - k);
  }
}

/* The scale of a field, the same for all frames: all but the uppermost values, to round numbers. */
function scaleOf(field) {
  if (field.scale) return field.scale;
  const all = [];
  let low = Infinity, high = -Infinity;
  for (const f of frames) {
    const v = valuesOf(f, field);
    for (let i = 0; i < v.length; i += 3) all.push(v[i]);
    low = Math.min(low, f[field.name][0]);
    high = Math.max(high, f[field.name][1]);
  }
  let bottom = low, top = Math.max(quantile(all, 0.998), low + 0.35 * (high - low));
  if (field.map === "diverging") {
    top = Math.max(Math.abs(quantile(all, 0.01)), Math.abs(quantile(all, 0.99)));
    bottom = -top;
  }
  const by = step(Math.max(top - bottom, 1e-12), 8);
  field.scale = { low: Math.floor(bottom / by + 1e-4) * by, high: Math.ceil(top / by - 1e-4) * by, least: low,
    most: high };
  return field.scale;
}

function colourPlace(value, scale) {
  const part = (value - scale.low) / (scale.high - scale.low);
  return 3 * Math.round(255 * (part > 0 ? part < 1 ? part : 1 : 0));
}

const paint = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/* ---- the section --------------------------------------------------------------------------------------- */

/* The part of the section to show: where all but the farthest points are, in all frames. */
const window2 = (function () {
  let across = 0, low = Infinity, high = -Infinity;
  for (const f of frames) {
    const x = pointsOf(f);
    if (!f.points) continue;
    across = Math.max(across, quantile(x[0].map(Math.abs), 0.9985));
    low = Math.min(low, quantile(x[2], 0.0005));
    high = Math.max(high, quantile(x[2], 0.9985));
  }
  const edge = 0.04 * (high - low) + 1.5 * (meta.spacing || 0);
  const left = meta.mirror && !meta.mirror[0] && flat ? Math.min(0, -across) : -across;
  return { left: left - edge, right: across + edge, low: low - edge, high: high + edge };
})();

/* Points within this of the plane y = 0 are of the section. */
const slab = 1.01 * meta.spacing;

/* Visits every point of the section, and its mirror image. */
function eachOfSection(frame, visit) {
  const x = pointsOf(frame);
  for (let i = 0; i < frame.points; i++) {
    if (!flat && Math.abs(x[1][i]) > slab) continue;
    visit(i, x[0][i], x[2][i]);
    if (meta.mirror[0]) visit(i, -x[0][i], x[2][i]);
  }
}

/* Matter ends where the weights of the points around sum to this: at a flat face some half a spacing outside. */
const enough = 0.9;

/* For each pixel the nearest point's body, and the sums over that body's points around it: weights, and values. */
function raster(frame, field, w, h, scale) {
  const value = valuesOf(frame, field), n = w * h;
  const nearest = new Float32Array(n).fill(Infinity), body = new Uint8Array(n);
  const sum = new Float32Array(n), weight = new Float32Array(n);
  const wide = 1.6 * meta.spacing * scale;
  const stamp = (x, z, radius, use) => {
    const u = (x - window2.left) * scale, v = (window2.high - z) * scale;
    const from = Math.max(0, Math.ceil(v - radius)), to = Math.min(h - 1, Math.floor(v + radius));
    for (let row = from; row <= to; row++) {
      const half = Math.sqrt(radius * radius - (row - v) * (row - v));
      const end = Math.min(w - 1, Math.floor(u + half));
      for (let col = Math.max(0, Math.ceil(u - half)); col <= end; col++)
        use(row * w + col, (row - v) * (row - v) + (col - u) * (col - u));
    }
  };
  eachOfSection(frame, (i, x, z) => stamp(x, z, 0.75 * wide, (p, d) => {
    if (d >= nearest[p]) return;
    nearest[p] = d;
    body[p] = frame.bodies[i] + 1;
  }));
  eachOfSection(frame, (i, x, z) => stamp(x, z, wide, (p, d) => {
    if (body[p] !== frame.bodies[i] + 1) return;
    const near = Math.pow(1 - d / (wide * wide), 2);
    sum[p] += near * value[i];
    weight[p] += near;
  }));
  for (let p = 0; p < n; p++) if (weight[p] < enough) body[p] = 0;
  return { body, sum, weight };
}

function sectionImage(frame, field, w, h, scale) {
  const r = raster(frame, field, w, h, scale), image = new ImageData(w, h), range = scaleOf(field);
  const colours = maps[field.map], dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const line = dark ? 215 : 25;
  for (let p = 0; p < r.body.length; p++) {
    if (!r.body[p]) continue;
    const k = colourPlace(r.sum[p] / r.weight[p], range), b = r.body[p];
    const edge = r.body[p - 1] !== b || r.body[p + 1] !== b || r.body[p - w] !== b || r.body[p + w] !== b;
    for (let c = 0; c < 3; c++) image.data[4 * p + c] = edge ? line : colours[k + c];
    image.data[4 * p + 3] = 255;
  }
  return image;
}

/* Where surfaces lie in the section: [x, z, x, z, mark] of their lines, or where triangles cross the plane. */
function outline(frame) {
  const lines = [], y0 = 1e-4 * meta.spacing;
  for (const s of surfacesOf(frame))
    for (let f = 0; f < s.face.length; f += s.corners) {
      const cut = [];
      let mark = 0;
      for (let k = 0; k < s.corners; k++) {
        const a = s.face[f + k], b = s.face[f + (k + 1) % s.corners];
        mark = Math.max(mark, s.mark[a]);
        if (s.corners === 2) {
          cut.push(s.x[0][a], s.x[2][a]);
        } else if ((s.x[1][a] > y0) !== (s.x[1][b] > y0)) {
          const u = (s.x[1][a] - y0) / (s.x[1][a] - s.x[1][b]);
          cut.push(s.x[0][a] + u * (s.x[0][b] - s.x[0][a]), s.x[2][a] + u * (s.x[2][b] - s.x[2][a]));
        }
      }
      if (cut.length === 4) lines.push([...cut, mark]);
    }
  return lines;
}

function strokeOutline(c, frame, scale, mark, colour, thick) {
  c.strokeStyle = colour;
  c.lineWidth = thick;
  c.beginPath();
  for (const l of outline(frame)) {
    if ((l[4] === 2) !== (mark === 2)) continue;
    for (const side of meta.mirror[0] ? [1, -1] : [1]) {
      c.moveTo((side * l[0] - window2.left) * scale, (window2.high - l[1]) * scale);
      c.lineTo((side * l[2] - window2.left) * scale, (window2.high - l[3]) * scale);
    }
  }
  c.stroke();
}

function scaleBar(c, scale, w, ratio) {
  const length = step(window2.right - window2.left, 5), x = 14 * ratio, y = 34 * ratio;
  c.fillStyle = paint("--ink");
  c.fillRect(x, y, length * scale, 2 * ratio);
  c.font = 13 * ratio + "px " + paint("--sans");
  c.textAlign = "center";
  c.fillText(words(length) + " " + spelled(meta.length), x + length * scale / 2, y - 6 * ratio);
}

function sizeCanvas(canvas, most) {
  const width = Math.max(200, canvas.parentElement.clientWidth);
  const ratio = Math.min(window.devicePixelRatio || 1, most / width) || 1;
  const shape = (window2.high - window2.low) / (window2.right - window2.left);
  const height = Math.min(width * shape, Math.max(320, 0.78 * window.innerHeight));
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.height = height + "px";
  return ratio;
}

/* The section's pixels per length; higher pages than the window leave room at the sides. */
function sectionScale(canvas) {
  return Math.min(canvas.width / (window2.right - window2.left), canvas.height / (window2.high - window2.low));
}

let shown = null; // what the section's pixels mean
function drawSection() {
  const canvas = $("section"), ratio = sizeCanvas(canvas, 1400), scale = sectionScale(canvas);
  const w = Math.floor(scale * (window2.right - window2.left)), h = Math.floor(scale * (window2.high - window2.low));
  const frame = frames[at.frame], c = canvas.getContext("2d"), left = Math.floor((canvas.width - w) / 2);
  c.clearRect(0, 0, canvas.width, canvas.height);
  c.putImageData(sectionImage(frame, at.field, w, h, scale), left, 0);
  c.save();
  c.translate(left, 0);
  if (at.surface && frame.surfaces.length) {
    strokeOutline(c, frame, scale, 0, paint("--ink"), 1.2 * ratio);
    strokeOutline(c, frame, scale, 2, paint("--series-6"), 3 * ratio);
  }
  c.restore();
  scaleBar(c, scale, w, ratio);
  shown = { scale, left, ratio };
}

/* What the point under the mouse is. */
function probe(event) {
  if (!shown) return;
  const box = $("section").getBoundingClientRect(), frame = frames[at.frame];
  const x = ((event.clientX - box.left) * $("section").width / box.width - shown.left) / shown.scale + window2.left;
  const z = window2.high - (event.clientY - box.top) * $("section").height / box.height / shown.scale;
  let best = -1, least = 4 * meta.spacing * meta.spacing;
  eachOfSection(frame, (i, px, pz) => {
    const d = (px - x) * (px - x) + (pz - z) * (pz - z);
    if (d < least) { least = d; best = i; }
  });
  if (best < 0) return;
  $("probe").textContent = meta.field.filter((f) => f.shown).map((f) =>
    f.label + " " + words(valuesOf(frame, f)[best], 3) + (f.unit ? " " + f.unit : "")).join(" \u00b7 ");
}

/* ---- 3D ------------------------------------------------------------------------------------------------ */

const turn = { across: -0.62, down: 0.42, zoom: 1 };
let gl = null, dots = null, shell = null;

const dotVertex = `
attribute vec3 place; attribute vec3 colour; attribute float edge;
uniform mat3 turn; uniform vec3 middle, mirror; uniform vec2 scale, ring; uniform float size, cut, near;
varying vec3 tint; varying vec3 flatNormal;
void main() {
  vec3 p = mirror * place;
  p = vec3(p.x * ring.x - p.y * ring.y, p.x * ring.y + p.y * ring.x, p.z);
  tint = colour; flatNormal = vec3(0.0);
  if (cut > 0.5) {
    if (p.x > near && p.y < -near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); gl_PointSize = 0.0; return; }
    if (p.x > -near && abs(p.y) < near) flatNormal = turn * vec3(0.0, -1.0, 0.0);
    else if (p.y < near && abs(p.x) < near) flatNormal = turn * vec3(1.0, 0.0, 0.0);
  }
  vec3 seen = turn * (p - middle);
  gl_Position = vec4(seen.xy * scale, -seen.z * scale.y * 0.2, 1.0);
  gl_PointSize = size;
}`;
const dotFragment = `
precision mediump float;
varying vec3 tint; varying vec3 flatNormal;
void main() {
  vec2 d = 2.0 * gl_PointCoord - 1.0;
  float r = dot(d, d);
  if (r > 1.0) discard;
  vec3 normal = length(flatNormal) > 0.5 ? flatNormal : vec3(d.x, -d.y, sqrt(1.0 - r));
  float light = 0.5 + 0.5 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.8))));
  if (length(flatNormal) > 0.5) light = 1.0;
  gl_FragColor = vec4(tint * light, 1.0);
}`;
const shellVertex = `
attribute vec3 place; attribute vec3 colour; attribute vec3 normal;
uniform mat3 turn; uniform vec3 middle, mirror; uniform vec2 scale, ring; uniform float cut, near;
varying vec3 tint, facing, where;
vec3 ringed(vec3 p) { return vec3(p.x * ring.x - p.y * ring.y, p.x * ring.y + p.y * ring.x, p.z); }
void main() {
  where = ringed(mirror * place);
  tint = colour;
  facing = turn * ringed(mirror * normal);
  vec3 seen = turn * (where - middle);
  gl_Position = vec4(seen.xy * scale, -seen.z * scale.y * 0.2, 1.0);
}`;
const shellFragment = `
precision mediump float;
uniform float cut, near;
varying vec3 tint, facing, where;
void main() {
  if (cut > 0.5 && where.x > 0.0 && where.y < 0.0) discard;
  float light = 0.42 + 0.58 * max(0.0, dot(normalize(facing), normalize(vec3(-0.35, 0.55, 0.8))));
  gl_FragColor = vec4(tint * light, 1.0);
}`;

function program(vertex, fragment) {
  const p = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const s = gl.createShader(kind);
    gl.shaderSource(s, text);
    gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
    gl.attachShader(p, s);
  }
  gl.linkProgram(p);
  return p;
}

/* WebGL, or not. */
function beginSolid() {
  gl = $("solid").getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return false;
  dots = { program: program(dotVertex, dotFragment) };
  shell = { program: program(shellVertex, shellFragment) };
  for (const what of [dots, shell]) what.buffer = [gl.createBuffer(), gl.createBuffer(), gl.createBuffer()];
  gl.enable(gl.DEPTH_TEST);
  return true;
}

function coloursOf(values, field) {
  const range = scaleOf(field), colours = maps[field.map], out = new Uint8Array(3 * values.length);
  for (let i = 0; i < values.length; i++) {
    const k = colourPlace(values[i], range);
    out.set(colours.subarray(k, k + 3), 3 * i);
  }
  return out;
}

/* Boxes of a size with the points in them: finds what is near, and which points have no neighbour on a side. */
function boxes(x, n, size) {
  const box = new Map(), key = (i, j, k) => (i + 512) + 1024 * ((j + 512) + 1024 * (k + 512));
  const number = (v) => Math.floor(v / size);
  for (let i = 0; i < n; i++) {
    const k = key(number(x[0][i]), number(x[1][i]), number(x[2][i]));
    if (box.has(k)) box.get(k).push(i); else box.set(k, [i]);
  }
  return { get: (a, b, c) => box.get(key(a, b, c)), number };
}

/* Points of a half plane at its outside: around them not all boxes are filled. */
function outsideOf(frame) {
  if (frame.outside) return frame.outside;
  const x = pointsOf(frame), b = boxes(x, frame.points, 1.5 * meta.spacing);
  frame.outside = new Uint8Array(frame.points);
  for (let i = 0; i < frame.points; i++) {
    const u = b.number(x[0][i]), w = b.number(x[2][i]);
    for (let du = -1; du <= 1; du++)
      for (let dw = -1; dw <= 1; dw++) if (u + du >= 0 && !b.get(u + du, 0, w + dw)) frame.outside[i] = 1;
  }
  return frame.outside;
}

/* Those of them with no surface near: faces where the body goes on, which dampers stand for, have none. */
function bareOf(frame) {
  if (frame.bare) return frame.bare;
  const size = 3 * meta.spacing, x = pointsOf(frame);
  const near = surfacesOf(frame).map((s) => boxes(s.x, s.mark.length, size));
  frame.bare = outsideOf(frame).map((out, i) => {
    if (!out) return 0;
    const u = Math.floor(x[0][i] / size), w = Math.floor(x[2][i] / size);
    for (const b of near)
      for (let k = 0; k < 9; k++) if (b.get(u + k % 3 - 1, 0, w + Math.floor(k / 3) - 1)) return 0;
    return 1;
  });
  return frame.bare;
}

/* Values of the nearest point of its body at each marker. */
function shellValues(frame, s, field) {
  const x = pointsOf(frame), value = valuesOf(frame, field), size = 3 * meta.spacing;
  if (!frame.boxes) frame.boxes = boxes(x, frame.points, size);
  return Float32Array.from(s.mark, (mark, m) => {
    let best = 0, least = Infinity;
    const c = [0, 1, 2].map((a) => frame.boxes.number(s.x[a][m]));
    for (let i = -1; i <= 1; i++)
      for (let j = flat ? 0 : -1; j <= (flat ? 0 : 1); j++)
        for (let k = -1; k <= 1; k++)
          for (const p of frame.boxes.get(c[0] + i, c[1] + j, c[2] + k) || []) {
            if (frame.bodies[p] !== s.body) continue;
            const d = (x[0][p] - s.x[0][m]) ** 2 + (x[1][p] - s.x[1][m]) ** 2 + (x[2][p] - s.x[2][m]) ** 2;
            if (d < least) { least = d; best = value[p]; }
          }
    return best;
  });
}

/* Triangles of all surfaces; lines of a half plane are turned into strips of an angle. */
function shellTriangles(frame, field, angle) {
  const place = [], colour = [], normal = [], sin = Math.sin(angle), cos = Math.cos(angle);
  for (const s of surfacesOf(frame)) {
    const tint = coloursOf(shellValues(frame, s, field), field);
    const put = (m, y) => {
      const r = s.x[0][m];
      if (s.corners === 2) place.push(y ? r * cos : r, y ? r * sin : 0, s.x[2][m]);
      else place.push(s.x[0][m], s.x[1][m], s.x[2][m]);
      colour.push(tint[3 * m], tint[3 * m + 1], tint[3 * m + 2]);
    };
    for (let f = 0; f < s.face.length; f += s.corners) {
      const [a, b] = [s.face[f], s.face[f + 1]], from = place.length;
      if (s.corners === 2) for (const [m, y] of [[a, 0], [b, 1], [b, 0], [a, 0], [a, 1], [b, 1]]) put(m, y);
      else for (let k = 0; k < 3; k++) put(s.face[f + k], 0);
      for (let t = from; t < place.length; t += 9) {
        const e = [3, 4, 5, 6, 7, 8].map((k) => place[t + k] - place[t + k % 3]);
        const n = [e[1] * e[5] - e[2] * e[4], e[2] * e[3] - e[0] * e[5], e[0] * e[4] - e[1] * e[3]];
        const long = Math.hypot(...n) || 1;
        for (let k = 0; k < 3; k++) normal.push(n[0] / long, n[1] / long, n[2] / long);
      }
    }
  }
  return { place: new Float32Array(place), colour: new Uint8Array(colour), normal: new Float32Array(normal) };
}

/* Rotation about the vertical, then towards the reader; rows are right, up, out of the screen. */
function rotation() {
  const a = Math.cos(turn.across), b = Math.sin(turn.across), c = Math.cos(turn.down), d = Math.sin(turn.down);
  const rows = [[a, b, 0], [-b * d, a * d, c], [b * c, -a * c, d]];
  return new Float32Array([0, 1, 2].flatMap((k) => rows.map((r) => r[k])));
}

function attribute(what, k, name, data, size, kind, whole) {
  const place = gl.getAttribLocation(what.program, name);
  if (place < 0) return;
  gl.bindBuffer(gl.ARRAY_BUFFER, what.buffer[k]);
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, kind, whole, 0, 0);
}

/* Sets what all copies share; returns how to set what differs: mirror and angle. */
function uniforms(what, canvas, size) {
  const get = (name) => gl.getUniformLocation(what.program, name);
  const high = window2.high - window2.low, wide = window2.right - window2.left;
  const tall = high * Math.cos(turn.down) + wide * Math.abs(Math.sin(turn.down));
  const fit = turn.zoom * 1.9 / Math.max(tall, wide * canvas.height / canvas.width);
  gl.useProgram(what.program);
  gl.uniformMatrix3fv(get("turn"), false, rotation());
  gl.uniform3f(get("middle"), 0, 0, window2.low + 0.5 * high);
  gl.uniform2f(get("scale"), fit * canvas.height / canvas.width, fit);
  gl.uniform1f(get("size"), size * meta.spacing * fit * canvas.height / 2);
  gl.uniform1f(get("cut"), at.cut ? 1 : 0);
  gl.uniform1f(get("near"), 0.55 * meta.spacing);
  const mirror = get("mirror"), ring = get("ring");
  return (mx, my, angle) => {
    gl.uniform3f(mirror, mx, my, 1);
    gl.uniform2f(ring, Math.cos(angle), Math.sin(angle));
  };
}

/* A quarter or a half stands for the whole: its mirror images; with the cut the one in front is left out. */
function mirrors() {
  const out = [];
  for (const mx of meta.mirror[0] ? [1, -1] : [1])
    for (const my of meta.mirror[1] ? [1, -1] : [1])
      if (!(at.cut && meta.mirror[0] && meta.mirror[1] && mx > 0 && my < 0)) out.push([mx, my, 0]);
  return out;
}

/* A half plane turned about its axis: 270 degrees of it with the cut, which is from -90 to 0. */
function turned(n) {
  const whole = at.cut ? 1.5 * Math.PI : 2 * Math.PI, out = [];
  for (let k = 0; k <= n; k++) out.push([1, 1, whole * k / n]);
  return out;
}

function pick(frame, chosen) {
  const x = pointsOf(frame), tint = coloursOf(valuesOf(frame, at.field), at.field), list = [];
  for (let i = 0; i < frame.points; i++) if (!chosen || chosen[i]) list.push(i);
  const place = new Float32Array(3 * list.length), colour = new Uint8Array(3 * list.length);
  list.forEach((i, k) => {
    for (let a = 0; a < 3; a++) {
      place[3 * k + a] = x[a][i];
      colour[3 * k + a] = tint[3 * i + a];
    }
  });
  return { place, colour, count: list.length };
}

function drawDots(canvas, frame, copies, chosen, size) {
  const set = uniforms(dots, canvas, size), some = pick(frame, chosen);
  attribute(dots, 0, "place", some.place, 3, gl.FLOAT, false);
  attribute(dots, 1, "colour", some.colour, 3, gl.UNSIGNED_BYTE, true);
  for (const copy of copies) {
    set(...copy);
    gl.drawArrays(gl.POINTS, 0, some.count);
  }
}

function drawShell(canvas, frame, copies, angle) {
  const set = uniforms(shell, canvas, 0), t = shellTriangles(frame, at.field, angle);
  attribute(shell, 0, "place", t.place, 3, gl.FLOAT, false);
  attribute(shell, 1, "colour", t.colour, 3, gl.UNSIGNED_BYTE, true);
  attribute(shell, 2, "normal", t.normal, 3, gl.FLOAT, false);
  for (const copy of copies) {
    set(...copy);
    gl.drawArrays(gl.TRIANGLES, 0, t.place.length / 3);
  }
}

function drawSolid() {
  const canvas = $("solid"), frame = frames[at.frame], shells = at.surface && frame.surfaces.length > 0;
  sizeCanvas(canvas, 1400);
  const size = shells ? 1 : 1.65;
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  if (!rings) {
    if (shells) drawShell(canvas, frame, mirrors(), 0);
    drawDots(canvas, frame, mirrors(), null, size);
    return;
  }
  const part = (at.cut ? 1.5 : 2) * Math.PI;
  const n = Math.min(720, Math.ceil(part * window2.right / meta.spacing)), strips = 96, angle = part / strips;
  if (shells) drawShell(canvas, frame, turned(strips).slice(0, -1), angle);
  drawDots(canvas, frame, turned(n), shells ? bareOf(frame) : outsideOf(frame), 1.65);
  if (at.cut) drawDots(canvas, frame, [[1, 1, 0], [1, 1, 1.5 * Math.PI]], null, 1.65);
}

/* ---- the colour bar ------------------------------------------------------------------------------------ */

function drawBar() {
  const range = scaleOf(at.field), side = matchMedia("(max-width: 40rem)").matches, colours = maps[at.field.map];
  const stops = Array.from({ length: 33 }, (none, k) =>
    "rgb(" + Array.from(colours.subarray(3 * Math.round(k * 255 / 32), 3 * Math.round(k * 255 / 32) + 3)) + ")");
  const unit = at.field.unit ? " (" + at.field.unit + ")" : "";
  const bar = $("bar");
  bar.textContent = "";
  const what = bar.appendChild(document.createElement("div"));
  what.className = "what";
  what.textContent = at.field.label + unit;
  const box = bar.appendChild(document.createElement("div"));
  box.className = "scale";
  const strip = box.appendChild(document.createElement("div"));
  strip.className = "colours";
  strip.style.background = "linear-gradient(to " + (side ? "right" : "top") + "," + stops + ")";
  for (const t of ticks(range.low, range.high, side ? 4 : 6)) {
    const tick = box.appendChild(document.createElement("span")), part = (t - range.low) / (range.high - range.low);
    tick.className = "tick";
    tick.textContent = words(Number(t.toPrecision(6)));
    tick.style[side ? "left" : "bottom"] = 100 * part + "%";
  }
  const more = bar.appendChild(document.createElement("div"));
  more.textContent = "whole run: " + words(range.least, 3) + " to " + words(range.most, 3);
  more.className = "note";
}

/* ---- curves -------------------------------------------------------------------------------------------- */

const svgName = "http://www.w3.org/2000/svg";
function svg(name, attributes, parent) {
  const node = document.createElementNS(svgName, name);
  for (const key of Object.keys(attributes)) node.setAttribute(key, attributes[key]);
  return parent.appendChild(node);
}

const box = { w: 340, h: 200, left: 50, right: 14, top: 10, bottom: 42 };

/* Axes of a panel; returns how numbers become places. */
function axes(root, p, size) {
  const x = (v) => size.left + (v - p.x0) / (p.x1 - p.x0) * (size.w - size.left - size.right);
  const y = (v) => size.h - size.bottom - (v - p.y0) / (p.y1 - p.y0) * (size.h - size.top - size.bottom);
  for (const t of ticks(p.y0, p.y1, 4)) {
    svg("line", { x1: size.left, x2: size.w - size.right, y1: y(t), y2: y(t), class: "grid" }, root);
    svg("text", { x: size.left - 6, y: y(t) + 4, "text-anchor": "end" }, root).textContent =
      words(Number(t.toPrecision(6)));
  }
  for (const t of ticks(p.x0, p.x1, 5))
    svg("text", { x: x(t), y: size.h - size.bottom + 19, "text-anchor": "middle" }, root).textContent =
      words(Number(t.toPrecision(6)));
  if (p.y0 < 0 && p.y1 > 0)
    svg("line", { x1: size.left, x2: size.w - size.right, y1: y(0), y2: y(0), class: "axis" }, root);
  return { x, y };
}

function path(xs, ys, place) {
  let text = "", pen = "M";
  for (let i = 0; i < xs.length; i++) {
    if (ys[i] === null || xs[i] === null) { pen = "M"; continue; }
    text += pen + place.x(xs[i]).toFixed(1) + " " + place.y(ys[i]).toFixed(1);
    pen = "L";
  }
  return text;
}

function bounds(p) {
  const ys = p.series.flatMap((s) => s.y.filter((v) => v !== null)), xs = p.series.flatMap((s) => s.x);
  const low = Math.min(0, ...ys), high = Math.max(0, ...ys), by = step(high - low || 1, 4);
  p.y0 = Math.floor(low / by + 1e-6) * by;
  p.y1 = Math.ceil(high / by - 1e-6) * by || by;
  p.x0 = Math.min(...xs);
  p.x1 = Math.max(...xs);
  if (!(p.x1 > p.x0)) p.x1 = p.x0 + 1;
}

const dashes = ["", "6 3", "2 2.5", "8 3 2 3"];
const colourOf = (k) => "var(--series-" + k % 8 + ")";

/* A panel with its curves; the history's gets a cursor and a list with the values under it. */
function panel(p, large) {
  const size = large ? Object.assign({}, box, { w: 480, h: 300 }) : box;
  const article = $("panels").appendChild(document.createElement("article"));
  article.className = "panel" + (large ? " large" : "");
  const title = article.appendChild(document.createElement("h3")), unit = title.appendChild(
    document.createElement("small"));
  title.insertBefore(document.createTextNode(p.title + " "), unit);
  unit.textContent = p.y;
  bounds(p);
  const root = svg("svg", { viewBox: "0 0 " + size.w + " " + size.h, role: "img",
    "aria-label": p.title + " over " + p.x + ": " + p.series.map((s) => s.name).join(", ") }, article);
  if (p.band && p.band[0] !== null && p.band[2] !== null) p.bandNode = svg("rect", { class: "band" }, root);
  const place = axes(root, p, size);
  if (p.bandNode) drawBand(root, p, place, size);
  svg("text", { x: size.w - size.right, y: size.h - 5, "text-anchor": "end" }, root).textContent = p.x;
  const list = article.appendChild(document.createElement("ul"));
  p.series.forEach((s, k) => {
    const dash = dashes[k >> 2 & 3];
    if (s.line !== 0)
      svg("path", { d: path(s.x, s.y, place), style: "stroke:" + colourOf(k), "stroke-dasharray": dash }, root);
    if (s.line !== 1 || large)
      s.x.forEach((v, i) => s.y[i] !== null && svg("circle", { cx: place.x(v), cy: place.y(s.y[i]), r: 3.5,
        style: "stroke-width:1.5;stroke:" + colourOf(k) + ";fill:" + (s.full && !s.full[i] ? "var(--paper)"
          : colourOf(k)) }, root));
    const item = list.appendChild(document.createElement("li"));
    item.appendChild(document.createElement("i")).style.borderColor = colourOf(k);
    item.appendChild(document.createElement("span")).textContent = s.name;
    if (s.about) item.title = s.about;
    s.out = large ? null : item.appendChild(document.createElement("b"));
  });
  if (p.words) {
    const note = article.appendChild(document.createElement("p"));
    note.className = "note";
    note.textContent = p.words;
  }
  p.place = place;
  p.size = size;
  p.root = root;
  return p;
}

/* Within what the answer lies, and its most likely place. */
function drawBand(root, p, place, size) {
  const from = place.x(p.band[0]), to = place.x(p.band[2]);
  const rect = { x: from, width: Math.max(1, to - from), y: size.top, height: size.h - size.top - size.bottom };
  for (const key of Object.keys(rect)) p.bandNode.setAttribute(key, rect[key]);
  if (p.band[1] !== null)
    svg("line", { x1: place.x(p.band[1]), x2: place.x(p.band[1]), y1: size.top, y2: size.h - size.bottom,
      class: "best" }, root);
}

const titles = { pJ: "energy", mm: "length", um: "length", "ng m/s": "momentum", "m/s": "velocity", uN: "force", um2: "area", K: "temperature",
  MPa: "stress", "J/m2": "energy per area", "J": "energy", "%": "share" };
const spell = { abp: "ABP", pbcp: "PBCP", v: "velocity" };

function nameOf(column, group) {
  const first = group[0][0].split("_")[0];
  const shared = group.length > 1 && group.every((c) => c[0].split("_")[0] === first) && first !== "v";
  const parts = column.split("_");
  return (shared ? parts.slice(1) : parts).map((w) => spell[w] || w).join(" ");
}

/* Units for large numbers of others. */
const thousand = { pJ: "nJ", nJ: "uJ", uN: "mN", MPa: "GPa", "ng m/s": "ug m/s" };

let past = [];
function drawPast() {
  const h = meta.past, groups = new Map();
  if (!h || h.row.length < 2) return;
  h.column.forEach((c, k) => {
    if (k === 0 || !h.row.some((r) => r[k] !== null && r[k] !== 0)) return; // nothing of this kind happened
    if (!groups.has(c[1])) groups.set(c[1], []);
    groups.get(c[1]).push([...c, k]);
  });
  const x = h.row.map((r) => r[0]);
  const size = (c) => Math.max(...h.row.map((r) => Math.abs(r[c[3]])));
  for (const [unit, all] of groups) {
    const most = Math.max(...all.map(size)), group = all.filter((c) => size(c) > 1e-9 * most); // no round-off
    const title = group.length === 1 ? nameOf(group[0][0], group) : titles[unit] || "values";
    const large = most >= 2000 && thousand[unit], by = large ? 1e-3 : 1;
    past.push(panel({ title, y: spelled(large || unit), x: "time, " + spelled(h.column[0][1]),
      series: group.map((c) => ({ name: nameOf(c[0], group), about: c[2], x,
        y: h.row.map((r) => r[c[3]] === null ? null : by * r[c[3]]), line: 1 })) }, false));
  }
  for (const p of past) {
    p.cursor = svg("line", { y1: p.size.top, y2: p.size.h - p.size.bottom, class: "cursor" }, p.root);
    if (!frames.length) continue;
    p.root.style.cursor = "ew-resize";
    const choose = (e) => {
      if (e.type === "pointermove" && !e.buttons) return;
      const r = p.root.getBoundingClientRect(), u = (e.clientX - r.left) / r.width * p.size.w;
      const t = p.x0 + (u - p.size.left) / (p.size.w - p.size.left - p.size.right) * (p.x1 - p.x0);
      show(frames.reduce((best, f, k) => Math.abs(f.time - t) < Math.abs(frames[best].time - t) ? k : best, 0));
    };
    p.root.addEventListener("pointerdown", choose);
    p.root.addEventListener("pointermove", choose);
  }
}

/* Cursors at the frame's time, and the values there; without frames those of the end. */
function moveCursors() {
  for (const p of past) {
    const xs = p.series[0].x, time = frames.length ? frames[at.frame].time : xs[xs.length - 1];
    let i = xs.findIndex((v) => v >= time - 1e-9);
    if (i < 0) i = xs.length - 1;
    if (i > 0 && time - xs[i - 1] < xs[i] - time) i--;
    for (const key of ["x1", "x2"]) p.cursor.setAttribute(key, p.place.x(time));
    for (const s of p.series) if (s.out) s.out.textContent = words(s.y[i], 3);
  }
}

/* ---- what the reader does ------------------------------------------------------------------------------ */

let waiting = false, playing = 0;
function draw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    if (at.view === "solid") drawSolid(); else drawSection();
  });
}

const timeText = () => "t = " + frames[at.frame].time.toFixed(1) + " " + spelled(meta.time);
function label() {
  const view = at.view === "solid" ? "3D" : "section";
  const text = meta.title + ", " + at.field.label + " in " + view + ", " + timeText();
  $("section").setAttribute("aria-label", text);
  $("solid").setAttribute("aria-label", text + "; arrow keys turn it, plus and minus change its size");
}

function show(frame) {
  at.frame = Math.max(0, Math.min(frames.length - 1, frame));
  $("frame").value = at.frame;
  $("frame").setAttribute("aria-valuetext", timeText() + ", frame " + (at.frame + 1) + " of " + frames.length);
  $("time").textContent = timeText() + "  \u00b7  " + (at.frame + 1) + "/" + frames.length;
  label();
  moveCursors();
  draw();
}

function setField(name) {
  at.field = meta.field.find((f) => f.name === name);
  drawBar();
  label();
  draw();
}

function setView(view) {
  at.view = view;
  $("section").hidden = view === "solid";
  $("solid").hidden = view !== "solid";
  $("cut-label").hidden = view !== "solid";
  $("probe").hidden = view === "solid";
  $("bonded").hidden = view === "solid";
  label();
  draw();
}

function play(on) {
  clearInterval(playing);
  playing = 0;
  $("play").textContent = on ? "Pause" : "Play";
  $("play").setAttribute("aria-pressed", String(on));
  if (!on) return;
  if (at.frame === frames.length - 1) show(0);
  playing = setInterval(() => {
    show(at.frame + 1);
    if (at.frame === frames.length - 1) play(false);
  }, Math.max(60, Math.min(600, 6000 / frames.length)));
}

/* Left and right step through the frames wherever they mean nothing else. */
function keys(e) {
  const tag = e.target.tagName, kind = e.target.type;
  if (e.altKey || e.ctrlKey || e.metaKey || tag === "SELECT" || kind === "radio" || kind === "range") return;
  if (e.target.id === "solid" && turnByKey(e.key)) { e.preventDefault(); return; }
  const to = { ArrowLeft: at.frame - 1, ArrowRight: at.frame + 1, Home: 0, End: frames.length - 1 }[e.key];
  if (to === undefined || tag === "PRE" || (tag === "DIV" && e.target.tabIndex === 0)) return;
  e.preventDefault();
  show(to);
}

function turnByKey(key) {
  const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[key];
  const zoom = { "+": 1.15, "=": 1.15, "-": 1 / 1.15 }[key];
  if (by) turnBy(...by);
  if (zoom) zoomBy(zoom);
  return by !== undefined || zoom !== undefined;
}
function turnBy(across, down) {
  turn.across += across;
  turn.down = Math.max(-1.57, Math.min(1.57, turn.down + down));
  draw();
}
function zoomBy(factor) {
  turn.zoom = Math.max(0.3, Math.min(12, turn.zoom * factor));
  draw();
}

function drag() {
  const canvas = $("solid");
  canvas.addEventListener("pointerdown", (e) => canvas.setPointerCapture(e.pointerId));
  canvas.addEventListener("pointermove", (e) => {
    if (e.buttons) turnBy(-0.009 * e.movementX, 0.009 * e.movementY);
  });
  canvas.addEventListener("wheel", (e) => {
    if (document.activeElement !== canvas) return; // the page scrolls until the picture is chosen
    e.preventDefault();
    zoomBy(Math.exp(-0.0015 * e.deltaY));
  }, { passive: false });
}

function beginFilm() {
  $("film").hidden = false;
  for (const f of meta.field) {
    f.shown = frames.some((frame) => frame[f.name][1] > frame[f.name][0]);
    if (f.shown) $("field").add(new Option(f.label, f.name));
  }
  if (!$("field").options.length) $("field").add(new Option(meta.field[0].label, meta.field[0].name));
  $("surface-label").hidden = !frames.some((f) => f.surfaces.length);
  $("cut-label").hidden = true;
  $("frame").max = frames.length - 1;
  if (!beginSolid() || meta.geometry === "plane") {
    $("views").querySelector("[value=solid]").disabled = true;
    $("no-solid").hidden = meta.geometry === "plane";
  }
  at.field = meta.field.find((f) => f.name === $("field").value);
  $("field").addEventListener("change", (e) => setField(e.target.value));
  $("frame").addEventListener("input", (e) => { play(false); show(Number(e.target.value)); });
  $("play").addEventListener("click", () => play(!playing));
  $("cut").addEventListener("change", (e) => { at.cut = e.target.checked; draw(); });
  $("surface").addEventListener("change", (e) => { at.surface = e.target.checked; draw(); });
  $("views").addEventListener("change", (e) => setView(e.target.value));
  $("section").addEventListener("pointermove", probe);
  document.addEventListener("keydown", keys);
  drag();
  const again = () => { drawBar(); draw(); };
  window.addEventListener("resize", again);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  drawBar();
}

if (meta.panel.length || (meta.past && meta.past.row.length > 1)) $("curves").hidden = false;
if (meta.panel.length) $("curves-title").textContent = "Curves";
$("panels").classList.toggle("pair", meta.panel.length > 0);
for (const p of meta.panel) panel(p, true);
drawPast();
if (frames.length) {
  beginFilm();
  show(frames.length - 1);
} else {
  moveCursors();
}

}());
