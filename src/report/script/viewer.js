// The viewer: pictures side by side, flipped, under a slider, or as a difference.

const MOST_SLOTS = 6;
let flipTimer = null;
let drawnSoon = false;

/** Pictures under headings, for the choices. */
function pictureHeadings() {
  const headings = { References: new Set(), "Means of groups": new Set(), Bias: new Set(), Deviation: new Set(), Runs: new Set(), Others: new Set() };
  const put = (heading, index) => { if (index !== null && index !== undefined) headings[heading].add(index); };
  for (const reference of data.references) put("References", reference.image);
  for (const group of data.groups) {
    put("Means of groups", group.mean_image);
    put("Bias", group.bias_image);
    put("Deviation", group.deviation_image);
  }
  for (const run of data.runs) put("Runs", run.image);
  const known = new Set(Object.values(headings).flatMap((set) => [...set]));
  data.images.forEach((_, index) => { if (!known.has(index)) put("Others", index); });
  return Object.entries(headings).filter(([, set]) => set.size > 0);
}

/** A slot: its letter, the choice of a picture, and a button that takes it away. */
function slotRow(at, headings) {
  const groups = headings.map(([label, set]) => element("optgroup", { label }, ...[...set].map((index) => element("option", { value: index }, data.images[index].name))));
  const select = element("select", { change: () => {
    shown.slots[at] = Number(select.value);
    drawSoon();
  } }, ...groups);
  select.value = shown.slots[at];
  const remove = button("×", () => {
    shown.slots.splice(at, 1);
    arrange();
  }, { "aria-label": `Take away picture ${LETTERS[at]}`, class: "remove", disabled: shown.slots.length <= 1 });
  return element("div", { class: "slot" }, element("label", {}, element("b", {}, LETTERS[at]), " ", select), remove);
}

/** Builds slots and panes anew after their number or the mode changed. */
function arrange() {
  const headings = pictureHeadings();
  byId("slots").replaceChildren(...shown.slots.map((_, at) => slotRow(at, headings)));
  byId("add-picture").disabled = shown.slots.length >= MOST_SLOTS;
  byId("swap-pictures").disabled = shown.slots.length < 2;
  byId("flip-tools").hidden = shown.mode !== "flip";
  if (shown.mode !== "flip") playFlip(false);
  const stage = byId("stage");
  stage.className = shown.mode;
  stage.replaceChildren(...panesOfMode().map(makePane));
  drawSoon();
}

/** A pane with its canvas and its name; the slider's has a handle. */
function makePane(slots) {
  const canvas = element("canvas");
  followFingers(canvas, {
    moved: drawSoon,
    pressed: () => { if (shown.mode === "flip") flipOnce(); },
    read: (event) => readAt(placeAt(...shareOf(event, canvas))),
  });
  canvas.addEventListener("pointerdown", () => byId("stage").focus({ preventScroll: true }));
  followWheel(canvas, byId("stage"), drawSoon);
  const frame = element("div", { class: "frame" }, canvas);
  if (shown.mode === "slider" && slots.length > 1) frame.append(makeHandle(frame));
  return element("figure", { class: "pane" }, frame, element("figcaption"));
}

/** The line between two pictures: dragged, or moved by the arrow keys. */
function makeHandle(frame) {
  const handle = element("div", { class: "handle", tabindex: "0", role: "slider", "aria-label": "Where A ends and B begins", "aria-valuemin": "0", "aria-valuemax": "100" });
  const move = (share) => {
    shown.split = Math.min(1, Math.max(0, share));
    drawSoon();
  };
  handle.addEventListener("pointerdown", (event) => handle.setPointerCapture(event.pointerId));
  handle.addEventListener("pointermove", (event) => {
    if (handle.hasPointerCapture(event.pointerId)) move(shareOf(event, frame)[0]);
  });
  handle.addEventListener("keydown", (event) => {
    const to = { ArrowLeft: shown.split - 0.02, ArrowRight: shown.split + 0.02, Home: 0, End: 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    move(to);
  });
  return handle;
}

/** Draws with the next frame, however often it is asked. */
function drawSoon() {
  if (drawnSoon) return;
  drawnSoon = true;
  requestAnimationFrame(() => {
    drawnSoon = false;
    drawViewer();
  });
}

function drawViewer() {
  if (shown.slots.length === 0) return;
  const panes = panesOfMode();
  [...byId("stage").children].forEach((figure, at) => {
    const canvas = figure.querySelector("canvas");
    const image = data.images[shown.slots[panes[at][0]]];
    figure.style.setProperty("--shape", image.width / image.height);
    canvas.classList.toggle("near", view.zoom > 1);
    drawPane(canvas, panes[at]);
    figure.querySelector("figcaption").textContent = paneTitle(panes[at]);
    placeHandle(figure.querySelector(".handle"));
  });
  byId("exposure").value = shown.exposure;
  byId("exposure-value").textContent = `${shown.exposure > 0 ? "+" : ""}${withMinus(String(shown.exposure))} stops`;
  byId("zoom-value").textContent = `${number(view.zoom, 2)}×`;
  fillScales(byId("scales"));
  fillReadout(byId("readout"));
}

function placeHandle(handle) {
  if (!handle) return;
  handle.style.left = `${shown.split * 100}%`;
  handle.setAttribute("aria-valuenow", Math.round(shown.split * 100));
}

function readAt(place) {
  const inside = (share) => Math.min(1 - 1e-9, Math.max(0, share));
  view.probe = place.map(inside);
  drawSoon();
}

function flipOnce() {
  shown.flip = (shown.flip + 1) % shown.slots.length;
  drawSoon();
}

/** Starts or ends the flipping by itself. */
function playFlip(on) {
  clearInterval(flipTimer);
  flipTimer = on ? setInterval(flipOnce, Number(byId("flip-every").value)) : null;
  byId("flip-play").textContent = on ? "Pause" : "Play";
  byId("flip-play").setAttribute("aria-pressed", String(on));
}

function expose(stops) {
  shown.exposure = Math.min(10, Math.max(-10, stops));
  drawSoon();
}

/** Moves the pixel that is read by whole pixels. */
function stepProbe(dx, dy) {
  const image = data.images[shown.slots[0]];
  const [x, y] = view.probe ? pixelAt(image) : [Math.floor(view.x * image.width), Math.floor(view.y * image.height)];
  readAt([(x + dx + 0.5) / image.width, (y + dy + 0.5) / image.height]);
}

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** The keys of the stage; true where the key meant something. */
function pressKey(event) {
  const arrow = ARROWS[event.key];
  if (arrow && event.shiftKey) stepProbe(...arrow);
  else if (arrow && view.zoom > 1) panBy(-0.1 * arrow[0], -0.1 * arrow[1]);
  else if (event.key === "+" || event.key === "=") zoomAt(0.5, 0.5, 1.25);
  else if (event.key === "-" || event.key === "−") zoomAt(0.5, 0.5, 0.8);
  else if (event.key === "0") fit();
  else if (event.key === "[" || event.key === "]") expose(shown.exposure + (event.key === "]" ? 0.25 : -0.25));
  else if (event.key === " " && shown.mode === "flip") flipOnce();
  else return false;
  return true;
}

function fit() {
  Object.assign(view, { zoom: 1, x: 0.5, y: 0.5 });
}

/** The reference of the group or run that a picture of light belongs to. */
function ownReference(index) {
  const run = data.runs.find((each) => each.image === index);
  const group = run ? data.groups[run.group] : data.groups.find((each) => each.mean_image === index);
  return (group && referenceOf(group)?.image) ?? null;
}

/** Puts a picture into the last slot and goes to the viewer. Where the first one shows a reference, it shows
 * the picture's own: nothing else is worth a difference. */
function viewPicture(index) {
  const at = shown.slots.length - 1;
  if (shown.slots.length < 2) shown.slots.push(index);
  else shown.slots[at] = index;
  const own = ownReference(index);
  if (own !== null && data.references.some((reference) => reference.image === shown.slots[0])) shown.slots[0] = own;
  arrange();
  byId("pictures").scrollIntoView();
  byId("stage").focus({ preventScroll: true });
}

/** The first pictures: the first group's reference and its mean, or what there is. */
function firstSlots() {
  const [first] = data.groups;
  const wanted = [first && referenceOf(first)?.image, ...data.groups.map((group) => group.mean_image), ...data.runs.map((run) => run.image)];
  return [...new Set(wanted.filter((index) => index !== null && index !== undefined))].slice(0, 2);
}

function listenToViewer() {
  const zoomed = (act) => () => { act(); drawSoon(); };
  const on = (id, event, act) => byId(id).addEventListener(event, act);
  on("modes", "change", (event) => { shown.mode = event.target.value; arrange(); });
  on("add-picture", "click", () => { shown.slots.push(shown.slots.at(-1)); arrange(); });
  on("swap-pictures", "click", () => { shown.slots.splice(0, 2, shown.slots[1], shown.slots[0]); arrange(); });
  on("flip-play", "click", () => playFlip(flipTimer === null));
  on("flip-every", "change", () => { if (flipTimer !== null) playFlip(true); });
  on("exposure", "input", (event) => expose(Number(event.target.value)));
  on("exposure-reset", "click", () => expose(0));
  on("zoom-in", "click", zoomed(() => zoomAt(0.5, 0.5, 1.5)));
  on("zoom-out", "click", zoomed(() => zoomAt(0.5, 0.5, 1 / 1.5)));
  on("zoom-fit", "click", zoomed(fit));
  on("stage", "keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !pressKey(event)) return;
    event.preventDefault();
    drawSoon();
  });
}

function fillViewer() {
  shown.slots = firstSlots();
  if (shown.slots.length === 0) {
    byId("pictures").hidden = true;
    return;
  }
  listenToViewer();
  arrange();
  drawToWidth(byId("stage"), drawSoon);
  onChange(drawSoon);
}
