// The viewer: slots, modes, exposure, zoom, pan, pixel values.
import { equal, holds } from "../browser/check.mjs";

const CANVAS = "#stage canvas";

/** A fingerprint of what a canvas shows. */
function drawn(page, at = 0) {
  return page.run((place) => {
    const canvas = document.querySelectorAll("#stage canvas")[place];
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let sum = 0;
    for (let byte = 0; byte < pixels.length; byte++) sum = (Math.imul(sum, 31) + pixels[byte]) | 0;
    return sum;
  }, at);
}

/** The colour in the middle of a share of a canvas. */
function colourAt(page, x, y, at = 0) {
  return page.run((shareX, shareY, place) => {
    const canvas = document.querySelectorAll("#stage canvas")[place];
    return [...canvas.getContext("2d").getImageData(Math.round(shareX * canvas.width), Math.round(shareY * canvas.height), 1, 1).data.slice(0, 3)];
  }, x, y, at);
}

const mode = (page, value) => page.click(`#modes label:has([value=${value}])`);
const zoom = (page) => page.text("#zoom-value");

export async function viewerChecks(page) {
  await page.go(await page.run(() => location.href));
  await slots(page);
  await exposure(page);
  await zooming(page);
  await pixels(page);
  await flipping(page);
  await slider(page);
  await difference(page);
}

async function slots(page) {
  equal("two pictures at first", await page.many(CANVAS), 2);
  await page.click("#add-picture");
  equal("one more", [await page.many(CANVAS), await page.many(".slot")], [3, 3]);
  const before = await drawn(page, 2);
  await page.choose(".slot:nth-child(3) select", "5");
  holds("another picture is chosen", before !== (await drawn(page, 2)));
  await page.click(".slot:nth-child(3) .remove");
  equal("it is taken away", await page.many(CANVAS), 2);
  const [one, other] = [await drawn(page, 0), await drawn(page, 1)];
  await page.click("#swap-pictures");
  equal("A and B are swapped", [await drawn(page, 0), await drawn(page, 1)], [other, one]);
  await page.click("#swap-pictures");
  await page.focus("#modes input:checked");
  await page.key("ArrowRight");
  equal("modes change by the keyboard", await page.many(CANVAS), 1);
  await mode(page, "side");
}

async function exposure(page) {
  const wall = () => colourAt(page, 0.5, 0.5);
  const [start] = await wall();
  await page.focus("#exposure");
  await page.key("ArrowRight");
  equal("the slider goes by quarter stops", await page.text("#exposure-value"), "+0.25 stops");
  holds("more exposure is brighter", (await wall())[0] > start, await wall());
  await page.click("#exposure", 0.2, 0.5);
  holds("the slider is dragged by the mouse", (await page.text("#exposure-value")).startsWith("−"), await page.text("#exposure-value"));
  holds("less exposure is darker", (await wall())[0] < start);
  await page.click("#exposure-reset");
  equal("exposure is reset", [await page.text("#exposure-value"), (await wall())[0]], ["0 stops", start]);
  await page.focus("#stage");
  await page.key("]");
  equal("] exposes more", await page.text("#exposure-value"), "+0.25 stops");
  await page.key("[");
  await page.key("[");
  equal("[ exposes less", await page.text("#exposure-value"), "−0.25 stops");
  await page.click("#exposure-reset");
  equal("the curve is that of sRGB", await expected(page), await colourAt(page, 31.5 / 64, 40.5 / 64));
}

/** The colour of pixel 31, 40 of the first picture by the numbers that the page shows. */
async function expected(page) {
  await page.hover(CANVAS, 31.5 / 64, 40.5 / 64);
  const numbers = await readings(page, 1);
  await page.hover("h1");
  return numbers.slice(0, 3).map((light) => Math.round(255 * (1.055 * light ** (1 / 2.4) - 0.055)));
}

/** The numbers in a row of the readout. */
function readings(page, row) {
  return page.run((at) => [...document.querySelectorAll(`#readout tbody tr:nth-child(${at}) td`)].map((cell) => Number(cell.textContent.replace("−", "-"))), row);
}

async function zooming(page) {
  const whole = await drawn(page);
  await page.focus("h1 ~ .command pre");
  await page.wheel(CANVAS, -300, 0.25, 0.25);
  equal("the wheel scrolls the page where no picture was pressed", await zoom(page), "1.0×");
  await page.click(CANVAS, 0.25, 0.25);
  const under = await place(page);
  await page.wheel(CANVAS, -300, 0.25, 0.25);
  equal("the wheel zooms", await zoom(page), "2.0×");
  await page.hover(CANVAS, 0.255, 0.255);
  equal("the pixel under the pointer stays there", await place(page), under);
  const zoomed = await drawn(page);
  holds("the picture is larger", zoomed !== whole);
  await page.hover(CANVAS, 0.7, 0.7);
  const held = await place(page);
  await page.drag(CANVAS, [0.7, 0.7], [0.4, 0.4]);
  equal("the pixel that is dragged goes with the pointer", await place(page), held);
  holds("dragging pans", (await drawn(page)) !== zoomed);
  await page.focus("#stage");
  const leftmost = await columnAtLeft(page);
  const dragged = await drawn(page);
  await page.key("ArrowLeft");
  const stepped = await drawn(page);
  holds("an arrow pans", stepped !== dragged);
  holds("to where it points", (await columnAtLeft(page)) < leftmost, leftmost);
  for (const key of ["ArrowUp", "ArrowRight", "ArrowDown"]) await page.key(key);
  equal("the arrows lead back to the column", await columnAtLeft(page), leftmost);
  equal("and to the picture", await drawn(page), dragged);
  await zoomByButtons(page);
  await inStep(page);
}

/** Keys and buttons, from twice the size to the whole. */
async function zoomByButtons(page) {
  await page.key("+");
  equal("+ zooms in", await zoom(page), "2.5×");
  await page.key("-");
  equal("- zooms out", await zoom(page), "2.0×");
  await page.click("#zoom-in");
  equal("the button zooms in", await zoom(page), "3.0×");
  await page.click("#zoom-out");
  equal("the button zooms out", await zoom(page), "2.0×");
  await page.click("#zoom-fit");
  await page.hover("h1");
  equal("Fit shows the whole", await zoom(page), "1.0×");
  await page.focus("#stage");
  await page.key("+");
  await page.key("0");
  equal("0 fits", await zoom(page), "1.0×");
}

/** The pixel that is read, in words. */
function place(page) {
  return page.text("#readout thead th");
}

/** The column of pixels at the left edge of the first picture. */
async function columnAtLeft(page) {
  await page.hover(CANVAS, 0.01, 0.5);
  return Number((await place(page)).match(/x (\d+)/)[1]);
}

/** Both panes show the same part: with the same picture in both, they are equal when zoomed. */
async function inStep(page) {
  const first = await page.run(() => document.querySelector(".slot select").value);
  const second = await page.run(() => document.querySelector(".slot:nth-child(2) select").value);
  await page.choose(".slot:nth-child(2) select", first);
  await page.click(CANVAS);
  await page.wheel("#stage figure:nth-child(2) canvas", -600, 0.3, 0.8);
  equal("pictures zoom in step", await drawn(page, 0), await drawn(page, 1));
  const edges = await page.run(() => {
    const canvas = document.querySelector("#stage canvas");
    const pixels = canvas.getContext("2d").getImageData(0, Math.round(canvas.height / 2), canvas.width, 1).data;
    let changes = 0;
    for (let x = 1; x < canvas.width; x++) changes += pixels[4 * x] !== pixels[4 * x - 4] || pixels[4 * x + 1] !== pixels[4 * x - 3] ? 1 : 0;
    return changes;
  });
  holds("enlarged pixels have hard edges", edges <= 24, edges);
  await page.click("#zoom-fit");
  await page.choose(".slot:nth-child(2) select", second);
}

async function pixels(page) {
  await page.hover(CANVAS, 10.5 / 64, 20.5 / 64);
  equal("the pixel under the pointer", await page.text("#readout thead th"), "x 10, y 20");
  const [one, other, between] = [await readings(page, 1), await readings(page, 2), await readings(page, 3)];
  holds("numbers of every picture", one.every((value) => value > 0) && other.every((value) => value > 0), [one, other]);
  holds("and their difference", Math.abs(one[0] - other[0] - between[0]) < 2e-4, between);
  await page.focus("#stage");
  await page.key("ArrowRight", 8);
  await page.key("ArrowDown", 8);
  equal("Shift and arrows move the pixel", await page.text("#readout thead th"), "x 11, y 21");
}

async function flipping(page) {
  await mode(page, "flip");
  const shown = () => page.text("#stage figcaption");
  const [a] = [await shown()];
  await page.click(CANVAS);
  const b = await shown();
  holds("a click flips", a !== b && b.startsWith("B"), b);
  await page.key(" ");
  equal("Space flips back", await shown(), a);
  await page.choose("#flip-every", "500");
  await page.click("#flip-play");
  equal("the button offers a pause", await page.text("#flip-play"), "Pause");
  await page.run(() => new Promise((done) => setTimeout(done, 700)));
  equal("it flips by itself", await shown(), b);
  await page.choose("#flip-every", "2000");
  await page.click("#flip-play");
  const paused = await shown();
  await page.run(() => new Promise((done) => setTimeout(done, 700)));
  equal("a pause holds it", [await shown(), await page.text("#flip-play")], [paused, "Play"]);
}

async function slider(page) {
  await mode(page, "slider");
  const value = () => page.run(() => document.querySelector(".handle").getAttribute("aria-valuenow"));
  equal("the slider starts in the middle", await value(), "50");
  const middle = await drawn(page);
  await page.focus(".handle");
  for (const [key, wanted] of [["ArrowRight", "52"], ["ArrowLeft", "50"], ["Home", "0"], ["End", "100"]]) {
    await page.key(key);
    equal(`${key} moves the slider`, await value(), wanted);
  }
  holds("the picture follows the slider", middle !== (await drawn(page)));
  const box = await page.run(() => { const { left, width } = document.querySelector(".frame").getBoundingClientRect(); return { left, width }; });
  const from = await page.place(".handle");
  const to = { x: box.left + box.width * 0.3, y: from.y };
  await page.mouse("mousePressed", { x: box.left + box.width - 4, y: from.y }, { clickCount: 1, buttons: 1 });
  await page.mouse("mouseMoved", to, { buttons: 1 });
  await page.mouse("mouseReleased", to, { clickCount: 1 });
  await page.settle();
  equal("the slider is dragged", await value(), "30");
}

async function difference(page) {
  await mode(page, "difference");
  equal("the difference has a legend", await page.text("#scales p"), "A − B, mean of the channels");
  const end = async () => Number(await page.text("#scales .ends span:last-child"));
  const widest = await end();
  await page.focus("#stage");
  for (let stops = 0; stops < 4; stops++) await page.key("]");
  holds("a stop halves its scale", Math.abs((await end()) / widest - 0.5) < 0.05, [widest, await end()]);
  await page.click("#exposure-reset");
  const first = await page.run(() => document.querySelector(".slot select").value);
  await page.choose(".slot:nth-child(2) select", first);
  equal("no difference is near white", await colourAt(page, 0.3, 0.3), [247, 246, 246]);
  await mode(page, "side");
}

/** Two fingers on a phone. */
export async function touchChecks(page) {
  await page.pinch("#stage figure canvas", 0.2, 0.8);
  const times = parseFloat(await zoom(page));
  holds("a pinch zooms", times > 2.5 && times < 5.5, times);
  await page.pinch("#stage figure canvas", 0.8, 0.2);
  holds("and back", parseFloat(await zoom(page)) < 2, await zoom(page));
}
