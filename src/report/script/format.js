// Numbers as people read them.

const NOTHING = "–";

/** Digits set high, for powers of ten. */
function superscript(whole) {
  return [...String(whole)].map((digit) => (digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])).join("");
}

function withMinus(text) {
  return text.replace("-", "−");
}

/** A number to so many significant digits; powers of ten where zeros would be counted. */
function number(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return NOTHING;
  if (!Number.isFinite(value)) return value < 0 ? "−∞" : "∞";
  if (value === 0) return "0";
  const [mantissa, power] = Math.abs(value).toExponential(digits - 1).split("e");
  const sign = value < 0 ? "−" : "";
  if (power < -3 || power > 5) return `${sign}${mantissa}×10${superscript(Number(power))}`;
  return sign + Math.abs(value).toFixed(Math.max(0, digits - 1 - power));
}

/** A whole number in groups of three. */
function count(value) {
  if (value === null || value === undefined) return NOTHING;
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
  return withMinus(String(Number(value.toPrecision(4))));
}

/** How many digits of a value its interval leaves: two of the interval's width. */
function digitsWithin(interval) {
  const width = (interval.high - interval.low) / 2;
  const size = Math.max(Math.abs(interval.value), width);
  if (!(width > 0) || !(size > 0)) return 3;
  return Math.min(7, Math.max(2, Math.floor(Math.log10(size)) - Math.floor(Math.log10(width)) + 2));
}

/** Decimals that show an interval's width with two digits. */
function rangeText(interval, show = number) {
  const width = interval.high - interval.low;
  if (!(width > 0)) return "";
  const digits = (value) => digitsWithin({ ...interval, value });
  return `[${show(interval.low, digits(interval.low))}, ${show(interval.high, digits(interval.high))}]`;
}

/** A share as percent. */
function percent(value, digits = 3) {
  const text = number(value === null || value === undefined ? value : value * 100, digits);
  return text === NOTHING ? text : `${text}\u202f%`;
}

/** A share with its sign, as percent. */
function signedPercent(value, digits) {
  return (value > 0 ? "+" : "") + percent(value, digits);
}

/** A value and its interval in one line, for tips and captions. */
function intervalText(interval, show = number) {
  if (!interval) return NOTHING;
  return `${show(interval.value, digitsWithin(interval))} ${rangeText(interval, show)}`.trim();
}

/** A value with its interval below it, for cells. */
function intervalCell(interval, show = number) {
  if (!interval || interval.value === null) return NOTHING;
  const range = rangeText(interval, show);
  const value = show(interval.value, digitsWithin(interval));
  return element("span", { class: "interval" }, value, range ? element("small", {}, range) : null);
}
