// Light and numbers as colours: the scales are those of `lampray diff`.

/** Dark to light, for numbers from 0 up. */
const SEQUENTIAL = [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100], [251, 135, 97], [254, 194, 135], [252, 253, 191]];

/** Blue below 0, near white at it, red above. */
const DIVERGING = [[5, 48, 97], [44, 111, 174], [107, 172, 208], [190, 218, 234], [247, 247, 247], [249, 198, 174], [226, 124, 98], [184, 35, 49], [103, 0, 31]];

/** What has no number. */
const NO_NUMBER = [0, 190, 90];

/** A scale's end needs no more numbers than this. */
const MOST_SORTED = 200000;

/** 256 colours between the stops. */
function ramp(stops) {
  const table = new Uint8Array(256 * 3);
  for (let step = 0; step < 256; step++) {
    const place = (step / 255) * (stops.length - 1);
    const low = Math.min(Math.floor(place), stops.length - 2);
    for (let channel = 0; channel < 3; channel++) {
      const [from, to] = [stops[low][channel], stops[low + 1][channel]];
      table[step * 3 + channel] = Math.round(from + (place - low) * (to - from));
    }
  }
  return table;
}

const RAMPS = { sequential: ramp(SEQUENTIAL), diverging: ramp(DIVERGING) };

/** The scale of a kind of picture; radiance is shown as light and has none. */
function scaleOf(kind) {
  return { bias: "diverging", difference: "diverging", deviation: "sequential" }[kind];
}

/** The byte that a screen shows for linear light: the curve of sRGB. */
function encode(light) {
  if (!(light > 0)) return 0;
  if (light >= 1) return 255;
  return Math.round(255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055));
}

let bytesFor = { exposure: null, table: null };

/** The byte of every half float at an exposure in stops; made once for each. */
function exposedBytes(exposure) {
  if (bytesFor.exposure !== exposure) {
    const gain = 2 ** exposure;
    bytesFor = { exposure, table: Uint8Array.from(HALVES, (value) => encode(value * gain)) };
  }
  return bytesFor.table;
}

/** Light as a screen shows it, into RGBA bytes. */
function paintLight(pixels, halves, exposure) {
  const bytes = exposedBytes(exposure);
  for (let to = 0, from = 0; from < halves.length; to += 4, from += 3) {
    const [red, green, blue] = [halves[from], halves[from + 1], halves[from + 2]];
    const nan = (red & 0x7fff) > 0x7c00 || (green & 0x7fff) > 0x7c00 || (blue & 0x7fff) > 0x7c00;
    pixels[to] = nan ? NO_NUMBER[0] : bytes[red];
    pixels[to + 1] = nan ? NO_NUMBER[1] : bytes[green];
    pixels[to + 2] = nan ? NO_NUMBER[2] : bytes[blue];
    pixels[to + 3] = 255;
  }
}

/** Numbers as colours of a scale that ends at `range`, into RGBA bytes. */
function paintNumbers(pixels, numbers, scale, range) {
  const table = RAMPS[scale];
  for (let at = 0, to = 0; at < numbers.length; at++, to += 4) {
    const share = numbers[at] / range;
    const place = scale === "diverging" ? (share + 1) / 2 : share;
    const step = Math.round(255 * Math.min(1, Math.max(0, place))) * 3;
    const nan = Number.isNaN(place);
    for (let channel = 0; channel < 3; channel++) pixels[to + channel] = nan ? NO_NUMBER[channel] : table[step + channel];
    pixels[to + 3] = 255;
  }
}

/** The size that 99 of 100 numbers stay below: one bright pixel must not rule a scale. */
function usualSize(lists) {
  const total = lists.reduce((sum, list) => sum + list.length, 0);
  const stride = Math.max(1, Math.floor(total / MOST_SORTED));
  const sizes = [];
  for (const list of lists) {
    for (let at = 0; at < list.length; at += stride) if (Number.isFinite(list[at])) sizes.push(Math.abs(list[at]));
  }
  const sorted = Float32Array.from(sizes).sort();
  return sorted[Math.floor(0.99 * (sorted.length - 1))] || 1;
}

/** A bar of colours with its ends in numbers. */
function colourLegend(scale, range, title) {
  const stops = scale === "diverging" ? DIVERGING : SEQUENTIAL;
  const colours = stops.map((stop) => `rgb(${stop.join(" ")})`).join(", ");
  const low = scale === "diverging" ? -range : 0;
  const ends = [low, (low + range) / 2, range].map((value) => element("span", {}, number(value, 2)));
  const bar = element("div", { class: "ramp" });
  bar.style.background = `linear-gradient(to right, ${colours})`;
  return element("div", { class: "colour-legend" }, element("p", {}, title), bar, element("div", { class: "ends" }, ...ends));
}
