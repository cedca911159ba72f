/* live_chromium.mjs - drives a headless Chromium through its own pipe, without packages: open a page, evaluate, press
   keys, take a picture. SPDX-License-Identifier: MIT */
import { spawn } from "node:child_process";
import fs from "node:fs";

const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--remote-debugging-pipe"];

const KEYS = { ArrowRight: 39, ArrowLeft: 37, Tab: 9, Enter: 13, " ": 32 };

/* Starts the browser with a fresh folder of its own. */
export async function chromium(program, folder) {
  fs.rmSync(folder, { recursive: true, force: true });
  const browser = spawn(program, [...FLAGS, "--user-data-dir=" + folder, "about:blank"],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
  const waiting = new Map(), listeners = [];
  const gone = new Promise((resolve) => browser.on("exit", resolve));
  gone.then(() => waiting.forEach(({ reject }) => reject(new Error("the browser has ended"))));
  let last = 0, rest = "";
  browser.stdio[4].setEncoding("utf8").on("data", (data) => {
    const messages = (rest + data).split("\0");
    rest = messages.pop();
    for (const message of messages.map((text) => JSON.parse(text))) {
      const { resolve, reject } = waiting.get(message.id) ?? {};
      waiting.delete(message.id);
      if (message.error) reject?.(new Error(message.error.message));
      else resolve?.(message.result);
      if (message.method) listeners.forEach((listen) => listen(message));
    }
  });

  const ask = (method, params = {}, sessionId = undefined) => new Promise((resolve, reject) => {
    waiting.set(++last, { resolve, reject });
    browser.stdio[3].write(JSON.stringify({ id: last, method, params, sessionId }) + "\0");
  });

  /* A page of its own: everything it complains of goes to page.errors. */
  async function open(url) {
    const { targetId } = await ask("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await ask("Target.attachToTarget", { targetId, flatten: true });
    const tell = (method, params) => ask(method, params, sessionId);
    const page = { errors: [] };
    listeners.push((message) => {
      const { method, params } = message;
      if (message.sessionId !== sessionId) return;
      if (method === "Runtime.exceptionThrown") page.errors.push(params.exceptionDetails.exception?.description ?? "?");
      if (method === "Runtime.consoleAPICalled" && params.type === "error") page.errors.push(params.args[0]?.value);
      if (method === "Log.entryAdded" && params.entry.level === "error") page.errors.push(params.entry.text);
    });
    await Promise.all(["Runtime.enable", "Page.enable", "Log.enable"].map((method) => tell(method)));
    page.go = (to) => tell("Page.navigate", { url: to });
    page.eval = async (expression) => {
      const { result, exceptionDetails } = await tell("Runtime.evaluate",
        { expression, awaitPromise: true, returnByValue: true });
      if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? expression);
      return result.value;
    };
    /* Waits until the expression is true, so many seconds at most; whether it was. */
    page.until = async (expression, seconds) => {
      for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
        if (await page.eval(expression).catch(() => false)) return true;
        await new Promise((resolve) => setTimeout(resolve, 60));
      }
      return false;
    };
    page.key = async (key) => {
      const text = key === " " ? " " : key === "Enter" ? "\r" : undefined;
      const what = { key, code: key === " " ? "Space" : key, windowsVirtualKeyCode: KEYS[key], text };
      await tell("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", ...what });
      await tell("Input.dispatchKeyEvent", { type: "keyUp", ...what });
    };
    page.size = (width, height, zoom = 1) => tell("Emulation.setDeviceMetricsOverride",
      { width: Math.round(width / zoom), height: Math.round(height / zoom), deviceScaleFactor: zoom, mobile: false });
    page.dark = (dark) => tell("Emulation.setEmulatedMedia",
      { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    page.picture = async (file, whole = true) => {
      const { data } = await tell("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole });
      fs.writeFileSync(file, Buffer.from(data, "base64"));
    };
    await page.go(url);
    return page;
  }

  async function close() {
    await ask("Browser.close").catch(() => {});
    await gone;
    fs.rmSync(folder, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }
  return { open, close };
}
