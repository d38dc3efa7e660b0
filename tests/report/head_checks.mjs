// The head of the page: command, theme, region, and the values that are left out.
import { equal, holds } from "../browser/check.mjs";

const style = (page, name) => page.run((each) => getComputedStyle(document.body)[each], name);

export async function headChecks(page) {
  equal("the title", await page.text("h1"), "Sampling a spherical lamp");
  holds("the question is shown", (await page.text("#question")).endsWith("equal error?"));
  equal("findings", await page.many("#finding-list li"), 4);
  equal("levels of headings", await page.run(() => [...document.querySelectorAll("h1, h2")].map((each) => each.tagName).join("")), `H1${"H2".repeat(8)}`);
  equal("controls without a name", await page.run(() => [...document.querySelectorAll("button, select, input, [role=slider]")]
    .filter((each) => !(each.labels?.[0]?.textContent || each.textContent || each.getAttribute("aria-label")).trim()).length), 0);
  await copies(page);
  await theme(page);
  await leftOut(page);
  await regions(page);
}

async function copies(page) {
  const command = await page.text("#command");
  await page.click("#copy-command");
  await page.until("#copy-command", "Copied");
  equal("the command is copied", await page.run(() => navigator.clipboard.readText()), command);
  await page.run(() => {
    Clipboard.prototype.writeText = () => Promise.reject(new Error("not allowed"));
    addEventListener("copy", () => { document.body.dataset.copied = getSelection().toString() || document.activeElement.value; });
  });
  await page.click("#copy-command");
  equal("without a clipboard it is copied by a field", await page.run(() => document.body.dataset.copied), command);
}

async function theme(page) {
  const light = await style(page, "backgroundColor");
  await page.choose("#theme", "dark");
  const dark = await style(page, "backgroundColor");
  holds("the dark theme is dark", light !== dark, dark);
  await page.go(await page.run(() => location.href));
  equal("the theme is remembered", await style(page, "backgroundColor"), dark);
  await page.choose("#theme", "light");
  equal("the light theme is light", await style(page, "backgroundColor"), light);
  await page.choose("#theme", "");
  equal("the system's theme is light here", await style(page, "backgroundColor"), light);
}

async function leftOut(page) {
  const chip = (axis, at) => `.axis:nth-child(${axis}) .chip:nth-child(${at})`;
  const rows = async () => [await page.many("#group-table tbody tr"), await page.many("#run-table tbody tr"), await page.many("#bars .bar-row")];
  equal("rows at first", await rows(), [20, 200, 20]);
  await page.click(chip(1, 1));
  equal("a sampler is left out everywhere", await rows(), [15, 150, 15]);
  equal("its switch is up", await page.run((each) => document.querySelector(each).getAttribute("aria-pressed"), chip(1, 1)), "false");
  await page.click(chip(3, 2));
  equal("a seed is left out of the runs alone", await rows(), [15, 135, 15]);
  holds("the page says what is taken", (await page.text("#kept")).includes("135 of 200"), await page.text("#kept"));
  await page.focus(chip(1, 1));
  await page.key(" ");
  equal("Space takes a sampler back", await rows(), [20, 180, 20]);
  await page.click("#keep-all");
  equal("all are taken back", await rows(), [20, 200, 20]);
}

async function regions(page) {
  const bias = () => page.text("#group-table tbody tr:last-child td:nth-of-type(3)");
  const before = [await bias(), await page.text("#convergence-plots"), await page.text("#bars figcaption")];
  await page.choose("#region", "1");
  const after = [await bias(), await page.text("#convergence-plots"), await page.text("#bars figcaption")];
  holds("the table follows the region", before[0] !== after[0], after[0]);
  holds("the bars follow the region", after[2] === "penumbra", after[2]);
  equal("the rectangle is drawn over the picture", await rectangleSeen(page), true);
  await page.choose("#region", "0");
  equal("no rectangle for the whole", await rectangleSeen(page), false);
}

/** Whether the left edge of the penumbra's rectangle is white in the first picture, half down. */
export function rectangleSeen(page) {
  return page.run(() => {
    const canvas = document.querySelector("#stage canvas");
    const [x, y] = [Math.round((24 / 64) * canvas.width), Math.round((56 / 64) * canvas.height)];
    const pixels = canvas.getContext("2d").getImageData(x - 2, y, 6, 1).data;
    return [0, 1, 2, 3, 4, 5].some((at) => pixels[4 * at] > 200 && pixels[4 * at + 2] > 200);
  });
}
