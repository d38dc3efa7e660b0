// Assertions that are counted, and the list of those that failed.

const failed = [];
let passed = 0;

/** Notes whether something holds; `seen` is what was there instead. */
export function holds(what, truth, seen = "") {
  if (truth) passed += 1;
  else failed.push(`${what}${seen === "" ? "" : `: ${JSON.stringify(seen)}`}`);
}

export function equal(what, seen, wanted) {
  holds(`${what} (wanted ${JSON.stringify(wanted)})`, JSON.stringify(seen) === JSON.stringify(wanted), seen);
}

/** Says what failed and how many held; true where all did. */
export function verdict() {
  for (const each of failed) console.log(`FAILED ${each}`);
  console.log(`${passed} checks passed, ${failed.length} failed`);
  return failed.length === 0 && passed > 0;
}
