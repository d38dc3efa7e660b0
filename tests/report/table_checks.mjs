// The two tables: sorting, filters, columns, CSV, and the buttons that lead to the pictures.
import { equal, holds } from "../browser/check.mjs";

export async function tableChecks(page) {
  await sorting(page);
  await filtering(page);
  await columns(page);
  await csv(page);
  await intoViewer(page);
}

const head = (table, key) => `#${table} thead button[data-key="${key}"]`;
const cells = (page, table, at) => page.run((each, column) => [...document.querySelectorAll(`#${each} tbody tr`)].map((row) => row.children[column].textContent), table, at);

function order(page, table, key) {
  return page.run((each) => document.querySelector(each).closest("th").getAttribute("aria-sort"), head(table, key));
}

/** Every column that can sort: by mouse up, by keyboard down, by mouse back. */
async function sorting(page) {
  for (const table of ["group-table", "run-table"]) {
    const keys = await page.run((each) => [...document.querySelectorAll(`#${each} thead button`)].map((node) => node.dataset.key), table);
    holds(`${table} has columns to sort by`, keys.length >= 7, keys);
    for (const key of keys) {
      await page.click(head(table, key));
      equal(`${table}: ${key} up`, await order(page, table, key), "ascending");
      await page.key("Enter");
      equal(`${table}: ${key} down by the keyboard`, await order(page, table, key), "descending");
      await page.key("Enter");
      equal(`${table}: ${key} no more`, await order(page, table, key), "none");
    }
  }
  const samples = async () => (await cells(page, "group-table", 1)).map((text) => Number(text.replace(/\D/g, "")));
  await page.click(head("group-table", "samples"));
  equal("samples go up", (await samples()).toString(), [4, 16, 64, 256, 1024].flatMap((each) => Array(4).fill(each)).toString());
  await page.click(head("group-table", "samples"));
  equal("samples go down", (await samples())[0], 1024);
  await page.click(head("group-table", "samples"));
  await page.click(head("group-table", "crossing"));
  const crossings = await cells(page, "group-table", 6);
  holds("what is missing comes last", crossings[0] !== "–" && crossings.at(-1) === "–", crossings);
  await page.click(head("group-table", "crossing"));
  holds("and last again the other way", (await cells(page, "group-table", 6)).at(-1) === "–");
  await page.click(head("group-table", "crossing"));
}

async function filtering(page) {
  const search = "#run-table input[type=search]";
  await page.type(search, "gaussian NVIDIA");
  equal("all words must be there", await page.many("#run-table tbody tr"), 25);
  equal("the tally says so", await page.text("#run-table .tally"), "25 of 200");
  await page.type(search, "timeout");
  equal("a status is found", await cells(page, "run-table", 0), ["run-199"]);
  holds("its error is shown", (await page.text("#run-table tbody")).includes("no answer for 120 s"));
  await page.type(search, "nothing-of-this-name");
  holds("an empty table says why", (await page.text("#run-table tbody")).includes("Nothing passes"));
  await page.type(search, "");
  equal("an empty filter takes all", await page.many("#run-table tbody tr"), 200);
  await page.type("#group-table input[type=search]", "cone");
  equal("groups are filtered too", await page.many("#group-table tbody tr"), 5);
  await page.type("#group-table input[type=search]", "");
}

/** Every column is switched, and switched back. */
async function columns(page) {
  for (const table of ["group-table", "run-table"]) {
    const heads = () => page.many(`#${table} thead th`);
    await page.click(`#${table} summary`);
    const boxes = await page.many(`#${table} .menu input`);
    const first = await heads();
    for (let at = 2; at <= boxes; at++) {
      const box = `#${table} .menu label:nth-child(${at}) input`;
      const change = (await page.run((each) => document.querySelector(each).checked, box)) ? -1 : 1;
      await page.click(box);
      equal(`${table}: column ${at} is switched`, await heads(), first + change);
      await page.click(box);
      equal(`${table}: column ${at} is switched back`, await heads(), first);
    }
    await page.key("Escape");
    equal("Escape closes the choice of columns", await page.many("details[open]"), 0);
  }
}

async function csv(page) {
  await page.go(await page.run(() => location.href));
  await page.type("#group-table input[type=search]", "gaussian");
  await page.click("#group-table .copy-csv");
  await page.until("#group-table .copy-csv", "Copied");
  const lines = (await page.run(() => navigator.clipboard.readText())).split(/\r?\n/).filter(Boolean);
  equal("CSV: the shown rows and a head", lines.length, 6);
  holds("CSV: intervals have columns of their own", lines[0].includes("Bias,Bias low,Bias high"), lines[0]);
  holds("CSV: names with commas are quoted", lines[1].startsWith('"gaussian, 4 samples",4,'), lines[1]);
  await page.type("#group-table input[type=search]", "");
  await page.click("#run-table .copy-csv");
  await page.until("#run-table .copy-csv", "Copied");
  const runs = (await page.run(() => navigator.clipboard.readText())).split(/\r?\n/).filter(Boolean);
  equal("CSV: all runs", runs.length, 201);
  holds("CSV: axes by their paths", runs[0].includes("light.sampler,render.samples,render.seed"), runs[0]);
}

async function intoViewer(page) {
  const slot = () => page.text("#stage figure:last-child figcaption");
  await page.click("#group-table tbody tr:nth-child(20) .view-buttons button:nth-child(2)");
  equal("a group's bias goes to the viewer", await slot(), "B uniform-angles, 1024 samples, bias");
  equal("its scale has a legend", await page.many("#scales .colour-legend"), 1);
  await page.click("#group-table tbody tr:nth-child(20) .view-buttons button:nth-child(3)");
  equal("so does its deviation", await slot(), "B uniform-angles, 1024 samples, deviation");
  await page.click("#group-table tbody tr:nth-child(1) .view-buttons button:nth-child(1)");
  equal("so does a mean", await slot(), "B cone, 4 samples, mean");
  await page.click("#run-table tbody tr:nth-child(3) .view-buttons button");
  equal("so does a run", await slot(), "B cone, 4 samples, seed 2");
  equal("a failed run has no picture", await page.run(() => document.querySelectorAll("#run-table tbody tr")[37].querySelectorAll(".view-buttons").length), 0);
}
