/* live_page.mjs - the live page in a headless Chromium: it loads, runs, stops, steps, gives a verdict, shows the worked
   point; by keyboard, enlarged, in the dark, on a narrow screen, from a server and from a disk. Pictures to look at go
   to build/web-pictures. node tests/web/live_page.mjs CHROMIUM, from the top folder. SPDX-License-Identifier: MIT */
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { check, checkEnd } from "./live_check.mjs";
import { chromium } from "./live_chromium.mjs";

const PICTURES = "build/web-pictures/", WEB = path.resolve("build/web");
fs.mkdirSync(PICTURES, { recursive: true });
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/* A plain server of the folder; what it does not have, and what is asked of others, is missed. */
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".png": "image/png" };
const asked = [];
const server = http.createServer((request, response) => {
  const file = path.join(WEB, new URL(request.url, "http://x").pathname);
  asked.push(request.url);
  if (!file.startsWith(WEB) || !fs.existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "application/octet-stream" });
  fs.createReadStream(file).pipe(response);
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const url = `http://127.0.0.1:${server.address().port}/index.html`;
const browser = await chromium(process.argv[2], path.resolve("build/tests/live-chromium"));

const READY = "!document.getElementById('run').disabled && !document.getElementById('step-one').disabled";
const page = await browser.open(url);
const text = (id) => page.eval(`document.getElementById(${JSON.stringify(id)}).textContent`);
const click = (id) => page.eval(`document.getElementById(${JSON.stringify(id)}).click()`);
const step = async () => Number((await text("state")).match(/step (\d+) of/)?.[1]);
const choose = (name, value) => page.eval(`{ const one = document.getElementById("choices").elements.${name};
  one.value = ${JSON.stringify(String(value))}; one.dispatchEvent(new Event("change", { bubbles: true })); }`);
const pixels = () => page.eval(`{ const c = document.getElementById("stage");
  Array.from(c.getContext("2d").getImageData(0, 0, c.width, c.height).data).reduce((h, x) => (h * 31 + x) | 0, 7) }`);

/* ---- the impact ---- */

const at9917 = (k) => `document.getElementById("state").textContent.includes("step ${k} of 9917")`;

await page.size(1280, 900);
check("the page is ready", await page.until(READY, 30));
check("curves have scales before they have a course", await page.eval(`[...document.querySelectorAll("#panels svg")]
  .map((one) => [...one.querySelectorAll("text")].map((word) => word.textContent))
  .every((words) => words.length > 5 && new Set(words).size === words.length)`));
check("it shows the command", (await text("command")) === "build/impact --geometry axisymmetric");
await page.picture(PICTURES + "impact-ready.png");

await click("step-one");
check("one step is one step", await page.until(at9917(1), 5));
await page.eval("document.getElementById('stage').focus()");
await page.key("ArrowRight");
check("the right arrow takes one more", await page.until(at9917(2), 5));
await page.key(" ");
check("space runs", await page.until("document.getElementById('progress').value > 0.05", 30));
check("... the button says stop", (await text("run")) === "Stop");
await page.eval(`window.gap = 0; { let last = performance.now(); requestAnimationFrame(function look(now) {
  gap = Math.max(gap, now - last); last = now; requestAnimationFrame(look); }) }`);
await wait(1500);
const gap = await page.eval("gap");
console.log(`# longest time between two drawings while it runs: ${gap.toFixed(0)} ms`);
check("the page stays quick while it runs", gap < 500, gap);
await page.key(" ");
await page.until("document.getElementById('run').textContent === 'Run'", 5);
await wait(300);
const stopped = await step();
await wait(500);
check("space stops it", stopped > 2 && stopped === await step(), stopped);
await page.picture(PICTURES + "impact-stopped.png");

const before = await pixels();
await page.eval(`{ const field = document.getElementById("field"); field.value = "temperature"; field.onchange(); }`);
await wait(400);
check("another field, another bar", (await text("bar")).startsWith("temperatureK"));
check("... and picture", before !== await pixels());
const bare = await pixels();
await click("grid-lines");
await wait(400);
check("the grid is drawn", bare !== await pixels());
await page.dark(true);
await wait(400);
await page.picture(PICTURES + "impact-dark.png");
await page.dark(false);

await click("run");
const done = await page.until("!document.getElementById('outcome').hidden", 180);
check("it comes to a verdict", done, await text("state"));
console.log(`# ${(await text("lead")).match(/[\d.]+ s of computing/)}, on the clock, in the browser`);
check("... the desktop's", (await text("headline")) === "It stays.", await text("headline"));
check("... with its numbers", (await text("lead")).includes("mean velocity is −0.38 m/s") &&
  (await text("numbers")).includes("rebound velocity, mean−0.38043m/s"), await text("lead"));
check("... said to who cannot see", (await text("spoken")).startsWith("It stays."));
check("three curves over the whole run", await page.until(`[...document.querySelectorAll("#panels svg")].length === 3 &&
  [...document.querySelectorAll("#panels path")].every((one) => one.getAttribute("d").split("L").length > 300)`, 5));
await page.picture(PICTURES + "impact-verdict.png");
await click("again");
check("from the start", await page.until(at9917(0), 10));

await choose("bond", "none");
await page.until(READY, 10);
await click("run");
check("without a bond it rebounds",
  await page.until("document.getElementById('headline').textContent.startsWith('It rebounds at')", 180));
check("... and the command says so", (await text("command")).endsWith("axisymmetric --bond none"));
await page.eval("document.querySelector('#choices [value=surface]').click()");
check("contact on surfaces has other bonds", await page.until(`document.getElementById("command").textContent ===
  "build/impact --method surface --bond none --cell 1" && ${READY}`, 10), await text("command"));
await choose("bond", "interface");
await choose("material", "cu");
await page.until(READY, 10);
await click("run");
check("it runs", await page.until("document.getElementById('progress').value > 0.15", 120));
await click("run");
await wait(500);
await page.picture(PICTURES + "impact-surface.png");
await choose("velocity", -5);
check("what makes no sense cannot be run", await page.eval("document.getElementById('run').disabled"));
await choose("velocity", 300);
await page.eval(`{ const offered = liveWords; liveWords = (choice) => [...offered(choice), "--material", "cheese"]; }`);
await choose("velocity", 310);
check("what the program refuses is shown in its words", await page.until(`!document.getElementById("fault").hidden &&
  document.getElementById("fault").textContent.startsWith("error: --material cheese: a name is not known")`, 10),
  await text("fault"));
check("no errors so far", page.errors.length === 0, page.errors.join("; "));

/* ---- the step ---- */

const worked = fs.readFileSync("docs/method.md", "utf8").split("```text\n")[1].split("```")[0];
const EXPECTED = [["5.7657 5.2550 4.6508", "0.19918"], ["0.23568", "-13.8794"], ["-1536.5746"], ["-26.1720"],
  ["0.01750 0.00000 -0.99985"], ["0.23568, P_a = 14.0102 0.0000 -26.1720", "1.28102, P_b = -11.1285 0.0000 -66.5026",
    "12.0070", "13.8001 0.0000 -14.1668"], ["-52.712", "-52.922"], ["-93.688", "-145.560"],
  ["0.1636   0.0270  -0.3723", "0.0652   0.0561  -0.6499", "-6496.4"],
  ["5.7658 5.2551 4.6499", "63.225 28.878 -52.922"]];
await page.go(url + "#step");
await page.until("document.getElementById('arithmetic').textContent.length > 10", 20);
for (let k = 0; k < EXPECTED.length; k++) {
  const said = await text("arithmetic");
  const missing = EXPECTED[k].filter((number) => !said.includes(number) || !worked.includes(number));
  check(`phase ${k + 1}, ${await text("step-title")}`, missing.length === 0, missing.join(", "));
  const link = await page.eval("document.querySelector('#step-link a').getAttribute('href')");
  check("... its section is there", fs.readFileSync(path.join(WEB, "method.html"), "utf8")
    .includes(`id="${link.split("#")[1]}"`), link);
  await page.picture(`${PICTURES}step-${k + 1}.png`);
  if (k + 1 < EXPECTED.length) await (k % 2 ? page.key("ArrowRight") : click("forward"));
  await wait(120);
}
const cells = (await page.eval("[...document.querySelectorAll('#nodes tbody td')].map((one) => one.textContent)"));
const rows = worked.split("after contact\n")[1].split("contact at")[0].trim().split(/\s+/);
const rowIsSame = (k) => rows.slice(12 * k + 3, 12 * k + 12).every((number, c) => number === cells[10 * k + c]);
check("the table is that of docs/method.md", cells.length === 80 && rows.length === 96 &&
  [...Array(8).keys()].every(rowIsSame), cells.slice(0, 10).join(" "));
await page.key("ArrowLeft");
check("the left arrow goes back", (await text("step-title")).startsWith("9 of 10"));
check("... and the address knows", (await page.eval("location.hash")) === "#step-9");

/* ---- for everyone ---- */

const PLACES = ["index.html#impact", "index.html#step-6", "method.html"];
const at = async (place) => {
  await page.go("about:blank");
  await page.go(url.replace("index.html", place));
  await page.until("document.readyState === 'complete'", 10);
  if (place.includes("step")) await page.until("document.getElementById('arithmetic').textContent.length > 10", 20);
  if (place.includes("impact")) await page.until(READY, 20);
};
const wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth";
for (const [name, width, height, zoom] of [["200 %", 1280, 900, 2], ["narrow", 320, 700, 1], ["400 %", 1280, 1024, 4]])
  for (const place of PLACES) {
    await page.size(width, height, zoom);
    await at(place);
    check(`${place}, ${name}: nothing sticks out`, await page.eval(wide) <= 0, await page.eval(wide));
    await page.picture(`${PICTURES}${place.replace(/\W+/g, "-")}-${name.replace(/\W/g, "")}.png`);
  }
await page.size(1280, 900);

/* Words on their ground: 4.5 to 1 at least (WCAG 2.2, AA). */
const CONTRAST = `(() => {
  const numbers = (color) => color.match(/[\\d.]+/g).map(Number);
  const linear = (x) => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
  const light = (color) => numbers(color).slice(0, 3).map((x) => linear(x / 255))
    .reduce((sum, x, i) => sum + x * [0.2126, 0.7152, 0.0722][i], 0);
  const ground = (one) => {
    const own = getComputedStyle(one).backgroundColor;
    return (numbers(own)[3] ?? 1) > 0.99 || !one.parentElement ? own : ground(one.parentElement);
  };
  const words = [...document.querySelectorAll("body *")].filter((one) => one.offsetParent && !one.disabled &&
    [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim()));
  return words.map((one) => {
    const [high, low] = [light(getComputedStyle(one).color), light(ground(one))].sort((a, b) => b - a);
    return [(high + 0.05) / (low + 0.05), one.tagName + "." + one.className + " " + one.textContent.slice(0, 20)];
  }).sort((a, b) => a[0] - b[0])[0];
})()`;
for (const dark of [false, true])
  for (const place of PLACES) {
    await page.dark(dark);
    await at(place);
    await wait(200);
    const [ratio, where] = await page.eval(CONTRAST);
    const name = `${place}${dark ? " in the dark" : ""}: words stand out, ${ratio.toFixed(1)} to 1 at least`;
    check(name, ratio >= 4.5, where);
  }
await page.dark(false);
await at("index.html#impact");
const CONTROLS = "input, select, button, canvas, progress";
const nameless = await page.eval(`[...document.querySelectorAll("${CONTROLS}")].filter((one) => !(
  one.labels?.length || one.getAttribute("aria-label") || one.textContent.trim())).map((one) => one.outerHTML)`);
check("all controls have names", nameless.length === 0, nameless.join(" "));
const reached = new Set();
for (let k = 0; k < 24; k++) {
  await page.key("Tab");
  reached.add(await page.eval("(({ id, name, tagName }) => id || name || tagName)(document.activeElement)"));
}
const wanted = ["to-step", "material", "substrate", "model", "diameter", "velocity", "contact", "bond", "grid", "run",
  "step-one", "again", "field", "grid-lines", "stage"];
check("all controls are reached by the Tab key", wanted.every((name) => reached.has(name)), [...reached].join(" "));
check("no errors in all of this", page.errors.length === 0, page.errors.join("; "));
check("nothing but its own files was asked for", asked.every((name) => fs.existsSync(path.join(WEB, name))),
  asked.join(" "));

/* ---- from a disk ---- */

const disk = await browser.open("file://" + path.join(WEB, "index.html"));
check("opened from a disk, it is ready", await disk.until(READY, 30));
await disk.eval("document.getElementById('run').click()");
check("... and runs", await disk.until("document.getElementById('progress').value > 0.02", 30));
check("... without errors", disk.errors.length === 0, disk.errors.join("; "));
await browser.close();
server.close();
checkEnd();
