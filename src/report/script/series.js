// Lines of the plots: groups that differ in nothing but their number of samples.

const COLOURS = 8;

/** The axes that tell lines apart: not the one that counts samples, nor those with one value. */
function lineAxes() {
  const many = (axis) => new Set(data.groups.map((group) => valueText(group.values[axis.path]))).size > 1;
  return data.axes.filter((axis) => many(axis) && !countsSamples(axis));
}

/** The value as a name; what is not a word by itself says whose value it is. */
function nameOfValue(axis, group) {
  const value = group.values[axis.path];
  const text = valueText(value);
  return /^[a-z][\w-]*$/i.test(text) && !/^(true|false|null|off|on)$/.test(text) ? text : `${leaf(axis.path)} ${text}`;
}

/** Every line, hidden or not, in the order of the groups; its place says its colour and mark. */
const allSeries = (() => {
  const axes = lineAxes();
  const byName = new Map();
  for (const group of data.groups) {
    const name = axes.map((axis) => nameOfValue(axis, group)).join(", ") || "all groups";
    if (!byName.has(name)) byName.set(name, { name, place: byName.size, groups: [], hidden: false });
    byName.get(name).groups.push(group);
  }
  return [...byName.values()];
})();

const seriesOfGroup = new Map(allSeries.flatMap((series) => series.groups.map((group) => [group, series])));

/** The class that gives a line its colour. */
function colourClass(series) {
  return `s${series.place % COLOURS}`;
}

/** The mark's kind: it changes with the colour, and goes on changing where the colours begin again. */
function markKind(series) {
  return series.place + Math.floor(series.place / COLOURS);
}

/** The legend: a switch for each line. */
function seriesLegend(redraw) {
  return allSeries.map((series) => {
    const sample = shape("svg", { class: `key ${colourClass(series)}`, width: 30, height: 14, "aria-hidden": "true" },
      shape("line", { class: "line", x1: 1, y1: 7, x2: 29, y2: 7 }), mark(markKind(series), 15, 7));
    const node = button("", () => {
      series.hidden = !series.hidden;
      node.setAttribute("aria-pressed", String(!series.hidden));
      redraw();
    }, { class: "chip", "aria-pressed": "true" });
    node.append(sample, ` ${series.name}`);
    return node;
  });
}
