// Bars with 95 % intervals: a quantity of every group, in one region or all.

const BAR_KINDS = [
  { key: "bias", title: "Bias", note: "Mean minus the reference’s, relative to it. A bar whose interval holds 0 shows no bias.", signed: true, unit: SIGNED_PERCENT, tick: (value) => `${tickText(value * 100)}\u202f%` },
  { key: "variance", title: "Variance of one sample", note: "Mean over the region’s pixels; independent of the number of samples." },
  { key: "mse", title: "MSE", note: "Mean squared error of a run’s pixels against the reference." },
  { key: "efficiency", title: "Efficiency, 1 / (MSE × seconds)", note: "Higher is better." },
  { key: "equal_time", title: "Error at equal time, ratio", note: "Error at equal time over the first group’s, of the same reference. Below 1 is better.", base: 1 },
  { key: "equal_error", title: "Time to equal error, ratio", note: "Time to equal error over the first group’s, of the same reference. Below 1 is better.", base: 1 },
  { key: "mean", title: "Mean radiance", note: "Mean of the region’s pixels." },
];

/** Heights of a row's bar, and of a name above it. */
const ROW = 24;
const NAME = 15;

/** The width that a letter of a name takes, at most nearly always. */
const LETTER = 6.8;

/** The groups that have this number in a region. */
function barsOf(kind, region) {
  return keptGroups().flatMap((group) => {
    const interval = result(group, region)[kind.key];
    return interval && Number.isFinite(interval.value) ? [{ group, ...interval }] : [];
  });
}

/** The chart's ends: all intervals and, where bars start, their base. */
function barExtent(bars, kind, logarithmic) {
  const ends = bars.flatMap((bar) => [bar.low, bar.high, bar.value]).filter((value) => Number.isFinite(value) && (!logarithmic || value > 0));
  if (!logarithmic) {
    const [low, high] = [Math.min(0, ...ends), Math.max(kind.base ?? 0, ...ends)];
    const margin = (high - low) * 0.04 || 1;
    return [low < 0 ? low - margin : 0, high > 0 ? high + margin : 0];
  }
  const all = kind.base ? [...ends, kind.base] : ends;
  return [Math.min(...all) / 1.2, Math.max(...all) * 1.2];
}

/** Cuts a name that has no room; the tip has it all. */
function fitted(name, room) {
  const most = Math.max(8, Math.floor(room / LETTER));
  return name.length <= most ? name : `${name.slice(0, most - 1)}…`;
}

/** Where names stand: left of the bars, or above each where they would take half the width. */
function nameLayout(bars, width) {
  const wanted = Math.max(...bars.map((bar) => bar.group.name.length)) * LETTER + 16;
  return wanted <= width * 0.46 ? { left: wanted, row: ROW, above: false } : { left: 12, row: ROW + NAME, above: true };
}

/** One chart: a region's bars. */
function barChart(kind, region, width, wantLog) {
  const all = barsOf(kind, region);
  const logarithmic = wantLog && !kind.signed;
  const bars = logarithmic ? all.filter((bar) => bar.value > 0) : all;
  const name = data.regions[region]?.name ?? "whole";
  if (bars.length === 0) return element("p", { class: "none" }, `No ${kind.title.toLowerCase()} in ${name}.`);
  const layout = nameLayout(bars, width);
  const bottom = bars.length * layout.row + 8;
  const x = scaleFor(...barExtent(bars, kind, logarithmic), layout.left, width - 24, logarithmic);
  const svg = shape("svg", { viewBox: `0 0 ${width} ${bottom + 46}`, role: "group", "aria-label": `${kind.title}, ${name}` });
  svg.append(bottomAxis(x, 4, bottom, kind.title, Math.max(2, (width - layout.left) / 90), kind.tick));
  const from = logarithmic ? kind.base : kind.base ?? 0;
  if (from !== undefined) svg.append(shape("line", { class: "base", x1: x(from), x2: x(from), y1: 4, y2: bottom }));
  svg.append(...bars.map((bar, at) => barRow(bar, 8 + at * layout.row, x, { from: logarithmic ? undefined : 0, layout, kind })));
  return element("figure", { class: "plot" }, element("figcaption", {}, name), svg);
}

/** A group's row: its name, its bar (a dot where bars would have no start), its interval. */
function barRow(bar, top, x, { from, layout, kind }) {
  const series = seriesOfGroup.get(bar.group);
  const middle = top + layout.row - ROW / 2 - 2;
  const held = (value) => Math.min(x.to, Math.max(x.from, x.logarithmic && value <= 0 ? x.from : x(value)));
  const [low, high, at] = [held(bar.low), held(bar.high), held(bar.value)];
  const parts = [
    shape("rect", { class: "row", x: 0, y: top - 2, width: x.to + 20, height: layout.row }),
    barName(bar.group.name, top, middle, x, layout),
  ];
  if (from !== undefined) parts.push(shape("rect", { class: "amount", x: Math.min(at, x(from)), y: middle - 6, width: Math.abs(at - x(from)), height: 12 }));
  parts.push(shape("path", { class: "error", d: `M${low},${middle}H${high}M${low},${middle - 4}v8M${high},${middle - 4}v8` }));
  if (from === undefined) parts.push(shape("circle", { class: "dot", cx: at, cy: middle, r: 4 }));
  const node = shape("g", { class: `bar-row ${colourClass(series)}` }, ...parts);
  return withTip(node, [bar.group.name, `${kind.title}: ${intervalText(bar, kind.unit)}`]);
}

function barName(name, top, middle, x, { left, above }) {
  if (above) return shape("text", { class: "name", x: 0, y: top + NAME - 4 }, fitted(name, x.to));
  return shape("text", { class: "name", x: left - 10, y: middle + 4, "text-anchor": "end" }, name);
}

/** The section: its choices and a chart for each region shown. */
function fillBars() {
  const offered = BAR_KINDS.filter((kind) => anyGroupHas(kind.key));
  if (offered.length === 0) {
    byId("comparison").hidden = true;
    return;
  }
  const host = byId("bars");
  const draw = () => drawBars(host, offered);
  fillSelect(byId("bars-kind"), offered.map((kind) => [kind.key, kind.title]));
  for (const id of ["bars-kind", "bars-regions", "bars-log"]) byId(id).addEventListener("change", draw);
  onChange(draw);
  drawToWidth(host, draw);
}

function drawBars(host, offered) {
  hideTip();
  const kind = offered.find((each) => each.key === byId("bars-kind").value);
  const regions = byId("bars-regions").value === "all" ? data.regions.map((_, index) => index) : [chosen.region];
  byId("bars-note").textContent = kind.note;
  byId("bars-log").disabled = Boolean(kind.signed);
  const width = plotWidth(host, regions.length, 340);
  host.replaceChildren(...regions.map((region) => barChart(kind, region, width, byId("bars-log").checked)));
}
