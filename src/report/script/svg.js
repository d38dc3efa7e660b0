// Plots as SVG: elements, scales, axes, and the tip that shows values.

const SVG = "http://www.w3.org/2000/svg";

/** A new SVG element. */
function shape(tag, attributes = {}, ...children) {
  const node = dress(document.createElementNS(SVG, tag), attributes);
  node.append(...children);
  return node;
}

/** Maps low..high to from..to; logarithmic where said. */
function scaleFor(low, high, from, to, logarithmic) {
  const inner = logarithmic ? Math.log10 : (value) => value;
  const [start, width] = [inner(low), inner(high) - inner(low) || 1];
  const map = (value) => from + ((inner(value) - start) / width) * (to - from);
  return Object.assign(map, { low, high, from, to, logarithmic });
}

/** Round numbers between low and high, about `wanted` of them. */
function linearTicks(low, high, wanted = 5) {
  const rough = (high - low) / wanted || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((each) => each * power >= rough) * power;
  const ticks = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + step * 1e-9; at++) ticks.push(at * step);
  return ticks;
}

/** Every power of ten between low and high, times each of these. */
function powerTicks(low, high, within) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++) {
    ticks.push(...within.map((each) => each * 10 ** power).filter((tick) => tick >= low * 0.999 && tick <= high * 1.001));
  }
  return ticks;
}

/** Powers of ten, with 2 and 5 between them where there is room; fewer where there is not. */
function logTicks(low, high, room = 6) {
  const fine = powerTicks(low, high, [1, 2, 5]);
  const coarse = powerTicks(low, high, [1]);
  if (fine.length <= room * 1.5 || coarse.length < 2) return fine;
  const stride = Math.ceil(coarse.length / (room * 1.5));
  return coarse.filter((_, at) => at % stride === 0);
}

function ticksOf(scale, room) {
  return scale.logarithmic ? logTicks(scale.low, scale.high, room) : linearTicks(scale.low, scale.high, room);
}

/** The axis below: grid lines, numbers and a title. */
function bottomAxis(scale, top, bottom, title, room, text = tickText) {
  const marks = ticksOf(scale, room).flatMap((tick) => [
    shape("line", { class: "grid", x1: scale(tick), x2: scale(tick), y1: top, y2: bottom }),
    shape("text", { class: "tick", x: scale(tick), y: bottom + 18, "text-anchor": "middle" }, text(tick)),
  ]);
  const middle = (scale.from + scale.to) / 2;
  return shape("g", {}, ...marks, shape("text", { class: "axis-title", x: middle, y: bottom + 38, "text-anchor": "middle" }, title));
}

/** The axis at the left: grid lines and numbers. */
function leftAxis(scale, left, right, text = tickText) {
  const marks = ticksOf(scale, 6).flatMap((tick) => [
    shape("line", { class: "grid", x1: left, x2: right, y1: scale(tick), y2: scale(tick) }),
    shape("text", { class: "tick", x: left - 8, y: scale(tick) + 4, "text-anchor": "end" }, text(tick)),
  ]);
  return shape("g", {}, ...marks);
}

const MARKS = 4;

/** A point's mark: circle, square, triangle, diamond. */
function mark(kind, x, y, size = 4.5) {
  const at = (dx, dy) => `${x + dx * size},${y + dy * size}`;
  if (kind % MARKS === 0) return shape("circle", { cx: x, cy: y, r: size });
  const corners = [
    null,
    [at(-0.9, -0.9), at(0.9, -0.9), at(0.9, 0.9), at(-0.9, 0.9)],
    [at(0, -1.2), at(1.1, 0.9), at(-1.1, 0.9)],
    [at(0, -1.3), at(1.3, 0), at(0, 1.3), at(-1.3, 0)],
  ][kind % MARKS];
  return shape("polygon", { points: corners.join(" ") });
}

/** Shows the tip beside a mark; `lines` is a title and then texts. */
function showTip(target, lines) {
  const tip = byId("tip");
  tip.replaceChildren(...lines.map((line, at) => element(at === 0 ? "strong" : "span", {}, line)));
  tip.hidden = false;
  const box = target.getBoundingClientRect();
  const left = Math.min(box.right + 10, document.documentElement.clientWidth - tip.offsetWidth - 8);
  const above = box.top - tip.offsetHeight - 8;
  tip.style.left = `${Math.max(8, left) + scrollX}px`;
  tip.style.top = `${(above > 8 ? above : box.bottom + 8) + scrollY}px`;
}

function hideTip() {
  byId("tip").hidden = true;
}

/** Makes a mark say its numbers to the pointer, the keyboard and those who hear the page. */
function withTip(node, lines) {
  const show = () => showTip(node, lines);
  const attributes = { tabindex: "0", role: "img", "aria-label": lines.join(", "), class: `${node.getAttribute("class") ?? ""} told`.trim() };
  return dress(node, { ...attributes, pointerenter: show, pointerleave: hideTip, focus: show, blur: hideTip });
}

/** A sheet's width in pixels, and the least of a plot on it: plots are drawn anew for paper. */
const PAPER = { width: 700, least: 320 };
let onPaper = false;

/** The width of each of so many plots: beside one another where there is room. */
function plotWidth(host, many, least = 420, gap = 32) {
  const room = onPaper ? PAPER.width : host.clientWidth;
  const wanted = onPaper ? PAPER.least : least;
  const columns = Math.max(1, Math.min(many, Math.floor((room + gap) / (wanted + gap))));
  host.style.setProperty("--columns", columns);
  return Math.floor((room - gap * (columns - 1)) / columns);
}

/** Draws for paper before printing, and for the screen after it. */
function drawForPaper() {
  for (const [event, paper] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(event, () => {
      onPaper = paper;
      changed();
    });
  }
}

/** Draws anew whenever the host's width changes. */
function drawToWidth(host, draw) {
  let width = 0;
  new ResizeObserver(() => {
    const now = Math.round(host.clientWidth);
    if (now === width || now === 0) return;
    width = now;
    draw();
  }).observe(host);
}
