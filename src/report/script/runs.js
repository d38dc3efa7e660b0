// The table of runs.

const STATES = {
  ok: { sign: "✓", tone: "good", text: "ok" },
  failed: { sign: "✕", tone: "bad", text: "failed" },
  device_lost: { sign: "!", tone: "bad", text: "device lost" },
  timeout: { sign: "…", tone: "open", text: "timeout" },
};

function statusText(status) {
  return STATES[status]?.text ?? status;
}

/** Mean of three numbers, or none where they or one of them are missing. */
function meanOf(channels) {
  return isMissing(channels) || channels.some(isMissing) ? null : (channels[0] + channels[1] + channels[2]) / 3;
}

/** Mean radiance of a run; the channels share their paths, so their errors are not independent. */
function meanCell(run) {
  const [mean, error] = [meanOf(run.mean), meanOf(run.standard_error) ?? NaN];
  if (mean === null) return NOTHING;
  const { value, half } = intervalParts({ value: mean, low: mean - error, high: mean + error });
  const channels = run.mean.map((each) => number(each, 5)).join(", ");
  return element("span", { class: "interval", title: `R, G, B: ${channels}` }, value, element("small", {}, `± ${half}`));
}

function runColumns() {
  const perSecond = (run) => (run.seconds > 0 ? Number(run.rays) / run.seconds : null);
  const groupName = (run) => data.groups[run.group]?.name ?? null;
  return [
    textColumn("id", "Run", (run) => run.id),
    { ...textColumn("status", "Status", (run) => statusText(run.status)), cell: (run) => badge(STATES[run.status] ?? { sign: "·", tone: "open", text: run.status }) },
    ...axisColumns(data.runs, true),
    textColumn("group", "Group", groupName, { shown: false }),
    numberColumn("seed", "Seed", (run) => run.seed, String, { shown: !data.axes.some((axis) => leaf(axis.path) === "seed") }),
    numberColumn("samples", "Samples", (run) => run.samples, count, { shown: !data.axes.some(countsSamples), help: "Samples a pixel" }),
    numberColumn("seconds", "Seconds", (run) => run.seconds || null, number, { help: "Tracing alone" }),
    numberColumn("paths", "Paths", (run) => run.paths, count, { shown: false }),
    numberColumn("rays", "Rays", (run) => run.rays, count, { shown: false }),
    numberColumn("speed", "Rays a second", perSecond, number, { shown: false }),
    { ...numberColumn("mean", "Mean", (run) => meanOf(run.mean), number, { help: "Mean radiance, with the channels' mean standard error" }), cell: meanCell, heads: ["Mean R", "Mean G", "Mean B", "SE R", "SE G", "SE B"], csv: (run) => [...run.mean, ...(run.standard_error ?? [null, null, null])] },
    textColumn("device", "Device", (run) => run.device, { look: "device" }),
    textColumn("error", "Error", (run) => run.error, { look: "words", absent: () => !data.runs.some((run) => run.error) }),
    { key: "pictures", look: "pictures", title: "Picture", cell: (run) => pictureButtons([["view", run.image]]) },
  ];
}

function fillRuns() {
  const rows = () => data.runs.filter(kept);
  onChange(makeTable(byId("run-table"), { name: "runs", columns: runColumns(), rows }));
}
