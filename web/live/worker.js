/* worker.js - runs the impact beside the page, so that the page stays quick: in slices, between which it listens.
   Its text and that of engine.js go into a worker made from a blob, which works from a disk too.
   SPDX-License-Identifier: MIT */
"use strict";

function liveWorker() {
  const SLICE = 30;   // ms of computing between two looks at what the page wants
  const SAMPLES = 400; // of the curves, over a whole run
  let engine, left = 0, running = false, computed = 0, chunk = 1, total = 1, sampled = 0;
  let samples = [], drawn = true; // what the page has not got yet; whether it is through with the last frame

  let number = 0; // of the run, which the page gave it
  const say = (kind, what, moved) => postMessage({ kind, number, ...what }, moved ?? []);

  function show() {
    const points = engine.frame(), lines = engine.outline();
    say("frame", { points, lines, samples, left, total, computed, running }, [points.buffer, lines.buffer]);
    samples = [];
    drawn = false;
  }

  /* Some steps, and their time. A sample now and then. */
  function advance(steps) {
    const start = performance.now();
    left = engine.advance(steps);
    sampled += steps;
    if (sampled * SAMPLES >= total || left === 0) {
      samples.push(engine.sample());
      sampled = 0;
    }
    const spent = performance.now() - start;
    computed += spent;
    return spent;
  }

  function slice() {
    if (!running) return;
    const start = performance.now();
    while (left > 0 && performance.now() - start < SLICE) {
      const spent = advance(chunk), most = Math.ceil(total / SAMPLES);
      chunk = Math.max(1, Math.min(most, spent < SLICE / 4 ? 2 * chunk : spent > SLICE / 2 ? chunk >> 1 : chunk));
    }
    if (left === 0) return finish();
    if (drawn) show();
    again.port2.postMessage(0);
  }

  function finish() {
    running = false;
    show();
    say("done", { result: engine.result(), computed });
  }

  /* A timer would wait 4 ms each time. */
  const again = new MessageChannel();
  again.port1.onmessage = () => guarded(slice);

  const wants = {
    async start({ wasm }) {
      engine = await liveEngine(wasm);
      say("ready", { ...engine.metals(), colors: [0, 1, 2].map(engine.colors) });
    },
    begin({ words, number: given }) {
      running = false;
      number = given;
      engine.begin(words);
      samples = [engine.sample()];
      left = total = samples[0].steps;
      computed = sampled = 0;
      chunk = 1;
      say("begun", { scale: engine.scale(), total });
      show();
    },
    run() {
      if (left > 0 && !running) {
        running = true;
        slice();
      }
    },
    stop() {
      running = false;
      show();
    },
    step({ steps }) {
      running = false;
      if (left > 0) advance(steps);
      if (left > 0) show();
      else finish();
    },
    drawn() { drawn = true; },
    lesson() { say("lesson", engine.lesson()); },
  };

  async function guarded(work) {
    try {
      await work();
    } catch (fault) {
      running = false;
      left = 0;
      say("fault", { message: fault.message });
    }
  }
  let before = Promise.resolve(); // what comes while the engine starts waits for it
  onmessage = (event) => { before = before.then(() => guarded(() => wants[event.data.kind](event.data))); };
}
