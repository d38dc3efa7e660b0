// What a page of figures can do beyond being read: its theme, and commands that can be copied.

const make = (tag, words = "", more = {}) => Object.assign(document.createElement(tag), { textContent: words, ...more });

const theme = make("select");
for (const name of ["system", "light", "dark"]) theme.append(make("option", name, { value: name === "system" ? "" : name }));
theme.addEventListener("change", () => {
  if (theme.value) document.documentElement.dataset.theme = theme.value;
  else delete document.documentElement.dataset.theme;
});
const label = make("label", "Theme ");
label.append(theme);
document.querySelector(".kicker").append(label);

for (const command of document.querySelectorAll(".command")) {
  const button = make("button", "Copy", { type: "button" });
  button.addEventListener("click", async () => {
    // Pages from a disk may not use the clipboard everywhere: then the text is selected.
    try {
      await navigator.clipboard.writeText(command.querySelector("code").textContent);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(command.querySelector("code"));
      button.textContent = "Selected";
    }
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
  command.append(button);
}
