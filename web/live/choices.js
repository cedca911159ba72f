/* choices.js - from what a visitor chose to the words of a command line, those of build/impact: the page runs them, and
   shows them to be repeated on the desktop. SPDX-License-Identifier: MIT */
"use strict";

const LIVE_BONDS = {
  nodes: [["energy", "by dissipated energy"], ["strain", "by strain"], ["none", "none"]],
  surface: [["interface", "adhesion of the interface"], ["none", "none"]],
};

/* Cells across the diameter, and what they mean. The first is where the page starts; `usual` is build/impact's own. */
const LIVE_GRIDS = {
  nodes: [{ cells: 28 / 3, usual: true, words: "9 cells across" }, { cells: 14, words: "14 cells across" },
    { cells: 21, words: "21 cells across" }],
  surface: [{ cells: 14, words: "14 cells across" }, { cells: 20, words: "20 cells across" },
    { cells: 28, usual: true, words: "28 cells across" }],
};

const LIVE_START = { material: "al", substrate: "", model: "preset", diameter: 14, velocity: 810, contact: "nodes",
  bond: "energy", grid: 0 };

/* What of --contact nodes is in proportion to the particle's size, as build/impact has it at 14 um. */
function liveSizes(diameter, grid) {
  const size = diameter / 14, cell = diameter / grid.cells;
  const lengths = Math.abs(size - 1) < 1e-9 ? [] : [["substrate-diameter", 30 * size],
    ["substrate-height", 10 * size], ["time", 80 * size]];
  const fine = lengths.length || !grid.usual ? [["cell", cell], ["spacing", cell / 3],
    ["dt-factor", Math.min(1, 0.1 * cell / 1.5)]] : []; // dt goes with the cell
  return [...lengths, ...fine];
}

/* The words of a choice, those of the defaults left out. */
function liveWords(choice) {
  const grid = LIVE_GRIDS[choice.contact][choice.grid], surface = choice.contact === "surface";
  const words = surface ? ["--method", "surface"] : ["--geometry", "axisymmetric"];
  const put = (name, value) => words.push("--" + name, String(value));
  const rounded = (value) => Number(value.toPrecision(6));
  if (choice.material !== "al") put("material", choice.material);
  if (choice.substrate && choice.substrate !== choice.material) put("substrate-material", choice.substrate);
  if (choice.model !== "preset") put("model", choice.model);
  if (choice.diameter !== 14) put("diameter", choice.diameter);
  if (choice.velocity !== 810) put("velocity", choice.velocity);
  if (choice.bond !== LIVE_BONDS[choice.contact][0][0]) put("bond", choice.bond);
  if (surface) {
    const cell = choice.diameter / grid.cells;
    if (!grid.usual) put("cell", rounded(cell));
    if (cell > 2.5) put("dt-factor", 1); // it would be 0.4 of the cell in um, and may be 1
  }
  if (!surface) for (const [name, value] of liveSizes(choice.diameter, grid)) put(name, rounded(value));
  return words;
}
