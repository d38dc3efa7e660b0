// Opens the page of figures in a headless Chromium, light and dark, on a desk and on a phone.
// node run.mjs CHROMIUM FOLDER [FOLDER FOR SCREENSHOTS]
import { readdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { launch, Page } from "../browser/browser.mjs";
import { equal, holds, verdict } from "../browser/check.mjs";

const VIEWS = [
  { name: "desktop-light", width: 1280 },
  { name: "desktop-dark", width: 1280, dark: true },
  { name: "phone-light", width: 390, height: 844, touch: true, scale: 2 },
  { name: "phone-dark", width: 390, height: 844, touch: true, scale: 2, dark: true },
];

const [program, folder, shots] = process.argv.slice(2);
const url = pathToFileURL(join(folder, "index.html")).href;

/** Pairs of texts of one plot that lie on each other, as the browser sets them. */
function colliding() {
  const found = [];
  for (const plot of document.querySelectorAll("svg.lampray-plot")) {
    const texts = [...plot.querySelectorAll("text")].map((text) => [text.textContent, text.getBoundingClientRect()]);
    texts.forEach(([words, a], index) => texts.slice(index + 1).forEach(([others, b]) => {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      // Boxes of lines hold the room for descenders: letters touch only beyond it.
      if (across > 1 && down > 3) found.push([words, others]);
    }));
  }
  return found;
}

/** Texts that reach out of their plot. */
function cutOff() {
  return [...document.querySelectorAll("svg.lampray-plot")].flatMap((plot) => {
    const box = plot.getBoundingClientRect();
    const out = (text) => {
      const { left, right, top, bottom } = text.getBoundingClientRect();
      return left < box.left - 1 || right > box.right + 1 || top < box.top - 4 || bottom > box.bottom + 4;
    };
    return [...plot.querySelectorAll("text")].filter(out).map((text) => text.textContent);
  });
}

/** Parts of the page that lie on each other though they follow each other. */
function stacked() {
  const found = [];
  for (const parent of document.querySelectorAll("main, section, .cells, .beside-plots")) {
    const boxes = [...parent.children].map((each) => [each.className || each.tagName, each.getBoundingClientRect()]).filter(([, box]) => box.width > 0);
    boxes.forEach(([name, a], index) => boxes.slice(index + 1).forEach(([other, b]) => {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > 1 && down > 1) found.push([name, other]);
    }));
  }
  return found;
}

/** What must hold however the page is looked at. */
async function checkPage(page, { name, width }) {
  equal(`${name}: nothing is wider than the window`, await page.run(() => document.documentElement.scrollWidth), width);
  equal(`${name}: no text of a plot lies on another`, await page.run(colliding), []);
  equal(`${name}: no text of a plot is cut off`, await page.run(cutOff), []);
  equal(`${name}: no part lies on another`, await page.run(stacked), []);
  equal(`${name}: pictures without pixels`, await page.run(() => [...document.images].filter((each) => each.hasAttribute("src") && !each.naturalWidth).length), 0);
  holds(`${name}: there are pictures`, (await page.many(".cell img")) > 10);
  holds(`${name}: there are plots`, (await page.many("svg.lampray-plot")) > 5);
}

async function checkLinks(page) {
  const links = await page.run(() => [...document.querySelectorAll("main a, nav a")].map((each) => each.getAttribute("href")));
  holds("there are links", links.length > 10, links);
  for (const link of links) {
    if (link.startsWith("#")) equal(`${link} leads somewhere`, await page.many(link), 1);
    else holds(`${link} lies beside the page`, readdirSync(folder).includes(link));
  }
}

/** A picture opens large; the arrow keys flip to its neighbours in place. */
async function checkViewer(page) {
  const seen = () => page.run(() => document.querySelector("#viewer img").alt);
  await page.click(".cell img");
  holds("a picture opens", await page.run(() => document.querySelector("#viewer").open));
  const first = await seen();
  await page.key("ArrowDown");
  holds("down shows the row below", (await seen()) !== first, first);
  await page.key("ArrowUp");
  equal("up comes back", await seen(), first);
  const size = () => page.run(() => document.querySelector("#viewer img").getBoundingClientRect().width);
  equal("it is a whole multiple of itself", (await size()) % 128, 0);
  await page.click("#viewer header button");
  holds("it closes", await page.run(() => !document.querySelector("#viewer").open));
}

async function checkTheme(page) {
  const paper = () => page.run(() => getComputedStyle(document.body).backgroundColor);
  const light = await paper();
  await page.choose(".kicker select", "dark");
  holds("the theme can be chosen", (await paper()) !== light, light);
  equal("plots follow the theme", await page.run(() => getComputedStyle(document.querySelector("svg .ink")).fill), "rgb(231, 232, 234)");
  await page.choose(".kicker select", "");
}

async function view(browser, look) {
  const page = await Page.open(browser, url, look);
  await checkPage(page, look);
  if (shots) await photograph(page, look.name);
  if (look.name === "desktop-light") {
    await checkLinks(page);
    await checkTheme(page);
    await checkViewer(page);
    if (shots) await print(page);
  }
  equal(`${look.name}: faults in the console`, page.faults, []);
  equal(`${look.name}: requests`, page.requests.filter((each) => !each.startsWith("data:")), []);
  await page.close();
}

/** The page in pieces: a browser does not draw one so long at once. */
async function photograph(page, name) {
  const PIECE = 3000;
  const { cssContentSize } = await page.send("Page.getLayoutMetrics");
  const { width, height } = cssContentSize;
  for (let y = 0; y < height; y += PIECE) {
    const clip = { x: 0, y, width, height: Math.min(PIECE, height - y), scale: 1 };
    const { data } = await page.send("Page.captureScreenshot", { clip, captureBeyondViewport: true });
    writeFileSync(join(shots, `${name}-${y / PIECE + 1}.png`), Buffer.from(data, "base64"));
  }
}

async function print(page) {
  const { data } = await page.send("Page.printToPDF", { preferCSSPageSize: true, paperWidth: 8.27, paperHeight: 11.69 });
  writeFileSync(join(shots, "print.pdf"), Buffer.from(data, "base64"));
}

/** Each plot as a document of its own, as it is opened from a disk. */
async function alone(browser) {
  for (const name of readdirSync(folder).filter((each) => each.endsWith(".svg"))) {
    for (const dark of [false, true]) {
      const page = await Page.open(browser, pathToFileURL(join(folder, name)).href, { width: 1200, height: 480, dark });
      equal(`${name} alone: no text lies on another`, await page.run(colliding), []);
      equal(`${name} alone: no text is cut off`, await page.run(cutOff), []);
      equal(`${name} alone: faults`, page.faults, []);
      if (shots) writeFileSync(join(shots, `${name}-${dark ? "dark" : "light"}.png`), Buffer.from(await page.screenshot(), "base64"));
      await page.close();
    }
  }
}

const browser = await launch(program);
try {
  console.log(`index.html has ${(statSync(join(folder, "index.html")).size / 1e6).toFixed(2)} MB`);
  for (const look of VIEWS) await view(browser, look);
  await alone(browser);
} catch (fault) {
  holds("the checks went through", false, fault.stack);
} finally {
  await browser.close();
}
process.exitCode = verdict() ? 0 : 1;
