// Numbers as people read them.

const NOTHING = "–";

/** Digits set high, for powers of ten. */
function superscript(whole) {
  return [...String(whole)].map((digit) => (digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])).join("");
}

/** With a true minus; what has been rounded to zero has no sign. */
function withMinus(text) {
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

function isMissing(value) {
  return value === null || value === undefined || Number.isNaN(value);
}

/** A number to so many significant digits; powers of ten where zeros would be counted. */
function number(value, digits = 3) {
  if (isMissing(value)) return NOTHING;
  if (!Number.isFinite(value)) return value < 0 ? "−∞" : "∞";
  if (value === 0) return "0";
  const [mantissa, power] = Math.abs(value).toExponential(digits - 1).split("e");
  const sign = value < 0 ? "−" : "";
  if (power < -3 || power > 5) return `${sign}${mantissa}×10${superscript(Number(power))}`;
  return sign + Math.abs(value).toFixed(Math.max(0, digits - 1 - power));
}

/** A whole number in groups of three. */
function count(value) {
  if (isMissing(value)) return NOTHING;
  return withMinus(String(value)).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

/** A tick's label: no more digits than it needs. */
function tickText(value) {
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  if (power < -3 || power > 5) {
    const mantissa = Number((value / 10 ** power).toPrecision(3));
    return withMinus(mantissa === 1 ? `10${superscript(power)}` : `${mantissa}×10${superscript(power)}`);
  }
  const text = withMinus(String(Number(value.toPrecision(4))));
  return Math.abs(value) < 10000 ? text : count(text);
}

/** How numbers with intervals are written. */
const PLAIN = { times: 1, end: "", sign: "" };
const PERCENT = { times: 100, end: "\u202f%", sign: "" };
const SIGNED_PERCENT = { times: 100, end: "\u202f%", sign: "+" };

/** The place of the last digit that an interval leaves: two of its half-width, one from 3 on. */
function lastPlace(halfWidth) {
  const power = Math.floor(Math.log10(halfWidth));
  return halfWidth / 10 ** power < 3 ? power - 1 : power;
}

/** A writer of numbers around `size` to a place: powers of ten where zeros would be counted. */
function writer(size, place) {
  const power = Math.floor(Math.log10(size));
  const shift = power < -3 || power > 5 ? power : 0;
  const decimals = Math.min(12, Math.max(0, shift - place));
  return { write: (value) => (value / 10 ** shift).toFixed(decimals), end: shift === 0 ? "" : `×10${superscript(shift)}` };
}

/** A value and its range as texts of the same number of decimals. */
function intervalParts({ value, low, high }, unit = PLAIN) {
  const [middle, least, most] = [value, low, high].map((each) => (isMissing(each) ? each : each * unit.times));
  if (isMissing(middle)) return { value: NOTHING, range: "", half: NOTHING };
  const halfWidth = (most - least) / 2;
  const signed = (text) => withMinus(unit.sign && Number(text) > 0 ? unit.sign + text : text);
  if (!(halfWidth > 0) || !Number.isFinite(halfWidth)) return { value: signed(number(middle)) + unit.end, range: "", half: NOTHING };
  const { write, end } = writer(Math.max(Math.abs(middle), Math.abs(least), Math.abs(most)), lastPlace(halfWidth));
  return { value: signed(write(middle)) + end + unit.end, range: `[${signed(write(least))}, ${signed(write(most))}]`, half: write(halfWidth) + end };
}

/** A value and its interval in one line, for tips and captions. */
function intervalText(interval, unit) {
  if (!interval) return NOTHING;
  const { value, range } = intervalParts(interval, unit);
  return `${value} ${range}`.trim();
}

/** A value with its interval below it, for cells. */
function intervalCell(interval, unit) {
  if (!interval) return NOTHING;
  const { value, range } = intervalParts(interval, unit);
  return element("span", { class: "interval" }, value, range ? element("small", {}, range) : null);
}

/** Words in which a number keeps its percent sign beside it. */
function typeset(sentence) {
  return sentence.replace(/(\d) (?=%)/g, "$1\u202f");
}
