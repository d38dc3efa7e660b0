// Pictures of the page as readers see it.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { Page } from "../browser/browser.mjs";

const VIEWS = [
  { name: "desktop-light", width: 1280 },
  { name: "desktop-dark", width: 1280, dark: true },
  { name: "phone", width: 360, height: 740, touch: true, scale: 2 },
];

/** Lets everything that waits for the reader come, then goes back to the top. */
async function wake(page) {
  await page.run(() => document.getElementById("maps").scrollIntoView());
  await page.run(() => new Promise((done) => setTimeout(done, 300)));
  await page.run(() => scrollTo(0, 0));
  await page.settle();
}

/** Writes PNGs of the whole page and a PDF as it is printed. */
export async function shoot(browser, url, folder, prefix = "") {
  for (const { name, ...look } of VIEWS) {
    const page = await Page.open(browser, url, look);
    await wake(page);
    writeFileSync(join(folder, `${prefix}${name}.png`), Buffer.from(await page.screenshot(), "base64"));
    if (name === "desktop-dark") await print(page, join(folder, `${prefix}print.pdf`));
    await page.close();
  }
}

async function print(page, file) {
  const { data } = await page.send("Page.printToPDF", { preferCSSPageSize: true, printBackground: false, paperWidth: 8.27, paperHeight: 11.69 });
  writeFileSync(file, Buffer.from(data, "base64"));
}
