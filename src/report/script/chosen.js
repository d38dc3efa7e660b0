// What the reader chose and more than one part of the page shows.

const chosen = {
  /** Index into the regions. */
  region: 0,
  /** For each axis, the values that are left out. */
  leftOut: new Map(data.axes.map((axis) => [axis.path, new Set()])),
};

const listeners = [];

/** Calls this whenever the choice changes. */
function onChange(listener) {
  listeners.push(listener);
}

function changed() {
  for (const listener of listeners) listener();
}

/** Whether a group or a run has only values that are not left out; what lacks an axis passes it. */
function kept(item) {
  return data.axes.every(({ path }) => !(path in item.values) || !chosen.leftOut.get(path).has(valueText(item.values[path])));
}

function keptGroups() {
  return data.groups.filter(kept);
}
