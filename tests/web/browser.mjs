/* browser.mjs - drives a headless Chromium over its debugging pipe (the DevTools protocol), with node alone.
   SPDX-License-Identifier: MIT */
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/* Starts it; more: further arguments. close() ends it. */
export async function browse(program, more = []) {
  const profile = mkdtempSync(join(tmpdir(), "mpm-web-"));
  const process = spawn(program, ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage",
    "--hide-scrollbars", "--remote-debugging-pipe", "--user-data-dir=" + profile, ...more, "about:blank"],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
  const waiting = new Map(), listeners = [];
  let number = 0, rest = "";
  process.stdio[4].on("data", (data) => {
    const parts = (rest + data).split("\0");
    rest = parts.pop();
    for (const text of parts) {
      const message = JSON.parse(text);
      if (message.id === undefined) { for (const f of listeners) f(message); continue; }
      const { resolve, reject } = waiting.get(message.id);
      waiting.delete(message.id);
      if (message.error) reject(new Error(message.error.message)); else resolve(message.result);
    }
  });
  process.on("exit", () => { for (const w of waiting.values()) w.reject(new Error("the browser ended")); });
  const send = (method, params = {}, sessionId = undefined) => new Promise((resolve, reject) => {
    waiting.set(++number, { resolve, reject });
    process.stdio[3].write(JSON.stringify({ id: number, method, params, sessionId }) + "\0");
  });
  const close = async () => {
    const gone = new Promise((resolve) => process.once("exit", resolve));
    await Promise.race([send("Browser.close").catch(() => null), gone]);
    await Promise.race([gone, new Promise((r) => setTimeout(r, 3000))]);
    process.kill("SIGKILL");
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  };
  return { send, close, open: (url, view) => open(send, listeners, url, view) };
}

const keyCodes = { ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, Home: 36, End: 35, Tab: 9 };

/* A page at an address, in a window of view = { width, height, scale, dark, scripts }. */
async function open(send, listeners, url, view = {}) {
  const { targetId } = await send("Target.createTarget", { url: "about:blank" });
  const { sessionId } = await send("Target.attachToTarget", { targetId, flatten: true });
  const call = (method, params) => send(method, params, sessionId);
  const errors = [], asked = [];
  let loaded;
  const whole = new Promise((resolve) => { loaded = resolve; });
  listeners.push((m) => {
    if (m.sessionId !== sessionId) return;
    const p = m.params;
    if (m.method === "Runtime.exceptionThrown") errors.push(p.exceptionDetails.exception?.description ||
      p.exceptionDetails.text);
    if (m.method === "Runtime.consoleAPICalled" && (p.type === "error" || p.type === "warning"))
      errors.push(p.args.map((a) => a.value).join(" "));
    if (m.method === "Log.entryAdded" && (p.entry.level === "error" || p.entry.level === "warning"))
      errors.push(p.entry.text);
    if (m.method === "Network.requestWillBeSent") asked.push(p.request.url);
    if (m.method === "Page.loadEventFired") loaded();
  });
  for (const part of ["Page", "Runtime", "Log", "Network"]) await call(part + ".enable");
  await call("Emulation.setDeviceMetricsOverride", { width: view.width || 1100, height: view.height || 900,
    deviceScaleFactor: view.scale || 1, mobile: false });
  await call("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme",
    value: view.dark ? "dark" : "light" }] });
  if (view.scripts === false) await call("Emulation.setScriptExecutionDisabled", { value: true });
  await call("Page.navigate", { url });
  await whole;
  const evaluate = async (text) => {
    const r = await call("Runtime.evaluate", { expression: text, awaitPromise: true, returnByValue: true });
    if (r.exceptionDetails) throw new Error(r.exceptionDetails.exception?.description || r.exceptionDetails.text);
    return r.result.value;
  };
  const settle = () => evaluate("new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))");
  const page = {
    errors, asked, evaluate, settle, call,
    async press(key) {
      const what = { key, code: key, windowsVirtualKeyCode: keyCodes[key] || key.toUpperCase().charCodeAt(0) };
      await call("Input.dispatchKeyEvent", { type: "keyDown", ...what, ...(key.length === 1 ? { text: key } : {}) });
      await call("Input.dispatchKeyEvent", { type: "keyUp", ...what });
      await settle();
    },
    async picture(path, whole = true) {
      const size = (await call("Page.getLayoutMetrics")).cssContentSize;
      const r = await call("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole,
        ...(whole ? { clip: { x: 0, y: 0, width: size.width, height: size.height, scale: 1 } } : {}) });
      writeFileSync(path, Buffer.from(r.data, "base64"));
    },
    close: () => send("Target.closeTarget", { targetId })
  };
  if (view.scripts !== false) await settle();
  return page;
}

/* Arguments for WebGL in software, and for none. */
export const software = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
export const without = ["--disable-gpu", "--disable-3d-apis"];
