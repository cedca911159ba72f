/* engine.js - live.wasm for a page, a worker or node: starts it, and turns its numbers, arrays and texts into those of
   JavaScript. Without imports of its own, so that its text can be put into a worker. SPDX-License-Identifier: MIT */
"use strict";

/* Of the bytes of live.wasm, or of a compiled module: a promise of the engine. */
async function liveEngine(source) {
  let errors = ""; // what the C code wrote to stderr since the last look
  const utf8 = new TextDecoder();
  const view = () => new DataView(wasm.memory.buffer); // memory grows: no view lasts

  // What the C library asks of a system. There are no files, and the clock is only for names of files.
  const system = {
    fd_write(fd, vectors, count, written) {
      const at = view();
      let sum = 0;
      for (let i = 0; i < count; i++) {
        const from = at.getUint32(vectors + 8 * i, true), bytes = at.getUint32(vectors + 8 * i + 4, true);
        errors += utf8.decode(new Uint8Array(wasm.memory.buffer, from, bytes));
        sum += bytes;
      }
      at.setUint32(written, sum, true);
      return 0;
    },
    proc_exit(code) { throw new Error("exit " + code); },
  };
  const NOT_SUPPORTED = 58;
  const compiled = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  const imports = {};
  for (const wanted of WebAssembly.Module.imports(compiled)) {
    imports[wanted.module] ??= {};
    imports[wanted.module][wanted.name] = system[wanted.name] ?? (() => NOT_SUPPORTED);
  }
  const wasm = (await WebAssembly.instantiate(compiled, imports)).exports;

  const doubles = (at, n) => Array.from(new Float64Array(wasm.memory.buffer, at, n));
  const floats = (at, n) => new Float32Array(wasm.memory.buffer, at, n).slice();
  const text = () => {
    const bytes = new Uint8Array(wasm.memory.buffer, wasm.live_text(), wasm.live_text_bytes());
    return utf8.decode(bytes.subarray(0, bytes.indexOf(0)));
  };
  const fault = () => {
    const said = errors.trim() || "error: no memory";
    errors = "";
    return new Error(said);
  };
  const need = (done) => { if (!done) throw fault(); };
  /* A table of the lesson as rows of numbers. */
  const table = (at, count, columns) => {
    const all = doubles(at, count * columns), rows = [];
    for (let i = 0; i < count; i++) rows.push(all.slice(i * columns, (i + 1) * columns));
    return rows;
  };

  return {
    module: compiled,

    /* { version, metals: [{ name, own, models }] }: a metal's own strength, and those that it has sets for. */
    metals() {
      wasm.live_metals();
      const [version, ...lines] = text().trim().split("\n");
      const metals = lines.map((line) => line.split(" ")).map(([name, own, ...models]) => ({ name, own, models }));
      return { version, metals };
    },

    /* 256 colours of map 0 (deep), 1 (heat) or 2 (diverging), as [r, g, b]. */
    colors(map) {
      return Array.from({ length: 256 }, (_, i) => {
        const c = wasm.live_color(map, i / 255);
        return [c >> 16 & 255, c >> 8 & 255, c & 255];
      });
    },

    /* Begins the run of these words of a command line. Throws what the program would say. */
    begin(words) {
      const bytes = new TextEncoder().encode(words.map((word) => word + "\0").join("") + "\0");
      if (bytes.length > wasm.live_text_bytes()) throw new Error("error: too many words");
      new Uint8Array(wasm.memory.buffer, wasm.live_text(), bytes.length).set(bytes);
      errors = "";
      need(wasm.live_begin(words.length));
    },

    /* Some steps more: how many are left. */
    advance(steps) {
      const left = wasm.live_advance(steps);
      need(left >= 0);
      return left;
    },

    /* The points now, 8 floats each: x, z, body, strain, temperature, pressure, velocity, bond. */
    frame() {
      const at = wasm.live_frame();
      need(at);
      return floats(at, 8 * wasm.live_frame_count());
    },

    /* The surfaces' lines now, 5 floats each: x and z of both ends, 1 where they adhere. */
    outline() {
      const at = wasm.live_outline();
      need(at);
      return floats(at, 5 * wasm.live_outline_count());
    },

    sample() {
      const [time, velocity, kinetic, plastic, elastic, dampers, contact, bond, area, bonded, hottest, end, steps,
        points] = doubles(wasm.live_sample(), 14);
      return { time, velocity, kinetic, plastic, elastic, dampers, contact, bond, area, bonded, hottest, end, steps,
        points };
    },

    scale() {
      const [cold, hot, speed, pressure, edge, bottom, top, spacing] = doubles(wasm.live_scale(), 8);
      return { cold, hot, speed, pressure, edge, bottom, top, spacing };
    },

    /* { verdict, rows: [[what, unit, value]] } */
    result() {
      wasm.live_result();
      const [verdict, ...lines] = text().trimEnd().split("\n");
      const rows = lines.map((line) => line.split("\t")).map(([what, unit, value]) => [what, unit, Number(value)]);
      return { verdict, rows };
    },

    digits: () => doubles(wasm.live_digits(), 9),
    end: () => wasm.live_end(),

    /* One step of the worked point: the state after 100 steps, then after each phase of the next, eleven looks. Of all
       points those of its layer, y = 5 to 5.5; of the nodes those before and behind it, y = 5 and 6, by their slot. */
    lesson() {
      const looks = [];
      const points = () => table(wasm.live_lesson_points(), wasm.live_lesson_point_count(), 17)
        .filter((p) => p[3] > 5 && p[3] < 5.5)
        .map((p) => ({ id: p[0], body: p[1], x: p.slice(2, 5), v: p.slice(5, 8), mass: p[8], density: p[9],
          stress: p.slice(10, 16) }));
      const nodes = () => new Map(table(wasm.live_lesson_nodes(), wasm.live_lesson_node_count(), 19)
        .filter((n) => n[1] === 5 || n[1] === 6)
        .map((n) => [n[18], { x: n.slice(0, 3), body: n[3], mass: n[4], momentum: n.slice(5, 8),
          force: n.slice(8, 11), velocity: n.slice(11, 14), gradient: n.slice(14, 17) }]));
      const pairs = () => table(wasm.live_lesson_pairs(), wasm.live_lesson_pair_count(), 8)
        .map((p) => ({ a: p[0], b: p[1], normal: p.slice(2, 5), impulse: p.slice(5, 8) }));
      const support = () => table(wasm.live_lesson_support(), 8, 5)
        .map((s) => ({ slot: s[0], N: s[1], G: s.slice(2, 5) }));
      const look = (phase) => looks.push({ points: points(), nodes: phase < 0 ? new Map() : nodes(),
        pairs: phase < 4 ? [] : pairs(), support: phase === 0 ? support() : looks[1]?.support ?? [],
        strain: doubles(wasm.live_lesson_strain(), 9) });
      need(wasm.live_lesson());
      look(-1);
      for (let phase = 0; phase < 10; phase++) {
        need(wasm.live_lesson_phase(phase));
        look(phase);
      }
      return { looks, chosen: wasm.live_lesson_chosen() };
    },
  };
}
