// Half floats: a picture stays 16 bits a number, and a table says what they mean.

/** The number of every half float there is. */
const HALVES = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; bits++) {
    const exponent = (bits >> 10) & 31;
    const fraction = bits & 1023;
    let value = exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    if (exponent === 31) value = fraction === 0 ? Infinity : NaN;
    table[bits] = bits < 32768 ? value : -value;
  }
  return table;
})();

const MOST_DECODED = 48;
const decoded = new Map();

/** The picture's halves, R G B interleaved; those used last are kept. */
function halvesOf(index) {
  const known = decoded.get(index);
  if (known) return known;
  const image = data.images[index];
  const text = atob(image.half);
  const halves = new Uint16Array(image.width * image.height * 3);
  const end = Math.min(halves.length, text.length >> 1);
  for (let at = 0; at < end; at++) halves[at] = text.charCodeAt(2 * at) | (text.charCodeAt(2 * at + 1) << 8);
  if (decoded.size >= MOST_DECODED) decoded.delete(decoded.keys().next().value);
  decoded.set(index, halves);
  return halves;
}

/** Red, green and blue of a pixel. */
function pixel(index, x, y) {
  const halves = halvesOf(index);
  const at = (y * data.images[index].width + x) * 3;
  return [HALVES[halves[at]], HALVES[halves[at + 1]], HALVES[halves[at + 2]]];
}

/** Mean of the three channels, pixel by pixel. */
function grey(index) {
  const halves = halvesOf(index);
  const means = new Float32Array(halves.length / 3);
  for (let at = 0, from = 0; at < means.length; at++, from += 3) {
    means[at] = (HALVES[halves[from]] + HALVES[halves[from + 1]] + HALVES[halves[from + 2]]) / 3;
  }
  return means;
}
