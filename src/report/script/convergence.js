// Error against samples or seconds, on logarithmic axes.

/** What can be on the vertical axis; a root of a mean square falls with slope -1/2. */
const ERRORS = [
  { key: "rmse", title: "√MSE (radiance)", of: (found) => root(found.mse), needs: "mse" },
  { key: "relrmse", title: "√relMSE", of: (found) => root(found.relmse), needs: "relmse" },
  { key: "noise", title: "Noise, √(variance / N)", of: (found, group) => root(shared(found.variance, group.samples)), needs: "variance" },
];

const BIAS = { key: "bias", title: "|Bias|, relative", of: (found) => sizeOf(found.bias), unit: PERCENT };

/** N* beyond this many times the most samples is said in words only. */
const FARTHEST = 100;

const PLOT = { top: 14, bottom: 52, left: 62, right: 18 };

function shared(interval, by) {
  return interval && { value: interval.value / by, low: interval.low / by, high: interval.high / by };
}

/** The size of a signed interval; its low end is 0 where the interval holds 0. */
function sizeOf(interval) {
  if (!interval) return null;
  const [one, other] = [Math.abs(interval.low), Math.abs(interval.high)];
  const low = interval.low <= 0 && interval.high >= 0 ? 0 : Math.min(one, other);
  return { value: Math.abs(interval.value), low, high: Math.max(one, other) };
}

/** The points of a line. Where no bias is seen, the point is the most that it can be. */
function pointsOf(series, quantity, against) {
  const points = series.groups.filter(kept).flatMap((group) => {
    const found = result(group, chosen.region);
    const error = quantity.of(found, group);
    const x = against === "seconds" ? group.seconds.value : group.samples;
    if (!error || !(x > 0)) return [];
    const limit = quantity === BIAS && error.low === 0;
    const height = limit ? error.high : error.value;
    return height > 0 ? [{ x, y: height, limit, group, series, crossing: found.crossing ?? null, ...error }] : [];
  });
  return points.sort((one, other) => one.x - other.x);
}

/** Where bias takes over from noise, on the line or on its straight continuation. */
function crossingOf(points, against) {
  const last = points.findLast((point) => point.crossing > 0);
  if (!last) return null;
  const x = against === "seconds" ? (last.crossing * last.x) / last.group.samples : last.crossing;
  if (x > FARTHEST * points.at(-1).x || x < points[0].x / FARTHEST) return null;
  return { x, y: heightAt(points, x), samples: last.crossing, series: last.series, from: points.at(-1) };
}

/** The line's height at x, between points by powers and outside them with slope -1/2. */
function heightAt(points, x) {
  const after = points.findIndex((point) => point.x >= x);
  if (after <= 0) {
    const end = after === 0 ? points[0] : points.at(-1);
    return end.y * Math.sqrt(end.x / x);
  }
  const [one, other] = [points[after - 1], points[after]];
  return one.y * (other.y / one.y) ** (Math.log(x / one.x) / Math.log(other.x / one.x));
}

/** The plot's ends: all points and crossings, and the bands as far as a third below the points. */
function extentOf(lines) {
  const points = lines.flatMap((line) => [...line.points, ...(line.crossing ? [line.crossing] : [])]);
  const bands = lines.flatMap((line) => line.points.flatMap((point) => (point.limit ? [] : [point.low, point.high])));
  const [xs, ys] = [points.map((point) => point.x), points.map((point) => point.y)];
  const lowest = Math.min(...ys);
  return {
    x: [Math.min(...xs) / 1.25, Math.max(...xs) * 1.25],
    y: [Math.max(lowest / 3, Math.min(lowest, ...bands)) / 1.5, Math.max(...ys, ...bands) * 1.3],
  };
}

/** One plot of a quantity, as wide as it is given. */
function convergencePlot(quantity, width, choice) {
  const lines = allSeries.filter((series) => !series.hidden).map((series) => {
    const points = pointsOf(series, quantity, choice.against);
    const crossing = quantity === BIAS || points.length === 0 ? null : crossingOf(points, choice.against);
    return { series, points, crossing };
  }).filter((line) => line.points.length > 0);
  if (lines.length === 0) return element("p", { class: "none" }, `Nothing to show of ${quantity.title}.`);
  const height = Math.max(280, Math.min(420, width * 0.72));
  const extent = extentOf(lines);
  const x = scaleFor(...extent.x, PLOT.left, width - PLOT.right, true);
  const y = scaleFor(...extent.y, height - PLOT.bottom, PLOT.top, true);
  const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, role: "group", "aria-label": `${quantity.title} against ${choice.against}` });
  const axisTitle = choice.against === "seconds" ? "Seconds" : "Samples a pixel";
  svg.append(leftAxis(y, PLOT.left, width - PLOT.right, quantity.unit ? (value) => `${tickText(value * 100)} %` : tickText));
  svg.append(bottomAxis(x, PLOT.top, height - PLOT.bottom, axisTitle, width / 90));
  const inside = clipped(PLOT.left, PLOT.top, width - PLOT.left - PLOT.right, height - PLOT.top - PLOT.bottom);
  if (choice.guide) inside.append(slopeGuide(lines, x, y));
  if (choice.bands) inside.append(...lines.map((line) => band(line, x, y)));
  svg.append(inside, ...lines.map((line) => drawnLine(line, x, y, quantity)));
  return element("figure", { class: "plot" }, element("figcaption", {}, quantity.title), svg);
}

/** A part of a plot that nothing drawn in it leaves. */
function clipped(x, y, width, height) {
  return shape("svg", { x, y, width, height, viewBox: `${x} ${y} ${width} ${height}` });
}

/** The slope of noise, beside the lines. */
function slopeGuide(lines, x, y) {
  const starts = lines.map((line) => line.points[0]);
  const from = starts.reduce((one, other) => (other.y < one.y ? other : one));
  const height = (at) => y(from.y * 0.62 * Math.sqrt(from.x / at));
  const label = x.low * (x.high / x.low) ** 0.36;
  return shape("g", { class: "guide" },
    shape("line", { x1: x(x.low), y1: height(x.low), x2: x(x.high), y2: height(x.high) }),
    shape("text", { x: x(label) - 6, y: height(label) + 14, "text-anchor": "end" }, "slope −½"));
}

/** The intervals of the points beside one another that are more than limits. */
function band({ series, points }, x, y) {
  const held = (value) => y(Math.max(value, y.low / 10));
  const known = points.filter((point) => !point.limit);
  const above = known.map((point) => `${x(point.x)},${held(point.high)}`);
  const below = known.map((point) => `${x(point.x)},${held(point.low)}`).reverse();
  return shape("polygon", { class: `band ${colourClass(series)}`, points: [...above, ...below].join(" ") });
}

/** A line with its points, and its crossing if there is one; dotted where it joins limits. */
function drawnLine({ series, points, crossing }, x, y, quantity) {
  const steps = points.slice(1).map((point, at) => shape("line", {
    class: point.limit || points[at].limit ? "line ahead" : "line",
    x1: x(points[at].x), y1: y(points[at].y), x2: x(point.x), y2: y(point.y),
  }));
  const extra = crossing ? crossingMark(crossing, x, y) : [];
  return shape("g", { class: `series ${colourClass(series)}` }, ...steps, ...extra, ...points.map((point) => pointMark(point, x, y, quantity)));
}

/** A point: a full mark, or a hollow one with an arrow down for a limit. */
function pointMark(point, x, y, { title, unit }) {
  const [cx, cy] = [x(point.x), y(point.y)];
  const { series, group, limit } = point;
  const arrow = limit ? [shape("path", { class: "arrow", d: `M${cx},${cy}v17m-4,-5l4,5l4,-5` })] : [];
  const said = limit ? `at most ${intervalParts({ ...point, value: point.high }, unit).value}; none is seen` : intervalText(point, unit);
  const lines = [series.name, `${count(group.samples)} samples, ${number(group.seconds.value)} s`, `${title}: ${said}`];
  return withTip(shape("g", { class: limit ? "point limit" : "point" }, ...arrow, mark(markKind(series), cx, cy)), lines);
}

/** N*: a cross on the line; dashes lead to it where no run has gone so far. */
function crossingMark({ x: at, y: height, samples, series, from }, x, y) {
  const [cx, cy] = [x(at), y(height)];
  const cross = shape("g", { class: "crossing" },
    shape("circle", { class: "target", cx, cy, r: 9 }),
    shape("path", { d: `M${cx - 6},${cy - 6}l12,12m0,-12l-12,12` }),
    shape("text", { x: cx, y: cy - 12, "text-anchor": "middle" }, "N*"));
  const dashes = at > from.x ? [shape("line", { class: "line ahead", x1: x(from.x), y1: y(from.y), x2: cx, y2: cy })] : [];
  return [...dashes, withTip(cross, [series.name, `N* ${roundCount(samples)} samples a pixel`, "bias² equals variance / N here"])];
}

/** The section: its choices, its legend, one plot of the error and one of the bias. */
function fillConvergence() {
  const offered = ERRORS.filter((each) => anyGroupHas(each.needs));
  if (offered.length === 0) {
    byId("convergence").hidden = true;
    return;
  }
  const host = byId("convergence-plots");
  const draw = () => drawConvergence(host, offered);
  fillSelect(byId("error-kind"), offered.map((each) => [each.key, each.title]));
  byId("convergence-legend").replaceChildren(...seriesLegend(draw));
  for (const id of ["error-kind", "error-against", "show-bands", "show-guide"]) byId(id).addEventListener("change", draw);
  onChange(draw);
  drawToWidth(host, draw);
}

function drawConvergence(host, offered) {
  hideTip();
  const quantity = offered.find((each) => each.key === byId("error-kind").value);
  const choice = { against: byId("error-against").value, bands: byId("show-bands").checked, guide: byId("show-guide").checked };
  const quantities = anyGroupHas("bias") ? [quantity, BIAS] : [quantity];
  const width = plotWidth(host, quantities.length);
  host.replaceChildren(...quantities.map((each) => convergencePlot(each, width, { ...choice, guide: choice.guide && each !== BIAS })));
}
