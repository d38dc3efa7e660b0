// Opens made-up reports in a headless Chromium and uses every control.
// node run.mjs CHROMIUM [FOLDER FOR SCREENSHOTS]
import { mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { page as assemble } from "./assemble.mjs";
import { launch, Page } from "../browser/browser.mjs";
import { equal, holds, verdict } from "../browser/check.mjs";
import { headChecks, rectangleSeen } from "./head_checks.mjs";
import { paintedMaps, plotChecks } from "./plot_checks.mjs";
import { shoot } from "./shots.mjs";
import { synthetic } from "./synthetic.mjs";
import { tableChecks } from "./table_checks.mjs";
import { touchChecks, viewerChecks } from "./viewer_checks.mjs";

const MOST_BYTES = 30e6;
const MOST_MS = 2000;

const [program, shots] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "report-pages-"));

/** A report of a kind on disk. */
function written(kind) {
  const file = join(folder, `${kind}.html`);
  writeFileSync(file, assemble(synthetic(kind)));
  return { url: pathToFileURL(file).href, bytes: statSync(file).size };
}

/** What must hold of every page when it was used. */
async function blameless(what, page) {
  equal(`${what}: faults in the console`, page.faults, []);
  equal(`${what}: requests`, page.requests.filter((url) => !url.startsWith("data:")), []);
  await page.close();
}

/** Opens a page, again where the machine was busy with something else: the least of three times counts. */
async function openedSoon(browser, url) {
  let page = await Page.open(browser, url);
  for (let turn = 1; turn < 3 && page.opened >= MOST_MS; turn++) {
    await page.close();
    page = await Page.open(browser, url);
  }
  return page;
}

async function fullReport(browser, { url, bytes }) {
  const page = await openedSoon(browser, url);
  console.log(`opening 200 runs: ${Math.round(page.opened)} ms, ${(bytes / 1e6).toFixed(1)} MB`);
  holds(`it opens within ${MOST_MS} ms`, page.opened < MOST_MS, page.opened);
  holds("it is small enough", bytes < MOST_BYTES, bytes);
  await headChecks(page);
  await tableChecks(page);
  await viewerChecks(page);
  await plotChecks(page);
  await blameless("full", page);
}

async function phone(browser, { url }) {
  const page = await Page.open(browser, url, { width: 360, height: 740, touch: true, scale: 2 });
  equal("nothing is wider than a phone", await page.run(() => document.documentElement.scrollWidth), 360);
  await touchChecks(page);
  await blameless("phone", page);
}

async function unreferenced(browser, { url }) {
  const page = await Page.open(browser, url);
  holds("the page says that there is no reference", (await page.text("#facts")).includes("None"));
  equal("noise is what is left to show", await page.run(() => [...document.querySelectorAll("#error-kind option")].map((option) => option.value)), ["noise"]);
  equal("columns of what is unknown are gone", await page.many('#group-table [data-key="bias"], #group-table [data-key="rmse"]'), 0);
  await blameless("unreferenced", page);
}

/** Groups that are held against different references. */
async function several(browser, { url }) {
  const page = await Page.open(browser, url);
  const facts = await page.text("#facts");
  holds("both references are told", facts.includes("cornell-reference.exr") && facts.includes("reference for albedo 0.9, 320 samples"), facts);
  holds("and who has none", facts.includes("1 group: only noise"), facts);
  holds("the notes say what is missing and why", (await page.text("#notes")).includes("have no ratios"), await page.text("#notes"));
  equal("the slots offer every reference", await page.run(() => document.querySelectorAll(".slot:first-child optgroup[label=References] option").length), 2);
  const names = () => page.run(() => [...document.querySelectorAll("#stage figcaption")].map((each) => each.textContent));
  equal("the first pictures belong together", await names(), ["A reference", "B cone, 4 samples, mean"]);
  const view = (row) => page.click(`#group-table tbody tr:nth-child(${row}) .view-buttons button:nth-child(1)`);
  await view(12);
  equal("a mean comes with its own reference", await names(), ["A reference for albedo 0.9", "B gaussian, 16 samples, mean"]);
  await view(20);
  equal("what has none leaves the slot as it is", (await names())[0], "A reference for albedo 0.9");
  await page.click("#group-table summary");
  await page.click("#group-table .menu label:nth-child(4) input");
  holds("a column names them", (await page.text("#group-table tbody tr:nth-child(12)")).includes("reference for albedo 0.9"), await page.text("#group-table thead"));
  await page.choose("#bars-kind", "equal_time");
  equal("no ratio between different pictures", await page.many("#bars .bar-row"), 10);
  await page.choose("#map-kind", "deviation_image");
  equal("the maps that there are", await page.many("#map-grid figure"), 4);
  equal("and that there are no more", await page.text("#map-tally"), "4 of 20 groups have this map here.");
  await page.choose("#region", "1");
  equal("regions lie right over smaller pictures", await rectangleSeen(page), true);
  await blameless("several", page);
}

async function hostile(browser, { url }) {
  const page = await Page.open(browser, url);
  equal("the title is text", await page.text("h1"), "</script><b>bold</b><!--<script>alert(1)");
  equal("no element came out of a name", await page.many("main b:not(.slot b), main i, body > b"), 0);
  holds("a seed of 64 bits is exact", await seedShown(page), await page.text("#run-table tbody tr"));
  equal("all groups are there", await page.many("#group-table tbody tr"), 20);
  await blameless("hostile", page);
}

async function sparse(browser, { url }) {
  const page = await Page.open(browser, url, { dark: true });
  equal("the dark system makes a dark page", await page.run(() => getComputedStyle(document.body).colorScheme), "light dark");
  holds("numbers stand without intervals", (await page.text("#group-table tbody tr td:nth-of-type(3)")).endsWith("%"), await page.text("#group-table tbody tr"));
  equal("wide pictures keep their shape", await page.run(() => {
    const { width, height } = document.querySelector("#stage canvas").getBoundingClientRect();
    return Math.round((4 * width) / height) / 4;
  }), 4);
  equal("no coordinate is missing", await page.run(() => [...document.querySelectorAll("svg *")].filter((node) => /NaN|Infinity/.test(node.outerHTML)).length), 0);
  await blameless("sparse", page);
}

/** On paper: no controls, long tables whole, maps drawn though nobody saw them. */
async function paper(browser, { url }) {
  const page = await Page.open(browser, url);
  await page.send("Page.printToPDF", {});
  equal("maps are painted for paper", await paintedMaps(page), 20);
  holds("plots are for the screen again", (await page.run(() => document.querySelector("#bars svg").viewBox.baseVal.width)) > 1000);
  await page.send("Emulation.setEmulatedMedia", { media: "print" });
  const shown = await page.run(() => [...document.querySelectorAll(".bar, .tools, .slots, #keys, main button:not(.chip, .map, thead button), select")].filter((each) => each.checkVisibility()).length);
  equal("controls on paper", shown, 0);
  equal("the long table is whole", await page.run(() => getComputedStyle(document.querySelector(".scroll.long")).maxHeight), "none");
  await blameless("paper", page);
}

async function seedShown(page) {
  await page.click("#run-table summary");
  const box = await page.run(() => [...document.querySelectorAll("#run-table .menu label")].findIndex((label) => label.textContent.trim() === "Seed") + 1);
  await page.click(`#run-table .menu label:nth-child(${box}) input`);
  return (await page.text("#run-table tbody tr")).includes("18446744073709551615");
}

async function empty(browser, { url }) {
  const page = await Page.open(browser, url);
  equal("sections without data are hidden, and so are their links", await page.run(() => [...document.querySelectorAll("main > section, nav a")].filter((each) => each.hidden).map((each) => each.id || each.hash)), ["#convergence", "#comparison", "#pictures", "#maps", "convergence", "comparison", "pictures", "maps"]);
  await blameless("empty", page);
}

const browser = await launch(program);
try {
  await browser.send("Browser.grantPermissions", { permissions: ["clipboardReadWrite", "clipboardSanitizedWrite"] });
  const full = written("full");
  await fullReport(browser, full);
  await phone(browser, full);
  await unreferenced(browser, written("unreferenced"));
  const many = written("several");
  await several(browser, many);
  await hostile(browser, written("hostile"));
  await sparse(browser, written("sparse"));
  await paper(browser, full);
  await empty(browser, written("empty"));
  if (shots) {
    mkdirSync(shots, { recursive: true });
    await shoot(browser, full.url, resolve(shots));
    await shoot(browser, many.url, resolve(shots), "several-");
    console.log(`screenshots are in ${shots}`);
  }
} catch (fault) {
  holds("the checks went through", false, fault.stack);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
process.exitCode = verdict() ? 0 : 1;
