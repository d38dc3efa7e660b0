// The report's data, as the page reads them.

/** Whole numbers that a double cannot hold, seeds above all, stay exact as strings. */
function parseExact(text) {
  return JSON.parse(text.replace(/("(?:[\w.]*\.)?(?:seed|paths|rays)":)(\d{16,})/g, '$1"$2"'));
}

/** An interval whose ends are numbers: JSON has no infinity, so open ends arrive as null. */
function closed(interval) {
  if (!interval || interval.value === null) return null;
  const { value, low, high } = interval;
  return low === null || high === null ? { value, low: value, high: value } : interval;
}

/** Closes the intervals of a group: one run alone has no spread. */
function closeIntervals(group) {
  group.seconds = closed(group.seconds) ?? { value: null, low: null, high: null };
  for (const region of group.regions) {
    for (const [key, found] of Object.entries(region)) if (found !== null && typeof found === "object") region[key] = closed(found);
  }
}

/** Reads the data and lets go of their text, which may be many megabytes. */
function takeData() {
  const holder = document.getElementById("data");
  const data = parseExact(holder.textContent);
  holder.remove();
  data.groups.forEach(closeIntervals);
  return data;
}

const data = takeData();

/** A value of an axis as people write it. */
function valueText(value) {
  return typeof value === "string" ? value : JSON.stringify(value ?? null);
}

/** The last part of a knob's path: `sampler` of `light.sampler`. */
function leaf(path) {
  return path.slice(path.lastIndexOf(".") + 1);
}

/** The distinct values of an axis, in the order of the runs. */
function axisValues(axis) {
  const met = new Set(data.runs.filter((run) => axis.path in run.values).map((run) => valueText(run.values[axis.path])));
  return met.size > 0 ? [...met] : axis.values;
}

/** The group's finding in a region; an empty one where there is none. */
function result(group, region) {
  return group.regions[region] ?? {};
}

/** What a group is held against, if anything. */
function referenceOf(group) {
  return data.references[group.reference] ?? null;
}

/** Whether some group has this number in some region. */
function anyGroupHas(key) {
  return data.groups.some((group) => group.regions.some((each) => each[key] !== null && each[key] !== undefined));
}

/** Whether the axis says how many samples a pixel has: those make the points of a line. */
function countsSamples(axis) {
  return data.groups.length > 0 && data.groups.every((group) => Number(group.values[axis.path]) === group.samples);
}
