/* report.mjs - report.html in a browser: node report.mjs CHROMIUM PICTURES FOLDER KIND ..., each FOLDER with the page
   of a run of that kind: nodes, surface (both axisymmetric), 3d, study. Pictures of what was seen go into PICTURES.
   SPDX-License-Identifier: MIT */
import { resolve } from "node:path";
import { browse, software, without } from "./browser.mjs";

let passed = 0, failed = 0;
function check(what, ok, got = "") {
  if (ok) passed++; else failed++;
  console.log((ok ? "ok" : "not ok") + " - " + what + (ok ? "" : ": " + got));
}
const equal = (what, got, wanted) => check(what, got === wanted, "got " + got + ", wanted " + wanted);

const [program, pictures, ...rest] = process.argv.slice(2);
const address = (folder) => "file://" + resolve(folder) + "/report.html";

/* What a canvas shows: a number of its pixels, and how many are not empty. */
const look = (page, id) => page.evaluate(`(() => {
  const c = document.getElementById("${id}"), n = document.createElement("canvas");
  n.width = c.width; n.height = c.height;
  const g = n.getContext("2d");
  g.drawImage(c, 0, 0);
  const d = g.getImageData(0, 0, n.width, n.height).data;
  let sum = 7, full = 0;
  for (let i = 0; i < d.length; i += 4) {
    sum = (31 * sum + d[i] + 256 * d[i + 1] + 65536 * d[i + 2] + 3 * d[i + 3]) % 1000000007;
    full += d[i + 3] > 0;
  }
  return { sum, part: full / (n.width * n.height) };
})()`);
const text = (page, id) => page.evaluate(`document.getElementById("${id}").textContent`);

/* All words of the page against what is behind them: the least contrast, and whose it is. */
const contrast = (page) => page.evaluate(`(() => {
  const number = (c) => c.match(/[\\d.]+/g).map(Number);
  const light = (c) => [0, 1, 2].map((k) => c[k] / 255).map((v) => v <= 0.04045 ? v / 12.92
    : ((v + 0.055) / 1.055) ** 2.4).reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  let least = 99, whose = "";
  for (const e of document.querySelectorAll("body *")) {
    if (![...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim())) continue;
    if (!e.getClientRects().length || e.closest("noscript, script, .unseen") || e.matches("option")) continue;
    const s = getComputedStyle(e), svg = e instanceof SVGElement;
    let b = e, back = "rgba(0, 0, 0, 0)";
    while (b && number(back)[3] === 0) { back = getComputedStyle(b).backgroundColor; b = b.parentElement; }
    const [x, y] = [light(number(svg ? s.fill : s.color)), light(number(back))].sort((p, q) => q - p);
    const ratio = (x + 0.05) / (y + 0.05);
    if (ratio < least) { least = ratio; whose = e.tagName + "." + (e.className.baseVal ?? e.className) + " " +
      e.textContent.trim().slice(0, 20); }
  }
  return { least, whose };
})()`);

/* What sticks out at the right, but for what scrolls by itself. */
const sticking = (page) => page.evaluate(`(() => {
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) return "the page is " +
    document.documentElement.scrollWidth + " wide in " + width;
  return [...document.querySelectorAll("body *")].filter((e) => e.getClientRects().length &&
    !e.closest(".wide, .skip, .unseen, svg") && e.getBoundingClientRect().right > width + 1)
    .map((e) => e.tagName + "#" + e.id).join(" ");
})()`);

/* Words that lie over others: axis labels and ticks of one panel, ticks of the colour bar. */
const overlaps = (page) => page.evaluate(`(() => {
  const bad = [];
  for (const group of [...document.querySelectorAll("svg"), document.getElementById("bar")]) {
    const words = [...group.querySelectorAll("text, .tick")].map((e) => [e.textContent, e.getBoundingClientRect()]);
    words.forEach(([t, a], i) => words.slice(i + 1).forEach(([u, b]) => {
      if (a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 2 && b.top < a.bottom - 2)
        bad.push(t + "/" + u);
    }));
  }
  return bad.join(" ");
})()`);

async function scrubbing(page, kind) {
  const last = await look(page, "section");
  check(kind + ": the section shows matter", last.part > 0.2 && last.part < 1, last.part);
  const said = await text(page, "time"), cursor = "document.querySelector('.cursor').getAttribute('x1')";
  const words = "document.querySelector('.panel b').textContent";
  const place = await page.evaluate(cursor), value = await page.evaluate(words);
  await page.press("Home");
  const first = await look(page, "section");
  check(kind + ": Home shows another frame", first.sum !== last.sum);
  check(kind + ": ... and its time", await text(page, "time") !== said && /0\.0/.test(await text(page, "time")));
  check(kind + ": the curves' cursor follows", await page.evaluate(cursor) !== place);
  check(kind + ": ... and their values", await page.evaluate(words) !== value);
  await page.press("ArrowRight");
  check(kind + ": the right arrow goes on by one", (await text(page, "time")).includes("2/"), await text(page, "time"));
  await page.press("ArrowLeft");
  equal(kind + ": the left arrow goes back to the same pixels", (await look(page, "section")).sum, first.sum);
  await page.evaluate("document.getElementById('frame').focus()");
  await page.press("End");
  equal(kind + ": the slider's own End, to the last", (await look(page, "section")).sum, last.sum);
  await page.press("ArrowLeft");
  check(kind + ": the slider's own arrow is one step", (await page.evaluate(`(() => { const f =
    document.getElementById("frame"); return f.max - f.value; })()`)) === 1);
  check(kind + ": it says the time to who cannot see", /frame \d+ of \d+/.test(
    await page.evaluate("document.getElementById('frame').getAttribute('aria-valuetext')")));
}

async function fields(page, kind) {
  const names = await page.evaluate("[...document.getElementById('field').options].map((o) => o.value)");
  check(kind + ": fields to choose from", names.length >= 5, names.join());
  const seen = new Set(), bars = new Set();
  for (const name of names) {
    await page.evaluate(`(() => { const f = document.getElementById("field"); f.value = "${name}";
      f.dispatchEvent(new Event("change")); })()`);
    await page.settle();
    seen.add((await look(page, "section")).sum);
    bars.add(await text(page, "bar"));
  }
  equal(kind + ": each field has pixels of its own", seen.size, names.length);
  equal(kind + ": ... and a colour bar of its own", bars.size, names.length);
  await page.evaluate(`(() => { const c = document.getElementById("section"), r = c.getBoundingClientRect();
    c.dispatchEvent(new PointerEvent("pointermove", { clientX: r.left + r.width / 2,
      clientY: r.bottom - 0.2 * r.height })); })()`);
  check(kind + ": a point tells its values", /plastic strain .*temperature .* K/.test(await text(page, "probe")),
    await text(page, "probe"));
  check(kind + ": the picture says what it shows", (await page.evaluate(
    "document.getElementById('section').getAttribute('aria-label')")).length > 30);
}

async function turning(page, kind, picture) {
  await page.evaluate("document.querySelector('[value=solid]').click()");
  await page.settle();
  const before = await look(page, "solid");
  check(kind + ": the 3D view shows matter", before.part > 0.1 && before.part < 0.95, before.part);
  await page.evaluate("document.getElementById('solid').focus()");
  for (let k = 0; k < 4; k++) await page.press("ArrowLeft");
  const after = await look(page, "solid");
  check(kind + ": arrow keys turn it", after.sum !== before.sum && after.part > 0.1);
  await page.press("+");
  check(kind + ": plus makes it larger", (await look(page, "solid")).part > after.part);
  await page.press("-");
  await page.evaluate("document.getElementById('cut').click()");
  await page.settle();
  check(kind + ": it can be closed", (await look(page, "solid")).sum !== after.sum);
  await page.evaluate("document.getElementById('cut').click()");
  await page.picture(picture, false);
  await page.evaluate("document.querySelector('[value=section]').click()");
  await page.settle();
}

/* Where Tab goes, from the top of the page. */
async function tabs(page, kind) {
  const order = [];
  for (let k = 0; k < 14; k++) {
    await page.press("Tab");
    order.push(await page.evaluate("document.activeElement.id || document.activeElement.className || " +
      "document.activeElement.name || document.activeElement.tagName"));
  }
  const wanted = ["skip", "view", "field", "section", "play", "frame", "wide", "PRE", "SUMMARY"];
  const places = wanted.map((w) => order.indexOf(w));
  check(kind + ": Tab goes through the page in its order", places.every((p, k) => p >= 0 &&
    (k === 0 || p > places[k - 1])), order.join(" "));
  check(kind + ": what is chosen is seen to be", await page.evaluate(`(() => { const e =
    document.getElementById("play"); e.focus({ focusVisible: true }); return getComputedStyle(e).outlineStyle; })()`)
    === "solid");
  await page.evaluate("document.activeElement.blur()");
}

async function looks(browser, folder, kind) {
  const views = { day: { width: 1280 }, night: { width: 1280, dark: true },
    zoomed: { width: 640, height: 450, scale: 2 }, narrow: { width: 340, height: 720, scale: 2 },
    "narrow night": { width: 340, height: 720, dark: true } };
  for (const name of Object.keys(views)) {
    const page = await browser.open(address(folder), views[name]);
    await page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })");
    await page.settle();
    const c = await contrast(page);
    check(kind + ", " + name + ": words stand out, 4.5 to 1", c.least >= 4.5, c.least.toFixed(2) + " " + c.whose);
    equal(kind + ", " + name + ": nothing sticks out", await sticking(page), "");
    equal(kind + ", " + name + ": no words on words", await overlaps(page), "");
    await page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = false; })");
    await page.picture(pictures + "/" + kind + "_" + name.replace(" ", "_") + ".png");
    equal(kind + ", " + name + ": no complaints", page.errors.join("; "), "");
    await page.close();
  }
}

async function everything(browser, folder, kind) {
  const page = await browser.open(address(folder), { width: 1100, height: 950 });
  equal(kind + ": nothing but the page is asked for", page.asked.join(" "), address(folder));
  check(kind + ": the verdict comes first",
    (await page.evaluate("document.querySelector('h1').textContent")).length > 8);
  if (kind === "study") {
    check(kind + ": curves with a band of uncertainty", await page.evaluate(
      "document.querySelectorAll('.panel .band').length") > 0);
    check(kind + ": ... and every run a place",
      await page.evaluate("document.querySelectorAll('.panel circle').length") > 3);
  } else {
    await tabs(page, kind);
    await scrubbing(page, kind);
    await fields(page, kind);
    await turning(page, kind, pictures + "/" + kind + "_solid.png");
  }
  equal(kind + ": no complaints", page.errors.join("; "), "");
  await page.close();
  await looks(browser, folder, kind);
}

/* Without WebGL the section goes on; without scripts there is the picture, and all numbers. */
async function bare(folder, kind) {
  const browser = await browse(program, without);
  try {
    let page = await browser.open(address(folder));
    check(kind + ", no WebGL: the page says so",
      await page.evaluate("document.getElementById('no-solid').hidden") === false);
    check(kind + ", no WebGL: 3D cannot be chosen",
      await page.evaluate("document.querySelector('[value=solid]').disabled"));
    check(kind + ", no WebGL: the section shows matter", (await look(page, "section")).part > 0.2);
    equal(kind + ", no WebGL: no complaints", page.errors.join("; "), "");
    await page.close();
    page = await browser.open(address(folder), { scripts: false });
    await page.picture(pictures + "/" + kind + "_no_scripts.png");
    const { root } = await page.call("DOM.getDocument");
    const found = await page.call("DOM.querySelector", { nodeId: root.nodeId, selector: "noscript img" });
    check(kind + ", no scripts: a picture", found.nodeId > 0);
    await page.close();
  } finally {
    await browser.close();
  }
}

const browser = await browse(program, software);
try {
  for (let k = 0; k + 1 < rest.length; k += 2) await everything(browser, rest[k], rest[k + 1]);
} catch (e) {
  check("no test broke off", false, e.stack);
} finally {
  await browser.close();
}
if (rest.length > 1) await bare(rest[0], rest[1]);
console.log(passed + " passed, " + failed + " failed");
process.exit(failed ? 1 : 0);
