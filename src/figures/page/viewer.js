// One picture, as large as the window lets it be in whole multiples. Its neighbours in the sheet
// come to the very same place, so that the eye sees nothing but what differs.

const viewer = make("dialog", "", { id: "viewer" });
const words = make("p");
const large = make("img");
const stage = make("div", "", { className: "stage" });
const moves = make("footer");
let grid = [];
let at = [0, 0];

/** The picture that is so many rows and columns away, around the edges. */
function neighbour(down, right) {
  const row = (at[0] + down + grid.length) % grid.length;
  const column = (at[1] + right + grid[row].length) % grid[row].length;
  return [row, column];
}

function show(place) {
  at = place;
  const picture = grid[at[0]][at[1]];
  const note = picture.parentElement.querySelector("small")?.textContent ?? "";
  words.replaceChildren(picture.alt, make("small", note));
  large.src = picture.src;
  large.alt = picture.alt;
  const { width, height } = { width: picture.naturalWidth, height: picture.naturalHeight };
  const room = Math.min((innerWidth - 24) / width, (innerHeight - 130) / height);
  const times = room >= 1 ? Math.floor(room) : room;
  large.style.width = `${width * times}px`;
}

function open(picture) {
  const cells = [...picture.closest(".cells").querySelectorAll(".row-name")];
  grid = cells.map((name) => {
    const row = [];
    for (let next = name.nextElementSibling; next && !next.matches(".row-name"); next = next.nextElementSibling) {
      if (next.matches(".cell")) row.push(next.querySelector("img"));
    }
    return row;
  }).filter((row) => row.length > 0);
  const row = grid.findIndex((pictures) => pictures.includes(picture));
  for (const button of moves.children) button.hidden = button.down ? grid.length < 2 : grid[row].length < 2;
  show([row, grid[row].indexOf(picture)]);
  viewer.showModal();
}

for (const [sign, name, key, down, right] of [["←", "Left", "ArrowLeft", 0, -1], ["→", "Right", "ArrowRight", 0, 1], ["↑", "Up", "ArrowUp", -1, 0], ["↓", "Down", "ArrowDown", 1, 0]]) {
  const button = make("button", sign, { type: "button", title: `${name} (arrow key)`, ariaLabel: `${name} picture`, down });
  button.addEventListener("click", () => show(neighbour(down, right)));
  viewer.addEventListener("keydown", (event) => {
    if (event.key !== key) return;
    event.preventDefault();
    show(neighbour(down, right));
  });
  moves.append(button, " ");
}

const bar = make("header");
const close = make("button", "Close", { type: "button" });
close.addEventListener("click", () => viewer.close());
large.addEventListener("click", () => show(grid.length > 1 ? neighbour(1, 0) : neighbour(0, 1)));
bar.append(words, close);
stage.append(large);
viewer.append(bar, stage, moves);
document.body.append(viewer);
addEventListener("resize", () => { if (viewer.open) show(at); });

document.querySelector(".pictures figcaption")?.append(" Press a picture to see it large; the arrow keys flip to its neighbours in the very same place.");

for (const picture of document.querySelectorAll(".cell img")) {
  Object.assign(picture, { tabIndex: 0, role: "button", title: "Look at it large; arrow keys flip to its neighbours" });
  picture.addEventListener("click", () => open(picture));
  picture.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    open(picture);
  });
}
