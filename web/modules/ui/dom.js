// Elements from plain calls: h("p", {class: "soft"}, "text", child). Text is always text, never markup.

export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) set(element, name, value);
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

function set(element, name, value) {
  if (value === false || value === null || value === undefined) return;
  if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
  else if (name in element && typeof value !== "string") element[name] = value;
  else element.setAttribute(name, value === true ? "" : value);
}

export function panel(title, ...children) {
  return h("section", { class: "panel", role: "group", "aria-label": title }, h("h2", {}, title), ...children);
}

export function replace(parent, ...children) {
  parent.replaceChildren(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return parent;
}

// columns: {title, unseen, number, cell}; a title is text or an element. On a narrow screen each row becomes a card, and
// each cell says its title
export function table(caption, columns, rows) {
  const head = h("tr", {}, columns.map((column) => h("th", { scope: "col", class: column.number ? "number" : "" }, column.title || h("span", { class: "unseen" }, column.unseen ?? "Actions"))));
  const words = columns.map(({ title, unseen }) => (title instanceof Element ? title.textContent.replace(/ [▴▾]$/, "") : title || unseen || ""));
  const body = rows.map((row) =>
    h("tr", { class: row.chosen ? "chosen" : "" }, columns.map((column, at) => h("td", { class: column.number ? "number" : "", "data-title": words[at] }, column.cell(row) ?? ""))));
  return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    h("table", { class: "cards-if-narrow" }, h("thead", {}, head), h("tbody", {}, body)));
}

export function facts(entries) {
  return h("dl", { class: "facts" }, entries.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value ?? "–")]));
}
