/* live_check.mjs - what the tests of the live page share: one line a check, and the closing line; the page's scripts as
   functions. SPDX-License-Identifier: MIT */
import fs from "node:fs";

let passed = 0, failed = 0;

export function check(name, ok, why = "") {
  if (ok) passed++;
  else failed++;
  console.log(ok ? `ok - ${name}` : `not ok - ${name}${why === "" ? "" : ": " + why}`);
  return ok;
}

/* |got - wanted| <= tolerance * |wanted| */
export function near(name, got, wanted, tolerance) {
  return check(name, Math.abs(got - wanted) <= tolerance * Math.abs(wanted), `${got}, not ${wanted}`);
}

export function checkEnd() {
  console.log(`${passed} passed, ${failed} failed`);
  process.exitCode = failed ? 1 : 0;
}

/* What a script of web/live defines under these names. */
export function script(file, ...names) {
  return new Function(`${fs.readFileSync("web/live/" + file, "utf8")}; return { ${names.join(", ")} };`)();
}
