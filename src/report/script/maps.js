// Maps: one picture of every group, all on one scale.

const MAP_KINDS = [
  { key: "bias_image", title: "bias", legend: "Bias, mean of the channels", caption: (found) => found.bias && intervalText(found.bias, SIGNED_PERCENT) },
  { key: "deviation_image", title: "standard deviation", legend: "Standard deviation of one sample, mean of the channels", caption: (found) => found.variance && `variance ${intervalText(found.variance)}` },
  { key: "mean_image", title: "mean", legend: "", caption: (found) => found.mean && `mean ${intervalText(found.mean)}` },
];

function hasImage(group, kind) {
  return group[kind.key] !== null && group[kind.key] !== undefined;
}

/** Pixels of the screen that a pixel of a map takes, so that a region's line is thin on it. */
function enlargement(image) {
  return Math.max(1, Math.ceil(320 / image.width));
}

/** A map still without paint, and what was found in the chosen region; pressing it shows it in the viewer. */
function mapFigure(group, kind) {
  const index = group[kind.key];
  const image = data.images[index];
  const times = enlargement(image);
  const canvas = element("canvas", { width: image.width * times, height: image.height * times });
  const open = button("", () => viewPicture(index), { "aria-label": `View ${image.name}`, class: "map" });
  open.append(canvas);
  const found = kind.caption(result(group, chosen.region));
  return element("figure", {}, open, element("figcaption", {}, group.name, found ? element("small", {}, found) : null));
}

function paintMap(canvas, index, range) {
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(paintedImage(index, 0, range), 0, 0, canvas.width, canvas.height);
  drawRegion(context, 0, 0, canvas.width);
}

/** The maps of a kind; before they are near they take their place without paint, so nothing moves later. */
function drawMaps(kind, near) {
  const groups = keptGroups().filter((group) => hasImage(group, kind));
  const indices = groups.map((group) => group[kind.key]);
  const scale = indices.length > 0 ? scaleOf(data.images[indices[0]].kind) : undefined;
  const range = scale && near ? sharedRange(indices) : NaN;
  const figures = groups.map((group) => mapFigure(group, kind));
  if (near) figures.forEach((figure, at) => paintMap(figure.querySelector("canvas"), indices[at], range));
  byId("map-grid").replaceChildren(...figures);
  const all = keptGroups().length;
  byId("map-tally").textContent = groups.length < all ? `${count(groups.length)} of ${amount(all, "group")} have this map here.` : "";
  byId("map-legend").replaceChildren(...(scale ? [colourLegend(scale, range, kind.legend)] : []));
}

/** The section; nothing is decoded before it comes near, or the page is printed. */
function fillMaps() {
  const offered = MAP_KINDS.filter((kind) => data.groups.some((group) => hasImage(group, kind)));
  if (offered.length === 0) {
    byId("maps").hidden = true;
    return;
  }
  let near = false;
  const draw = () => drawMaps(offered.find((kind) => kind.key === byId("map-kind").value), near);
  const come = () => {
    if (near) return;
    near = true;
    draw();
  };
  fillSelect(byId("map-kind"), offered.map((kind) => [kind.key, kind.title]));
  byId("map-kind").addEventListener("change", draw);
  onChange(draw);
  const observer = new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) come(); }, { rootMargin: "400px" });
  observer.observe(byId("maps"));
  addEventListener("beforeprint", come);
}
