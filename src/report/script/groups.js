// The table of groups: what was found in the chosen region.

const VERDICTS = {
  same: { sign: "=", tone: "good", text: "same" },
  different: { sign: "≠", tone: "bad", text: "different" },
  "not-enough-samples": { sign: "?", tone: "open", text: "not enough samples" },
};

/** A word with its sign and colour, so that none of the three is needed alone. */
function badge({ sign, tone, text }) {
  return element("span", { class: `badge ${tone}` }, element("span", { "aria-hidden": "true" }, sign), ` ${text}`);
}

/** Small buttons that put pictures into the viewer. */
function pictureButtons(pairs) {
  const there = pairs.filter(([, index]) => index !== null && index !== undefined);
  if (there.length === 0) return NOTHING;
  return element("span", { class: "view-buttons" }, ...there.map(([text, index]) => button(text, () => viewPicture(index), {
    "aria-label": `View ${data.images[index].name}`, "data-image": index,
  })));
}

function root(interval) {
  if (!interval) return null;
  const safe = (value) => Math.sqrt(Math.max(0, value));
  return { value: safe(interval.value), low: safe(interval.low), high: safe(interval.high) };
}

/** A count of which only two digits are known. */
function roundCount(value) {
  return isMissing(value) ? NOTHING : `≈\u202f${value < 1e6 ? count(Number(value.toPrecision(2))) : number(value, 2)}`;
}

function groupColumns() {
  const here = (group) => result(group, chosen.region);
  const of = (key) => (group) => here(group)[key] ?? null;
  const lacks = (key) => ({ absent: () => !anyGroupHas(key) });
  return [
    textColumn("group", "Group", (group) => group.name),
    ...axisColumns(data.groups, false),
    { ...textColumn("reference", "Reference", (group) => referenceOf(group)?.name ?? null, { shown: false, help: "What the group is held against" }), absent: () => data.references.length < 2 },
    numberColumn("runs", "Runs", (group) => group.runs, count, { shown: false }),
    numberColumn("samples", "Samples", (group) => group.samples, count, { help: "Samples a pixel" }),
    intervalColumn("seconds", "Seconds", (group) => group.seconds, { help: "Mean tracing time of a run" }),
    intervalColumn("mean", "Mean", of("mean"), { shown: false, help: "Mean radiance" }),
    intervalColumn("bias", "Bias", of("bias"), { ...lacks("bias"), help: "Mean minus the reference's, relative to it" }, SIGNED_PERCENT),
    intervalColumn("variance", "Variance", of("variance"), { help: "Variance of one sample" }),
    intervalColumn("rmse", "√MSE", (group) => root(here(group).mse), { ...lacks("mse"), help: "Root of the mean squared error of a run's pixels" }),
    intervalColumn("relmse", "relMSE", of("relmse"), { ...lacks("relmse"), shown: false }),
    numberColumn("crossing", "N*", of("crossing"), roundCount, { ...lacks("crossing"), help: "Samples a pixel at which bias² and variance / N are equal" }),
    intervalColumn("efficiency", "Efficiency", of("efficiency"), { ...lacks("efficiency"), shown: false, help: "1 / (MSE × seconds)" }),
    intervalColumn("equal_time", "Equal time", of("equal_time"), { ...lacks("equal_time"), help: "Error at equal time over the first group's, of the same reference; below 1 is better" }),
    intervalColumn("equal_error", "Equal error", of("equal_error"), { ...lacks("equal_error"), shown: false, help: "Time to equal error over the first group's, of the same reference" }),
    { ...textColumn("verdict", "Verdict", of("verdict"), lacks("verdict")), cell: (group) => verdictCell(here(group).verdict) },
    { key: "pictures", look: "pictures", title: "Pictures", cell: (group) => pictureButtons([["mean", group.mean_image], ["bias", group.bias_image], ["dev.", group.deviation_image]]) },
  ];
}

function verdictCell(verdict) {
  if (!verdict) return NOTHING;
  return badge(VERDICTS[verdict] ?? { sign: "·", tone: "open", text: verdict });
}

function fillGroups() {
  onChange(makeTable(byId("group-table"), { name: "groups", columns: groupColumns(), rows: keptGroups }));
}
