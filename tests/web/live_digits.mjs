/* live_digits.mjs - build/web/live.wasm computes what the desktop does: impacts beside tests/web/live_digits.c and
   build/impact to 1e-12, its errors word for word, and the worked point as docs/method.md has it.
   node tests/web/live_digits.mjs, from the top folder. SPDX-License-Identifier: MIT */
import { execFileSync, spawnSync } from "node:child_process";
import fs from "node:fs";
import { check, checkEnd, near, script } from "./live_check.mjs";

const { liveEngine } = script("engine.js", "liveEngine");
const { liveWords, LIVE_START, LIVE_GRIDS, LIVE_BONDS } =
  script("choices.js", "liveWords", "LIVE_START", "LIVE_GRIDS", "LIVE_BONDS");
const SUMS = ["kinetic energy", "internal energy", "plastic work", "momentum along z", "sum of x", "sum of z",
  "absorbed energy", "energy lost in contact", "energy in the bond"];
const engine = await liveEngine(fs.readFileSync("build/web/live.wasm"));

/* ---- impacts ---- */

function wholeRun(words) {
  const before = process.cpuUsage();
  engine.begin(words);
  while (engine.advance(200) > 0);
  const { user, system } = process.cpuUsage(before);
  return (user + system) / 1e6;
}

function besideDesktop(words) {
  const native = execFileSync("build/tests/live_digits", words, { encoding: "utf8" }).trim().split("\n").map(Number);
  const seconds = wholeRun(words), here = engine.digits();
  SUMS.forEach((name, i) => near(`${words.join(" ")}: ${name}`, here[i], native[i], 1e-12));
  return seconds;
}

const usual = liveWords(LIVE_START);
check("the page starts with build/impact's own impact, in rings", usual.join(" ") === "--geometry axisymmetric");
const seconds = besideDesktop(usual);
console.log(`# the first verdict takes ${seconds.toFixed(1)} s of processor time`);
check("the first verdict takes less than 10 s of processor time", seconds < 10, seconds);

/* The table of the page beside the summary of the program whose command the page shows. */
const folder = "build/tests/live-impact";
fs.rmSync(folder, { recursive: true, force: true });
execFileSync("build/impact", [...usual, "--frames", "0", "--quiet", "--out", folder]);
const summary = JSON.parse(fs.readFileSync(folder + "/summary.json", "utf8"));
const { verdict, rows } = engine.result(), table = Object.fromEntries(rows.map(([what, , value]) => [what, value]));
check("it stays", verdict === "stays", verdict);
for (const [row, key, scale = 1] of [["rebound velocity, mean", "v_rest_mean_m_s"], ["PBCP", "pbcp_percent"],
  ["mean plastic strain", "eps_mean"], ["highest temperature", "temperature_max_K"],
  ["contact area", "contact_area_um2"], ["bonded area", "bonded_area_um2"], ["flattening", "flattening"],
  ["energy: kinetic", "energy_kinetic_fraction", 100], ["energy: plastic work", "energy_plastic_fraction", 100],
  ["energy: absorbed by dampers", "energy_absorbed_fraction", 100], ["pairs held", "held_pairs"]])
  near(`build/impact's summary: ${row}`, table[row], scale * summary[key], 1e-12);
const last = engine.sample();
near("the curve of velocity ends there", last.velocity, summary.v_rest_mean_m_s, 1e-12);
near("the curve of plastic work too", last.plastic, summary.energy_plastic_fraction, 1e-12);

wholeRun([...usual, "--bond", "none"]);
check("without a bond it rebounds", engine.result().verdict === "rebounds");

const surface = ["--method", "surface", "--cell", "1.4", "--time", "12"];
besideDesktop(surface);
check("surfaces have lines", engine.outline().length > 100);
besideDesktop(["--geometry", "axisymmetric", "--material", "cu", "--substrate-material", "al", "--bond", "strain",
  "--cell", "2", "--spacing", "1", "--time", "10"]);

/* Every choice makes a command line that the program takes. */
function begins(words) {
  try {
    engine.begin(words);
    return "";
  } catch (fault) {
    return `${words.join(" ")}: ${fault.message}; `;
  }
}

const { metals } = engine.metals();
let tried = 0, refused = "";
for (const contact of ["nodes", "surface"])
  for (const [bond] of LIVE_BONDS[contact])
    for (let grid = 0; grid < LIVE_GRIDS[contact].length; grid++)
      for (const diameter of [2, 14, 200]) {
        refused += begins(liveWords({ ...LIVE_START, contact, bond, grid, diameter, velocity: 600, substrate: "cu" }));
        tried++;
      }
check("all metals are there", metals.length >= 12 && metals.some(({ name }) => name === "ti-6al-4v"));
for (const { name, models } of metals)
  for (const model of models) {
    refused += begins(liveWords({ ...LIVE_START, material: name, model }));
    tried++;
  }
check(`all of ${tried} choices begin`, refused === "", refused);

/* What is wrong is said as the program says it. */
for (const words of [["--cell", "-1"], ["--material", "cheese"], ["--bond", "glue"], ["--velocity", "fast"],
  ["--speed", "3"], ["--angle", "30", "--geometry", "axisymmetric"]]) {
  let here = "nothing";
  try {
    engine.begin(words);
  } catch (fault) {
    here = fault.message;
  }
  const desktop = spawnSync("build/impact", words, { encoding: "utf8" }).stderr.trim();
  check(`${words.join(" ")} is refused as by build/impact`, here === desktop && desktop.includes("error"), here);
}
engine.begin(usual);
check("... and a run can begin after that", engine.advance(10) > 0);
engine.end();

/* ---- the worked point: the page's text of tests/72_method.c, from the phases of mpm.h ---- */

const f = (value, digits, width = 0) => (Math.abs(value) < 1e-9 ? 0 : value).toFixed(digits).padStart(width);
const three = (v, digits, scale = 1) => v.map((x) => f(scale * x, digits)).join(" ");
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const { looks, chosen } = engine.lesson(), at = (phase) => looks[phase + 1];
const support = at(0).support, node = (phase, k) => at(phase).nodes.get(support[k].slot);
const place = (k) => node(0, k).x.map(Math.round).join(" ");
const text = [];

function sayPoint(when, phase) {
  const p = at(phase).points.find(({ id }) => id === chosen), s = p.stress;
  text.push(when, `    x     = ${three(p.x, 4)} um, v = ${three(p.v, 3)} m/s, rho = ${f(p.density, 6)} ng/um3`,
    `    sigma = xx ${f(s[0], 1)}, yy ${f(s[1], 1)}, zz ${f(s[2], 1)}, yz ${f(s[3], 1)}, xz ${f(s[4], 1)}, ` +
    `xy ${f(s[5], 1)} MPa`);
}

sayPoint("the point after 100 steps, t = 0.8 ns", -1);
text.push("its nodes N       dN/dx    dN/dy    dN/dz    m_I, pg   P_z, pg m/s  f_z, uN    P_z + f_z dt  after contact");
support.forEach(({ N, G }, k) => text.push(`    ${place(k)} ${f(N, 5)} ${f(G[0], 5, 8)} ${f(G[1], 5, 8)} ${
  f(G[2], 5, 8)}  ${f(1e3 * node(1, k).mass, 5)}  ${f(1e3 * node(1, k).momentum[2], 4, 11)}  ${
  f(node(2, k).force[2], 4, 10)}  ${f(1e3 * node(3, k).momentum[2], 4, 12)}  ${
  f(1e3 * node(5, k).momentum[2], 4, 13)}`));
const pair = at(5).pairs.find(({ a }) => a === support[1].slot), a = node(4, 1), b = at(4).nodes.get(pair.b);
const j = (b.mass * dot(a.momentum, pair.normal) - a.mass * dot(b.momentum, pair.normal)) / (a.mass + b.mass);
text.push(`contact at node ${place(1)}, in pg and pg m/s`,
  `    m_a = ${f(1e3 * a.mass, 5)}, P_a = ${three(a.momentum, 4, 1e3)}`,
  `    m_b = ${f(1e3 * b.mass, 5)}, P_b = ${three(b.momentum, 4, 1e3)}`,
  `    n   = -g_b / |g_b| = ${three(pair.normal, 5)}`,
  `    j   = (m_b P_a - m_a P_b) . n / (m_a + m_b) = ${f(1e3 * j, 4)} > 0: they approach`,
  `    P_a - j n = ${three(node(5, 1).momentum, 4, 1e3)}`,
  "v_I from the new velocities of the points, z, m/s",
  `    ${support.map((_, k) => f(node(7, k).velocity[2], 3)).join(" ")}`, "L = dt sum v_I grad N, 1e-3");
const [xx, yy, zz, yz, xz, xy, wx, wy, wz] = at(8).strain.map((x) => 1e3 * x);
for (const row of [[xx, xy - wz, xz + wy], [xy + wz, yy, yz - wx], [xz - wy, yz + wx, zz]])
  text.push(`    ${row.map((x) => f(x, 4, 8)).join(" ")}`);
sayPoint("the point after 101 steps", 9);

const block = fs.readFileSync("docs/method.md", "utf8").split("```text\n")[1]?.split("```")[0] ?? "";
const page = block.trimEnd().split("\n");
check("docs/method.md has the worked point", page.length === text.length, page.length);
text.forEach((line, i) => check(`the worked point, line ${i + 1}`, line === page[i], `${line}, not ${page[i]}`));
checkEnd();
