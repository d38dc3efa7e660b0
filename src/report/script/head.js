// What stands before the analysis: the question, the findings, what was swept.

function fillHeader() {
  const title = data.title || "A sweep";
  document.title = `${title} · lampray sweep`;
  byId("title").textContent = title;
  byId("question").textContent = data.question;
  byId("version").textContent = `lampray sweep ${data.version}`.trim();
  byId("extent").textContent = extent();
  byId("command").textContent = data.command;
  byId("copy-command").addEventListener("click", (event) => copyText(data.command, event.currentTarget));
}

/** How much there is: runs, groups, what failed. */
function extent() {
  const wrong = data.runs.filter((run) => run.status !== "ok").length;
  const parts = [amount(data.runs.length, "run"), amount(data.groups.length, "group")];
  if (wrong > 0) parts.push(`${count(wrong)} without result`);
  return parts.join(", ");
}

function amount(many, thing) {
  return `${count(many)} ${thing}${many === 1 ? "" : "s"}`;
}

function fillFindings() {
  const sentences = data.findings.length > 0 ? data.findings : ["The data say nothing yet."];
  byId("finding-list").replaceChildren(...sentences.map((sentence) => element("li", {}, typeset(sentence))));
}

/** A switch for each value of each axis. */
function fillAxes() {
  const rows = data.axes.map((axis) => {
    const chips = axisValues(axis).map((value) => chip(axis.path, value));
    return element("div", { class: "axis", role: "group", "aria-label": axis.path }, element("code", {}, axis.path), element("div", { class: "chips" }, ...chips));
  });
  byId("axes").replaceChildren(...rows);
  byId("keep-all").addEventListener("click", () => {
    for (const left of chosen.leftOut.values()) left.clear();
    changed();
  });
  onChange(showKept);
}

function chip(path, value) {
  const left = chosen.leftOut.get(path);
  const node = button(value, () => {
    if (!left.delete(value)) left.add(value);
    changed();
  }, { class: "chip", "aria-pressed": "true" });
  onChange(() => node.setAttribute("aria-pressed", String(!left.has(value))));
  return node;
}

function showKept() {
  const [runs, groups] = [data.runs.filter(kept).length, keptGroups().length];
  const all = runs === data.runs.length && groups === data.groups.length;
  byId("kept").textContent = all ? "All runs are taken." : `${count(runs)} of ${amount(data.runs.length, "run")} and ${count(groups)} of ${amount(data.groups.length, "group")} are taken.`;
  byId("keep-all").hidden = all;
}

/** More references than this are counted; the table of groups names them all. */
const MOST_REFERENCES = 4;

/** The references with what is known of them. */
function referenceFacts() {
  const { references } = data;
  if (references.length === 0) return [["Reference", "None: bias and error are unknown; noise and time are shown."]];
  const facts = references.slice(0, MOST_REFERENCES).flatMap((reference) => [
    ["Reference", `${reference.name}, ${count(reference.samples)} samples a pixel`],
    ["Its mean radiance", referenceMean(reference)],
  ]);
  const more = references.length - MOST_REFERENCES;
  if (more > 0) facts.push(["References", `${count(more)} more, each for another expected picture; a column of the table of groups names them.`]);
  const without = data.groups.filter((group) => referenceOf(group) === null).length;
  if (without > 0) facts.push(["Without reference", `${amount(without, "group")}: only noise and time are known.`]);
  return facts;
}

/** What the page itself leaves out, and why. */
function fillNotes() {
  byId("notes").replaceChildren(...data.notes.map((note) => element("li", {}, typeset(note))));
  byId("notes").hidden = data.notes.length === 0;
}

/** The references, how the runs ended, where they ran. */
function fillFacts() {
  const facts = referenceFacts();
  const states = new Map();
  for (const run of data.runs) states.set(run.status, (states.get(run.status) ?? 0) + 1);
  const ends = [...states].map(([status, runs]) => `${count(runs)} ${statusText(status)}`);
  if (ends.length > 0) facts.push(["Runs", ends.join(", ")]);
  const devices = new Set(data.runs.map((run) => run.device).filter(Boolean));
  if (devices.size > 0) facts.push(["Devices", [...devices].join("; ")]);
  byId("facts").replaceChildren(...facts.flatMap(([term, text]) => [element("dt", {}, term), element("dd", {}, text)]));
}

/** R, G and B with their standard errors. */
function referenceMean({ mean, standard_error: errors }) {
  if (isMissing(errors)) return mean.map((value, at) => `${"RGB"[at]} ${number(value)}`).join(", ");
  const parts = mean.map((value, at) => intervalParts({ value, low: value - errors[at], high: value + errors[at] }));
  return parts.map(({ value, half }, at) => `${"RGB"[at]} ${value} ± ${half}`).join(", ");
}

/** The choice of a region, which every part of the page follows. */
function fillRegions() {
  const select = byId("region");
  const regions = data.regions.length > 0 ? data.regions : [{ name: "whole" }];
  fillSelect(select, regions.map((region, index) => [index, region.name]), 0);
  select.addEventListener("change", () => {
    chosen.region = Number(select.value);
    changed();
  });
}

/** Light or dark, as the reader or the system wants. */
function fillTheme() {
  const select = byId("theme");
  const wear = (theme) => { document.documentElement.dataset.theme = theme; };
  select.value = remembered("theme") ?? "";
  if (select.selectedIndex < 0) select.value = "";
  wear(select.value);
  select.addEventListener("change", () => {
    wear(select.value);
    remembered("theme", select.value);
  });
}
