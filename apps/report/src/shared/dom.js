// Small makers of page elements. Every text goes in as a text node, so nothing in the data can become markup.
import { isNumber } from "./format.js";

// Appends what there is: null, undefined and false stand for nothing.
export function append(element, ...children) {
  element.append(
    ...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false),
  );
  return element;
}

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  return append(element, ...children);
}

export const html = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);

export const svg = (tag, attributes, ...children) =>
  fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

// A box to tick for `name` in `shown`; changed(): to draw again.
export function checkbox(shown, name, label, changed) {
  const box = html("input", {
    type: "checkbox",
    name,
    checked: shown[name],
    onchange: () => {
      shown[name] = box.checked;
      changed();
    },
  });
  return html("label", null, box, ` ${label}`);
}

export const paragraph = (...children) => html("p", null, ...children);
export const muted = (...children) => html("p", { class: "muted" }, ...children);

// columns: [{label, unit?, cell(row) -> node or text, text?: true for left-aligned}]
// groups: [{label?, rows}]
export function table(caption, columns, groups) {
  const head = columns.map(({ label, unit, text }) =>
    html(
      "th",
      { scope: "col", class: text ? "text" : null },
      label,
      unit && html("span", { class: "unit" }, ` ${unit}`),
    ),
  );
  return html(
    "div",
    { class: "scroll" },
    html(
      "table",
      null,
      html("caption", null, caption),
      html("thead", null, html("tr", null, head)),
      groups.map((group) => tableGroup(columns, group)),
    ),
  );
}

function tableGroup(columns, { label, rows }) {
  const heading =
    label &&
    html("tr", { class: "group" }, html("th", { scope: "rowgroup", colspan: columns.length }, label));
  return html(
    "tbody",
    null,
    heading,
    rows.map((row) => tableRow(columns, row)),
  );
}

function tableRow(columns, row) {
  const cells = columns.map(({ cell, text }, index) =>
    index === 0
      ? html("th", { scope: "row", class: text ? "text" : null }, cell(row))
      : html("td", { class: text ? "text" : null }, cell(row)),
  );
  return html("tr", null, cells);
}

export const figure = (caption, ...children) =>
  html("figure", null, children, caption && html("figcaption", null, caption));

// entries: [[term, value, note?]]
export const definitions = (entries, className) =>
  html(
    "dl",
    { class: className },
    entries.map(([term, value, note]) =>
      html("div", null, html("dt", null, term), html("dd", null, value, note && html("small", null, note))),
    ),
  );

// A bar from the middle (signed) or from the left of a table cell, as long as the half or whole cell at `full`.
export function barCell(value, full, { signed = false, alarming = false } = {}) {
  if (!isNumber(value) || !(full > 0)) return "";
  const share = Math.min(1, Math.abs(value) / full) * (signed ? 50 : 100);
  const left = signed ? (value < 0 ? 50 - share : 50) : 0;
  const style = `left:${left.toFixed(2)}%;width:${share.toFixed(2)}%`;
  return html(
    "span",
    { class: `bar${signed ? " signed" : ""}${alarming ? " alarming" : ""}`, "aria-hidden": "true" },
    html("span", { style }),
  );
}
