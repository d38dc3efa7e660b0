// Tables that sort, filter, choose their columns and copy as CSV.
//
// A column: key, title, help, value(row) to sort by, cell(row) to show, csv(row) as a list under
// heads, shown at first or not, numeric or not, look as a class.

/** Longer tables scroll by themselves, so that their heads stay in sight. */
const MANY_ROWS = 40;

/** Browsers take long to lay out more than this. */
const MOST_ROWS = 2000;

/** A table in a host; returns a function that fills it. */
function makeTable(host, { name, columns, rows }) {
  const table = {
    name,
    rows,
    columns: columns.filter((column) => !column.absent?.()).map((column) => ({ ...column, visible: column.shown !== false })),
    sort: { key: null, down: false },
    words: [],
  };
  table.body = element("tbody");
  table.head = element("tr");
  table.tally = element("span", { class: "tally" });
  const scroll = element("div", { class: rows().length > MANY_ROWS ? "scroll long" : "scroll", tabindex: "0", role: "region", "aria-label": `Table of ${name}` },
    element("table", {}, element("thead", {}, table.head), table.body));
  host.replaceChildren(tableTools(table), scroll);
  return () => { fillHead(table); fillBody(table); };
}

/** The controls above a table. */
function tableTools(table) {
  const search = element("input", { type: "search", placeholder: "all words", input: () => {
    table.words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    fillBody(table);
  } });
  const boxes = table.columns.map((column, at) => columnSwitch(table, column, at === 0));
  const copy = button("Copy as CSV", () => copyText(csvOf(table), copy), { class: "copy-csv" });
  return element("div", { class: "tools" },
    element("label", {}, `Filter ${table.name} `, search), table.tally,
    element("details", { class: "columns" }, element("summary", {}, "Columns"), element("div", { class: "menu" }, ...boxes)),
    copy);
}

function columnSwitch(table, column, fixed) {
  const box = element("input", { type: "checkbox", checked: column.visible, disabled: fixed, change: () => {
    column.visible = box.checked;
    fillHead(table);
    fillBody(table);
  } });
  return element("label", {}, box, ` ${column.title}`);
}

function visibleColumns(table) {
  return table.columns.filter((column) => column.visible);
}

/** The class of a column's cells. */
function lookOf(column) {
  return column.numeric ? "numeric" : column.look;
}

/** Column heads: buttons that sort up, then down, then not at all. */
function fillHead(table) {
  const cells = visibleColumns(table).map((column) => {
    const { key, down } = table.sort;
    const order = key !== column.key ? "none" : down ? "descending" : "ascending";
    const attributes = { scope: "col", "aria-sort": column.value ? order : null, class: lookOf(column), title: column.help };
    if (!column.value) return element("th", attributes, column.title);
    return element("th", attributes, button(column.title, () => sortBy(table, column.key), { "data-key": column.key }));
  });
  table.head.replaceChildren(...cells);
}

function sortBy(table, key) {
  const { sort } = table;
  if (sort.key !== key) table.sort = { key, down: false };
  else table.sort = sort.down ? { key: null, down: false } : { key, down: true };
  fillHead(table);
  fillBody(table);
  table.head.querySelector(`[data-key="${CSS.escape(key)}"]`).focus();
}

/** Orders numbers as numbers and text as text with its numbers; what is missing comes last. */
function compare(one, other) {
  if (typeof one === "number" && typeof other === "number") return one - other;
  return String(one).localeCompare(String(other), "en", { numeric: true });
}

/** The rows that pass the filters, in the chosen order. */
function shownRows(table) {
  const all = table.columns.filter((column) => column.csv);
  const rows = table.rows().filter((row) => {
    if (table.words.length === 0) return true;
    const text = all.flatMap((column) => column.csv(row)).join(" ").toLowerCase();
    return table.words.every((word) => text.includes(word));
  });
  const column = table.columns.find((each) => each.key === table.sort.key);
  if (!column) return rows;
  const direction = table.sort.down ? -1 : 1;
  return rows.map((row) => [column.value(row), row]).sort(([one], [other]) => {
    if (isMissing(one) || isMissing(other)) return isMissing(one) - isMissing(other);
    return direction * compare(one, other);
  }).map(([, row]) => row);
}

function fillBody(table) {
  const rows = shownRows(table);
  const columns = visibleColumns(table);
  table.tally.textContent = `${count(rows.length)} of ${count(table.rows().length)}`;
  table.body.replaceChildren(...rows.slice(0, MOST_ROWS).map((row) => element("tr", {}, ...columns.map((column, at) => {
    const tag = at === 0 ? "th" : "td";
    return element(tag, { scope: at === 0 ? "row" : null, class: lookOf(column) }, column.cell(row));
  }))));
  if (rows.length === 0) table.body.append(wideRow(columns, "Nothing passes the filters."));
  if (rows.length > MOST_ROWS) table.body.append(wideRow(columns, `${count(rows.length - MOST_ROWS)} more: filter to see them; the CSV has all.`));
}

function wideRow(columns, text) {
  return element("tr", {}, element("td", { colspan: columns.length, class: "none" }, text));
}

/** The rows that pass the filters, in the columns that are shown, as RFC 4180 has it. */
function csvOf(table) {
  const columns = visibleColumns(table).filter((column) => column.csv);
  const quoted = (value) => {
    const text = isMissing(value) ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const lines = [columns.flatMap((column) => column.heads ?? [column.title]), ...shownRows(table).map((row) => columns.flatMap((column) => column.csv(row)))];
  return lines.map((line) => line.map(quoted).join(",")).join("\r\n") + "\r\n";
}

/** A column of plain text. */
function textColumn(key, title, value, more = {}) {
  return { key, title, value, cell: (row) => value(row) ?? NOTHING, csv: (row) => [value(row)], ...more };
}

/** A column of numbers, shown by `show`. */
function numberColumn(key, title, value, show, more = {}) {
  return { key, title, value, numeric: true, cell: (row) => show(value(row)), csv: (row) => [value(row)], ...more };
}

/** A column of numbers with intervals; absent where nothing has one. */
function intervalColumn(key, title, interval, more = {}, unit = PLAIN) {
  return {
    key, title, numeric: true,
    value: (row) => interval(row)?.value ?? null,
    cell: (row) => intervalCell(interval(row), unit),
    heads: [title, `${title} low`, `${title} high`],
    csv: (row) => [interval(row)?.value, interval(row)?.low, interval(row)?.high],
    ...more,
  };
}

/** A column for each axis that some row has. */
function axisColumns(items, shown) {
  return data.axes.filter(({ path }) => items.some((item) => path in item.values)).map(({ path }) => {
    const isNumber = (item) => typeof item.values[path] === "number";
    const value = (item) => (isNumber(item) ? item.values[path] : path in item.values ? valueText(item.values[path]) : null);
    const numeric = items.every((item) => isNumber(item) || !(path in item.values));
    return textColumn(`axis ${path}`, leaf(path), value, { heads: [path], help: path, shown, numeric });
  });
}
