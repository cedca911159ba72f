/* live.js - starts the page: the worker, the two views and which of them is shown. SPDX-License-Identifier: MIT */
"use strict";

{
  const source = `"use strict";\n${liveEngine}\n${liveWorker}\nliveWorker();`;
  const worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
  const bytes = Uint8Array.from(atob(LIVE_WASM), (letter) => letter.charCodeAt(0));
  const pages = [liveImpact(worker), liveLesson(worker)];

  worker.onmessage = (event) => pages.forEach((page) => page[event.data.kind]?.(event.data));
  worker.onerror = (event) => {
    document.getElementById("fault").textContent = "error: " + event.message;
    document.getElementById("fault").hidden = false;
  };
  worker.postMessage({ kind: "start", wasm: bytes.buffer });

  /* #impact, #step or #step-N */
  const show = () => {
    const step = location.hash.startsWith("#step");
    document.getElementById("impact").hidden = step;
    document.getElementById("step").hidden = !step;
    document.getElementById(step ? "to-step" : "to-impact").setAttribute("aria-current", "page");
    document.getElementById(step ? "to-impact" : "to-step").removeAttribute("aria-current");
    document.title = step ? "mpm.h live: one step" : "mpm.h live: does it bond?";
    dispatchEvent(new Event(step ? "live-step" : "resize"));
  };
  addEventListener("hashchange", show);
  show();
}
