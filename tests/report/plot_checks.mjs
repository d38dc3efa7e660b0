// Convergence, bars and maps.
import { equal, holds } from "../browser/check.mjs";

export async function plotChecks(page) {
  await page.go(await page.run(() => location.href));
  await lines(page);
  await legend(page);
  await tips(page);
  await bars(page);
  await maps(page);
}

const plot = (page) => page.run(() => document.querySelector("#convergence-plots").innerHTML.length);

async function lines(page) {
  equal("lines and their points", [await page.many(".plots .series"), await page.many("#convergence-plots .point")], [8, 40]);
  equal("N* is marked where bias is seen", await page.many(".crossing"), 2);
  equal("limits of what is not seen", (await page.many(".point.limit")) >= 8, true);
  for (const kind of ["relrmse", "noise", "rmse"]) {
    const before = await page.text("#convergence-plots figcaption");
    await page.choose("#error-kind", kind);
    holds(`the error is ${kind}`, before !== (await page.text("#convergence-plots figcaption")));
  }
  const before = await page.text("#convergence-plots .axis-title");
  await page.choose("#error-against", "seconds");
  equal("against seconds", [before, await page.text("#convergence-plots .axis-title")], ["Samples a pixel", "Seconds"]);
  equal("N* has its place in seconds too", await page.many(".crossing"), 2);
  await page.choose("#error-against", "samples");
  for (const [box, what] of [["#show-bands", ".band"], ["#show-guide", ".guide"]]) {
    const many = await page.many(what);
    await page.click(box);
    equal(`${box} takes away`, await page.many(what), 0);
    await page.click(box);
    equal(`${box} brings back`, await page.many(what), many);
  }
}

async function legend(page) {
  const whole = await plot(page);
  for (let at = 1; at <= 4; at++) {
    const key = `#convergence-legend .chip:nth-child(${at})`;
    await page.click(key);
    equal(`line ${at} is hidden`, await page.many(".plots .series"), 6);
    await page.focus(key);
    await page.key("Enter");
    equal(`line ${at} is back`, [await page.many(".plots .series"), await plot(page)], [8, whole]);
  }
}

async function tips(page) {
  await page.hover("#convergence-plots .point");
  const hovered = await page.text("#tip");
  holds("a point tells its numbers", hovered.includes("cone") && hovered.includes("4 samples") && hovered.includes("√MSE"), hovered);
  await page.hover("h1");
  equal("the tip goes", await page.run(() => document.querySelector("#tip").hidden), true);
  await page.focus(".crossing");
  holds("the keyboard reaches N*", (await page.text("#tip")).includes("N*"), await page.text("#tip"));
  await page.key("Escape");
  equal("Escape closes the tip", await page.run(() => document.querySelector("#tip").hidden), true);
  await page.hover("#bars .bar-row", 0.6, 0.5);
  holds("a bar tells its numbers", (await page.text("#tip")).includes("Bias"), await page.text("#tip"));
  await page.hover("h1");
}

async function bars(page) {
  const kinds = await page.run(() => [...document.querySelectorAll("#bars-kind option")].map((option) => option.value));
  equal("quantities", kinds, ["bias", "variance", "mse", "efficiency", "equal_time", "equal_error", "mean"]);
  for (const kind of kinds) {
    await page.choose("#bars-kind", kind);
    equal(`${kind}: a row for each group, with an interval`, [await page.many("#bars .bar-row"), await page.many("#bars .error")], [20, 20]);
    if (kind === "bias") {
      equal("signed numbers have no logarithm", await page.run(() => document.querySelector("#bars-log").disabled), true);
      continue;
    }
    const linear = await page.text("#bars");
    await page.click("#bars-log");
    holds(`${kind}: logarithmic`, linear !== (await page.text("#bars")) && (await page.many("#bars .dot")) === 20);
    await page.click("#bars-log");
    equal(`${kind}: linear again`, await page.text("#bars"), linear);
  }
  await page.choose("#bars-regions", "all");
  equal("all regions", [await page.many("#bars figure"), await page.many("#bars .bar-row")], [3, 60]);
  await page.choose("#bars-regions", "one");
  equal("one region", await page.many("#bars figure"), 1);
}

/** How many maps have paint in their middle. */
export function paintedMaps(page) {
  return page.run(() => [...document.querySelectorAll("#map-grid canvas")].filter((canvas) => {
    const { width, height } = canvas;
    return canvas.getContext("2d").getImageData(width / 2, height / 2, 1, 1).data[3] > 0;
  }).length);
}

async function maps(page) {
  const height = () => page.run(() => document.querySelector("#maps").offsetHeight);
  await page.run(() => scrollTo(0, 0));
  await page.go(await page.run(() => location.href));
  const before = [await height(), await paintedMaps(page)];
  await page.place("#maps");
  await page.run(() => new Promise((done) => setTimeout(done, 300)));
  equal("maps are painted when they come near, and nothing moves", [before, await height(), await paintedMaps(page)], [[before[0], 0], before[0], 20]);
  for (const [kind, legends] of [["deviation_image", 1], ["mean_image", 0], ["bias_image", 1]]) {
    await page.choose("#map-kind", kind);
    equal(`maps: ${kind}`, [await page.many("#map-grid canvas"), await page.many("#map-legend .ramp")], [20, legends]);
  }
  await page.click("#map-grid figure:nth-child(20) button");
  equal("a map goes to the viewer", await page.text("#stage figure:last-child figcaption"), "B uniform-angles, 1024 samples, bias");
}
