// Pictures of a made-up room, as half floats in base64.

/** Numbers in 0..1, the same at every call with the same seed. */
export function stream(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x9e3779b9) >>> 0;
    let word = Math.imul(state ^ (state >>> 16), 0x21f0aaad);
    word = Math.imul(word ^ (word >>> 15), 0x735a2d97);
    return ((word ^ (word >>> 15)) >>> 0) / 4294967296;
  };
}

/** A normal number, by the sum of uniform ones: good enough for noise. */
export function normal(random) {
  let sum = -6;
  for (let count = 0; count < 12; count++) sum += random();
  return sum;
}

const float = new Float32Array(1);
const bits = new Uint32Array(float.buffer);

/** The half float nearest to a number, as 16 bits; what is too small becomes 0. */
export function half(value) {
  float[0] = value;
  const word = bits[0];
  const sign = (word >>> 16) & 0x8000;
  if (Number.isNaN(value)) return 0x7e00;
  const exponent = ((word >>> 23) & 255) - 112;
  if (exponent <= 0) return sign;
  if (exponent >= 31) return sign | 0x7c00;
  return sign + (((exponent << 10) | ((word >>> 13) & 1023)) + ((word >>> 12) & 1));
}

/** A picture of size x size pixels; `colour(u, v)` gives red, green and blue. */
export function picture(name, kind, size, colour) {
  const halves = new Uint16Array(size * size * 3);
  for (let y = 0; y < size; y++) {
    for (let x = 0; x < size; x++) {
      const rgb = colour((x + 0.5) / size, (y + 0.5) / size);
      for (let channel = 0; channel < 3; channel++) halves[(y * size + x) * 3 + channel] = half(rgb[channel]);
    }
  }
  return { name, width: size, height: size, kind, half: Buffer.from(halves.buffer).toString("base64") };
}

/** Light in a room with a red and a green wall, a ball and a lamp. */
export function room(u, v) {
  if (Math.hypot(u - 0.5, v - 0.14) < 0.07) return [6, 5.6, 4.8];
  const ball = 1 - ((u - 0.56) ** 2 + (v - 0.68) ** 2) / 0.17 ** 2;
  const light = 0.12 + 0.5 / (1 + 14 * ((u - 0.5) ** 2 + (v - 0.14) ** 2));
  if (ball > 0) {
    const facing = Math.max(0, (0.5 - u) * 0.6 + (0.72 - v) * 2.4 + 0.6 * Math.sqrt(ball));
    return [0.05 + 0.62 * facing, 0.06 + 0.6 * facing, 0.09 + 0.66 * facing].map((value) => value * light * 2.2);
  }
  const shade = 1 - 0.72 * penumbra(u, v);
  let albedo = [0.74, 0.72, 0.68];
  if (u < 0.22 - 0.1 * Math.abs(v - 0.5)) albedo = [0.63, 0.08, 0.06];
  if (u > 0.78 + 0.1 * Math.abs(v - 0.5)) albedo = [0.12, 0.46, 0.1];
  return albedo.map((value) => value * light * shade * 1.6);
}

/** How much of the lamp is hidden by the ball, 0..1. */
export function penumbra(u, v) {
  const distance = Math.hypot((u - 0.6) / 0.26, (v - 0.88) / 0.07);
  return Math.max(0, Math.min(1, 1.4 - distance));
}
