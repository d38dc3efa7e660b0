// A headless Chromium, driven through its DevTools protocol with nothing but Node.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-port=0", "--no-first-run", "--disable-background-networking", "--disable-component-update"];
const PATIENCE_MS = 60000;
const KEYS = { " ": "Space", "[": "BracketLeft", "]": "BracketRight", "+": "Equal", "-": "Minus", 0: "Digit0" };

/** Starts Chromium; its profile is taken away with `close`. */
export async function launch(program) {
  const profile = mkdtempSync(join(tmpdir(), "report-"));
  const child = spawn(program, [...FLAGS, `--user-data-dir=${profile}`, "about:blank"], { stdio: ["ignore", "ignore", "pipe"] });
  const address = await new Promise((found, failed) => {
    let said = "";
    child.stderr.on("data", (text) => {
      said += text;
      const match = said.match(/DevTools listening on (ws:\S+)/);
      if (match) found(match[1]);
    });
    child.on("exit", () => failed(new Error(`Chromium ended: ${said}`)));
    setTimeout(() => failed(new Error(`Chromium does not answer: ${said}`)), PATIENCE_MS).unref();
  });
  const send = await connect(address);
  const close = async () => {
    const ended = new Promise((done) => child.on("exit", done));
    await send("Browser.close");
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
  };
  return { send, close };
}

/** A function that sends a command and waits for its answer; `send.on` hears events. */
async function connect(address) {
  const socket = new WebSocket(address);
  await new Promise((opened, failed) => {
    socket.onopen = opened;
    socket.onerror = () => failed(new Error(`no connection to ${address}`));
  });
  const waiting = new Map();
  const hearers = [];
  let last = 0;
  socket.onmessage = ({ data }) => {
    const message = JSON.parse(data);
    if (!message.id) return hearers.forEach((hear) => hear(message));
    const { answered, failed } = waiting.get(message.id);
    waiting.delete(message.id);
    return message.error ? failed(new Error(message.error.message)) : answered(message.result);
  };
  const send = (method, params = {}, sessionId = undefined) => new Promise((answered, failed) => {
    waiting.set(++last, { answered, failed });
    setTimeout(() => failed(new Error(`no answer to ${method}`)), PATIENCE_MS).unref();
    socket.send(JSON.stringify({ id: last, method, params, sessionId }));
  });
  send.on = (hear) => hearers.push(hear);
  return send;
}

/** One page: what a reader does with it, and what it did wrong. */
export class Page {
  static async open(browser, url, { width = 1280, height = 900, dark = false, touch = false, scale = 1 } = {}) {
    const { targetId } = await browser.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await browser.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page();
    Object.assign(page, { targetId, faults: [], requests: [], loaded: null });
    page.send = (method, params) => browser.send(method, params, sessionId);
    browser.send.on((message) => { if (message.sessionId === sessionId) page.hear(message); });
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile: touch });
    await page.send("Emulation.setTouchEmulationEnabled", { enabled: touch, maxTouchPoints: touch ? 5 : 1 });
    await page.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    await page.go(url);
    return page;
  }

  hear({ method, params }) {
    if (method === "Page.loadEventFired") this.loaded?.();
    if (method === "Runtime.exceptionThrown") this.faults.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) this.faults.push(params.args.map((each) => each.value).join(" "));
    if (method === "Log.entryAdded" && params.entry.level === "error") this.faults.push(params.entry.text);
    if (method === "Network.requestWillBeSent" && params.type !== "Document") this.requests.push(params.request.url.slice(0, 100));
  }

  /** Opens a URL; returns the milliseconds until two frames after loading were drawn. */
  async go(url) {
    const start = performance.now();
    const loaded = new Promise((done) => { this.loaded = done; });
    await this.send("Page.navigate", { url });
    await loaded;
    await this.settle();
    this.opened = performance.now() - start;
  }

  /** Waits until what was asked for is drawn. */
  async settle() {
    await this.run(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  /** Runs a function in the page, with arguments that JSON can hold. */
  async run(body, ...values) {
    const expression = `(${body})(${values.map((value) => JSON.stringify(value)).join(",")})`;
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  text(selector) { return this.run((each) => document.querySelector(each).textContent, selector); }
  many(selector) { return this.run((each) => document.querySelectorAll(each).length, selector); }

  /** Brings an element into sight; returns a place in it, in shares of its box. */
  async place(selector, x = 0.5, y = 0.5) {
    const box = await this.run(async (each) => {
      const node = document.querySelector(each);
      if (!node) throw new Error(`nothing is ${each}`);
      node.scrollIntoView({ block: "center", inline: "center", behavior: "instant" });
      await new Promise((done) => requestAnimationFrame(done));
      const { left, top, width, height } = node.getBoundingClientRect();
      return { left, top, width, height };
    }, selector);
    return { x: box.left + box.width * x, y: box.top + box.height * y };
  }

  mouse(type, at, more = {}) { return this.send("Input.dispatchMouseEvent", { type, ...at, button: "left", ...more }); }

  async click(selector, x, y) {
    const at = await this.place(selector, x, y);
    await this.mouse("mouseMoved", at, { button: "none" });
    await this.mouse("mousePressed", at, { clickCount: 1, buttons: 1 });
    await this.mouse("mouseReleased", at, { clickCount: 1 });
    await this.settle();
  }

  /** Waits until a text is there; fails when it does not come. */
  async until(selector, text) {
    for (let tries = 0; tries < 100; tries++) {
      if ((await this.text(selector)) === text) return;
      await this.settle();
    }
    throw new Error(`${selector} never said ${text}`);
  }

  async hover(selector, x, y) {
    await this.mouse("mouseMoved", await this.place(selector, x, y), { button: "none" });
    await this.settle();
  }

  /** Presses at one share of an element, moves to another, lets go. */
  async drag(selector, from, to) {
    const start = await this.place(selector, ...from);
    const end = await this.place(selector, ...to);
    await this.mouse("mouseMoved", start, { button: "none" });
    await this.mouse("mousePressed", start, { clickCount: 1, buttons: 1 });
    for (const share of [0.5, 1]) {
      await this.mouse("mouseMoved", { x: start.x + (end.x - start.x) * share, y: start.y + (end.y - start.y) * share }, { buttons: 1 });
    }
    await this.mouse("mouseReleased", end, { clickCount: 1 });
    await this.settle();
  }

  async wheel(selector, deltaY, x, y) {
    await this.mouse("mouseWheel", await this.place(selector, x, y), { button: "none", deltaX: 0, deltaY });
    await this.settle();
  }

  /** Two fingers that move apart, from one share of the width between them to another. */
  async pinch(selector, from, to) {
    const touch = async (type, apart) => {
      const [one, other] = [await this.place(selector, 0.5 - apart / 2), await this.place(selector, 0.5 + apart / 2)];
      await this.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ ...one, id: 1 }, { ...other, id: 2 }] });
    };
    await touch("touchStart", from);
    for (const share of [0.25, 0.5, 0.75, 1]) await touch("touchMove", from + (to - from) * share);
    await touch("touchEnd", to);
    await this.settle();
  }

  async focus(selector) {
    await this.run((each) => document.querySelector(each).focus(), selector);
    await this.settle();
  }

  /** Presses a key where the focus is; `modifiers` as the protocol has them, 8 is Shift. */
  async key(key, modifiers = 0) {
    const text = key.length === 1 ? key : key === "Enter" ? "\r" : undefined;
    const codes = { ArrowLeft: 37, Delete: 46, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, Home: 36, End: 35, Enter: 13, Escape: 27, Tab: 9, " ": 32 };
    const what = { key, code: KEYS[key] ?? key, modifiers, windowsVirtualKeyCode: codes[key] ?? key.charCodeAt(0) };
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", text, ...what });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...what });
    await this.settle();
  }

  async type(selector, text) {
    await this.run((each) => { const node = document.querySelector(each); node.focus(); node.select(); }, selector);
    if (text === "") await this.key("Delete");
    else await this.send("Input.insertText", { text });
    await this.settle();
  }

  /** Chooses an option of a select, by its value. */
  async choose(selector, value) {
    await this.run((each, wanted) => {
      const select = document.querySelector(each);
      select.focus();
      select.value = wanted;
      if (select.value !== String(wanted)) throw new Error(`${each} has no ${wanted}`);
      select.dispatchEvent(new Event("input", { bubbles: true }));
      select.dispatchEvent(new Event("change", { bubbles: true }));
    }, selector, value);
    await this.settle();
  }

  /** The whole page as a PNG, in base64. */
  async screenshot() {
    const { cssContentSize } = await this.send("Page.getLayoutMetrics");
    const clip = { x: 0, y: 0, width: cssContentSize.width, height: Math.min(cssContentSize.height, 16000), scale: 1 };
    return (await this.send("Page.captureScreenshot", { clip, captureBeyondViewport: true })).data;
  }

  close() { return this.send("Page.close"); }
}
