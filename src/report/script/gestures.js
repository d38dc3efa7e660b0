// Pointer, wheel and pinch on pictures, as zoom and pan in shares of the picture.

const MOST_ZOOM = 64;
const FINGERS = 2;

/** What the pictures show: all of them the same part. */
const view = { zoom: 1, x: 0.5, y: 0.5, probe: null };

/** Keeps the part inside the picture. */
function holdInside() {
  view.zoom = Math.min(MOST_ZOOM, Math.max(1, view.zoom));
  const margin = 0.5 / view.zoom;
  view.x = Math.min(1 - margin, Math.max(margin, view.x));
  view.y = Math.min(1 - margin, Math.max(margin, view.y));
}

/** Zooms by a factor and keeps the place under (px, py), shares of the canvas, where it is. */
function zoomAt(px, py, factor) {
  const [u, v] = placeAt(px, py);
  view.zoom = Math.min(MOST_ZOOM, Math.max(1, view.zoom * factor));
  view.x = u - (px - 0.5) / view.zoom;
  view.y = v - (py - 0.5) / view.zoom;
  holdInside();
}

/** Moves the part by shares of the canvas. */
function panBy(dx, dy) {
  view.x -= dx / view.zoom;
  view.y -= dy / view.zoom;
  holdInside();
}

/** The place in the picture under a place on the canvas, both in shares. */
function placeAt(px, py) {
  return [(px - 0.5) / view.zoom + view.x, (py - 0.5) / view.zoom + view.y];
}

/** Where an event is on a canvas, in shares of it. */
function shareOf(event, canvas) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

/** Centre of the fingers and how far they are apart. */
function spreadOf(fingers) {
  const [one, other = one] = [...fingers.values()];
  return {
    clientX: (one.clientX + other.clientX) / 2,
    clientY: (one.clientY + other.clientY) / 2,
    apart: Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY),
  };
}

/** Drag and pinch: every move pans by the fingers' centre and zooms by their distance. */
function followFingers(canvas, { moved, pressed, read }) {
  const fingers = new Map();
  let travelled = 0;
  canvas.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
    if (fingers.size === 1) travelled = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return read(event);
    const before = spreadOf(fingers);
    fingers.set(event.pointerId, event);
    const after = spreadOf(fingers);
    const [from, to] = [shareOf(before, canvas), shareOf(after, canvas)];
    travelled += Math.hypot(after.clientX - before.clientX, after.clientY - before.clientY) + Math.abs(after.apart - before.apart);
    panBy(to[0] - from[0], to[1] - from[1]);
    if (fingers.size === FINGERS && before.apart > 0) zoomAt(to[0], to[1], after.apart / before.apart);
    read(event);
    moved();
  });
  const lift = (event) => {
    if (fingers.delete(event.pointerId) && event.type === "pointerup" && fingers.size === 0 && travelled < 4) pressed();
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
}

/** The wheel zooms once the pictures have the focus, or with Ctrl; else the page scrolls. */
function followWheel(canvas, stage, moved) {
  canvas.addEventListener("wheel", (event) => {
    const before = view.zoom;
    if (!event.ctrlKey && !stage.contains(document.activeElement)) return;
    zoomAt(...shareOf(event, canvas), 2 ** (-event.deltaY / (event.ctrlKey ? 100 : 300)));
    if (view.zoom === before && !event.ctrlKey) return;
    event.preventDefault();
    moved();
  }, { passive: false });
}
