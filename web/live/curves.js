/* curves.js - curves over time as SVG, with a legend that has the last values. SPDX-License-Identifier: MIT */
"use strict";

const SVG = "http://www.w3.org/2000/svg";

/* An SVG element with these attributes. */
function svg(name, attributes, ...children) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/* An HTML element with this text or these children. */
function html(name, attributes, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/* A number for people: so many significant digits, no zeros behind. */
function shown(value, digits = 4) {
  const text = Number(value.toPrecision(digits));
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6)) return text.toExponential().replace("-", "−");
  return String(text).replace("-", "−");
}

/* Nice places between low and high, some four of them. */
function ticks(low, high, want = 4) {
  const raw = (high - low) / want, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((s) => s * power >= raw * 0.999) * power, places = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) places.push(k * step);
  return places;
}

/* A panel: title, unit, and series [{ name, key, scale }] of samples. draw(samples, end) draws them anew. */
function livePanel(title, unit, series) {
  const wide = 340, tall = 170, left = 46, right = 8, top = 12, bottom = 26;
  const frame = svg("svg", { viewBox: `0 0 ${wide} ${tall}`, role: "img" });
  const legend = html("ul", {});
  const values = series.map((one, i) => {
    const value = html("b", {});
    const mark = html("i", {});
    mark.style.borderColor = `var(--series-${i})`;
    legend.append(html("li", {}, mark, one.name, value));
    return value;
  });
  const element = html("div", { class: "panel" }, html("h3", {}, title + " ", html("small", {}, unit)), frame, legend);

  function draw(samples, end) {
    const rows = samples.map((sample) => series.map((one) => sample[one.key] * (one.scale ?? 1)));
    const all = rows.flat();
    let low = Math.min(0, ...all), high = Math.max(0, ...all);
    if (low === high) high = 1;
    const pad = 0.04 * (high - low);
    high += pad;
    if (low < 0) low -= pad;
    const x = (time) => left + (wide - left - right) * time / end;
    const y = (value) => tall - bottom - (tall - top - bottom) * (value - low) / (high - low);
    const parts = [];
    for (const at of ticks(low, high)) {
      parts.push(svg("line", { class: "grid", x1: left, x2: wide - right, y1: y(at), y2: y(at) }),
        svg("text", { x: left - 6, y: y(at) + 4, "text-anchor": "end" }, shown(at, 3)));
    }
    ticks(0, end, 5).forEach((at, k) => {
      const place = { x: x(at), y: tall - bottom + 16, "text-anchor": "middle" };
      parts.push(svg("text", place, shown(at, 3) + (k ? "" : " ns")));
    });
    parts.push(svg("line", { class: "axis", x1: left, x2: wide - right, y1: y(0), y2: y(0) }));
    series.forEach((_, i) => {
      const path = rows.map((row, k) => `${k ? "L" : "M"}${x(samples[k].time).toFixed(1)} ${y(row[i]).toFixed(1)}`);
      parts.push(svg("path", { d: path.join(""), stroke: `var(--series-${i})` }));
      values[i].textContent = rows.length ? shown(rows[rows.length - 1][i], 3) : "";
    });
    frame.replaceChildren(...parts);
    const said = series.map((_, i) => `${series[i].name} ${values[i].textContent}`);
    frame.setAttribute("aria-label", `${title} over time, ${unit}; now ${said.join(", ")}`);
  }
  return { element, draw };
}
