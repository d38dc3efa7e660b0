// Small help with the document.

/** The element with this id. */
function byId(id) {
  return document.getElementById(id);
}

/** Sets attributes; functions are listeners, `true` is an attribute without value. */
function dress(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value);
  }
  return node;
}

/** A new element; strings among the children are text, never markup. */
function element(tag, attributes = {}, ...children) {
  const node = dress(document.createElement(tag), attributes);
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/** A button that is no part of a form. */
function button(text, press, attributes = {}) {
  return element("button", { type: "button", click: press, ...attributes }, text);
}

/** Fills a select with [value, text] pairs. */
function fillSelect(select, pairs, value) {
  select.replaceChildren(...pairs.map(([each, text]) => element("option", { value: each }, text)));
  if (value !== undefined) select.value = value;
  return select;
}

/** Tells those who hear the page. */
function say(text) {
  byId("said").textContent = text;
}

/** Copies through a hidden field, where the clipboard is closed to pages from disk. */
function copyByField(text) {
  const field = element("textarea", { class: "unseen", readonly: true });
  field.value = text;
  document.body.append(field);
  field.select();
  const done = document.execCommand("copy");
  field.remove();
  return done;
}

/** Copies text and says on the button whether it went well. */
async function copyText(text, from) {
  let done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    done = copyByField(text);
  }
  from.dataset.label ??= from.textContent;
  from.textContent = done ? "Copied" : "Not allowed here";
  say(from.textContent);
  setTimeout(() => { from.textContent = from.dataset.label; }, 1600);
}

/** What the page remembers, where the browser lets a page from disk remember. */
function remembered(key, value) {
  try {
    if (value !== undefined) localStorage.setItem(`lampray.${key}`, value);
    return localStorage.getItem(`lampray.${key}`);
  } catch {
    return null;
  }
}
