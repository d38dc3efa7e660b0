// Pictures painted at their own size, kept until they are shown otherwise.

const MOST_PAINTED = 64;
const painted = new Map();

/** The ends of the colour scales when exposure is 0, by pictures taken together. */
const ranges = new Map();

/** The scale's end that these pictures share. */
function sharedRange(indices) {
  const key = indices.join();
  if (!ranges.has(key)) ranges.set(key, usualSize(indices.map(grey)));
  return ranges.get(key);
}

/** A canvas of the picture's size that `paint` filled; `key` says with what. */
function paintOnce(key, image, paint) {
  const known = painted.get(key);
  if (known) return known;
  const canvas = element("canvas", { width: image.width, height: image.height });
  const context = canvas.getContext("2d");
  const pixels = context.createImageData(image.width, image.height);
  paint(pixels.data);
  context.putImageData(pixels, 0, 0);
  if (painted.size >= MOST_PAINTED) painted.delete(painted.keys().next().value);
  painted.set(key, canvas);
  return canvas;
}

/** A picture as a canvas: light at the exposure, or numbers on a scale that ends at `range`. */
function paintedImage(index, exposure, range) {
  const image = data.images[index];
  const scale = scaleOf(image.kind);
  if (!scale) return paintOnce(`${index} ${exposure}`, image, (pixels) => paintLight(pixels, halvesOf(index), exposure));
  return paintOnce(`${index} ${range}`, image, (pixels) => paintNumbers(pixels, grey(index), scale, range));
}

/** Mean of the channels of one picture minus the other's, at the first one's pixels. */
function differences(first, second) {
  const [a, b] = [data.images[first], data.images[second]];
  const [one, other] = [grey(first), grey(second)];
  if (a.width === b.width && a.height === b.height) return one.map((value, at) => value - other[at]);
  return one.map((value, at) => {
    const x = Math.floor((((at % a.width) + 0.5) * b.width) / a.width);
    const y = Math.floor(((Math.floor(at / a.width) + 0.5) * b.height) / a.height);
    return value - other[y * b.width + x];
  });
}

/** The difference as a canvas. */
function paintedDifference(first, second, range) {
  const paint = (pixels) => paintNumbers(pixels, differences(first, second), "diverging", range);
  return paintOnce(`${first} - ${second} ${range}`, data.images[first], paint);
}

/** The scale's end for a difference when exposure is 0. */
function differenceRange(first, second) {
  const key = `${first} - ${second}`;
  if (!ranges.has(key)) ranges.set(key, usualSize([differences(first, second)]));
  return ranges.get(key);
}

/** Draws the chosen region's rectangle over a picture of this width on the screen; the whole picture needs
 * none. Regions are in pixels of the render, of which the page may show fewer. */
function drawRegion(context, left, top, width) {
  if (chosen.region === 0 || !data.regions[chosen.region]) return;
  const [x0, y0, x1, y1] = data.regions[chosen.region].rect;
  const scale = width / data.regions[0].rect[2];
  const rectangle = [left + x0 * scale + 1.5, top + y0 * scale + 1.5, (x1 - x0) * scale - 3, (y1 - y0) * scale - 3];
  context.lineWidth = 4;
  context.strokeStyle = "rgb(0 0 0 / 0.75)";
  context.strokeRect(...rectangle);
  context.lineWidth = 1.5;
  context.strokeStyle = "#fff";
  context.strokeRect(...rectangle);
}
