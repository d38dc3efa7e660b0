// One canvas of the viewer: what it shows and how it is drawn.

const LETTERS = "ABCDEFGH";

/** What the viewer compares, and how. */
const shown = { slots: [], mode: "side", exposure: 0, flip: 0, split: 0.5 };

/** The panes of the mode: each a list of slots, by their places. */
function panesOfMode() {
  const all = shown.slots.map((_, at) => at);
  if (shown.mode === "side") return all.map((at) => [at]);
  if (shown.mode === "flip") return [[shown.flip % all.length]];
  return [all.slice(0, 2)];
}

/** The scale's end for a picture: shared with all that are shown of its kind. */
function slotRange(index) {
  const kind = data.images[index].kind;
  const alike = shown.slots.filter((other) => data.images[other].kind === kind);
  return sharedRange([...new Set(alike)]) * 2 ** -shown.exposure;
}

function shownDifferenceRange() {
  return differenceRange(shown.slots[0], shown.slots[1]) * 2 ** -shown.exposure;
}

/** The canvases that a pane lays over one another, each with the share of the width it ends at. */
function layersOf(slots) {
  const paintedSlot = (at) => paintedImage(shown.slots[at], shown.exposure, slotRange(shown.slots[at]));
  if (slots.length < 2) return [[paintedSlot(slots[0]), 1]];
  if (shown.mode === "difference") return [[paintedDifference(shown.slots[0], shown.slots[1], shownDifferenceRange()), 1]];
  return [[paintedSlot(1), 1], [paintedSlot(0), shown.split]];
}

/** What a pane is called. */
function paneTitle(slots) {
  const named = (at) => `${LETTERS[at]} ${data.images[shown.slots[at]].name}`;
  if (slots.length < 2) return named(slots[0]);
  return shown.mode === "difference" ? `A − B: ${slots.map(named).join(" − ")}` : slots.map(named).join(" | ");
}

/** Draws a pane: its layers at the view's part, the region, the pixel that is read. */
function drawPane(canvas, slots) {
  const ratio = window.devicePixelRatio || 1;
  const box = canvas.getBoundingClientRect();
  canvas.width = Math.max(1, Math.round(box.width * ratio));
  canvas.height = Math.max(1, Math.round(box.height * ratio));
  const context = canvas.getContext("2d");
  const first = data.images[shown.slots[slots[0]]];
  const scale = (view.zoom * canvas.width) / first.width;
  const left = canvas.width / 2 - view.x * first.width * scale;
  const top = canvas.height / 2 - view.y * first.height * scale;
  context.imageSmoothingEnabled = scale < 1;
  for (const [picture, end] of layersOf(slots)) {
    context.save();
    context.beginPath();
    context.rect(0, 0, canvas.width * end, canvas.height);
    context.clip();
    context.drawImage(picture, left, top, first.width * scale, first.height * scale);
    context.restore();
  }
  drawRegion(context, left, top, first.width * scale);
  if (view.probe && scale >= 4) drawProbe(context, left, top, scale, first);
}

function drawProbe(context, left, top, scale, image) {
  const [x, y] = pixelAt(image);
  context.lineWidth = 1;
  for (const [colour, grown] of [["#000", 1], ["#fff", 0]]) {
    context.strokeStyle = colour;
    context.strokeRect(left + x * scale - grown, top + y * scale - grown, scale + 2 * grown, scale + 2 * grown);
  }
}

/** The pixel of a picture at the place that is read. */
function pixelAt(image) {
  const inside = (share, size) => Math.min(size - 1, Math.max(0, Math.floor(share * size)));
  return [inside(view.probe[0], image.width), inside(view.probe[1], image.height)];
}

/** The rows of the readout: every slot's numbers at the pixel, and the difference. */
function readoutRows() {
  const numbers = shown.slots.map((index) => (view.probe ? pixel(index, ...pixelAt(data.images[index])) : null));
  const rows = shown.slots.map((index, at) => [`${LETTERS[at]} ${data.images[index].name}`, numbers[at]]);
  if (numbers.length > 1) rows.push(["A − B", numbers[0] && numbers[0].map((value, channel) => value - numbers[1][channel])]);
  return rows;
}

/** The table of pixel values. */
function fillReadout(table) {
  const place = view.probe ? pixelAt(data.images[shown.slots[0]]) : null;
  const title = place ? `x ${place[0]}, y ${place[1]}` : "Point at a pixel";
  const heads = [title, "R", "G", "B", "Mean"].map((head, at) => element("th", { scope: "col", class: at > 0 ? "numeric" : null }, head));
  const rows = readoutRows().map(([name, rgb]) => {
    const numbers = rgb ? [...rgb, meanOf(rgb)] : [null, null, null, null];
    return element("tr", {}, element("th", { scope: "row" }, name), ...numbers.map((value) => element("td", { class: "numeric" }, number(value, 4))));
  });
  table.replaceChildren(element("thead", {}, element("tr", {}, ...heads)), element("tbody", {}, ...rows));
}

/** The legends of the colour scales that are in use. */
function fillScales(host) {
  const kinds = new Set(shown.slots.map((index) => data.images[index].kind));
  const inUse = shown.mode === "difference" && shown.slots.length > 1 ? [] : [...kinds].filter(scaleOf);
  const titles = { bias: "Bias, mean of the channels", deviation: "Standard deviation of one sample, mean of the channels" };
  const legends = inUse.map((kind) => {
    const index = shown.slots.find((each) => data.images[each].kind === kind);
    return colourLegend(scaleOf(kind), slotRange(index), titles[kind]);
  });
  if (shown.mode === "difference" && shown.slots.length > 1) legends.push(colourLegend("diverging", shownDifferenceRange(), "A − B, mean of the channels"));
  host.replaceChildren(...legends);
}
