// Numbers as elements that keep all their digits, for the copy button and for tests.
import { barCell, html } from "./dom.js";
import { MISSING, afterNumber, isNumber, significant } from "./format.js";

// path: where in the selected pose the number stands, such as "max_error.position"; with a leading "document." where
// in the document.
export const number = (value, path = null, text = significant(value)) =>
  html("data", { value: isNumber(value) ? String(value) : null, "data-value": path }, text);

// A number and a bar beside it, as long as the cell at `full`; the number stays in its place where there is none.
export const barred = (value, full, path) => [
  number(value, path),
  " ",
  barCell(value, full) || html("span", { class: "bar empty" }),
];

export const withUnit = (element, unit) =>
  unit && element !== MISSING && element.textContent !== MISSING
    ? html("span", null, element, html("span", { class: "unit" }, afterNumber(unit)))
    : element;

// A number of a document in a unit, to which `scale` takes it from SI; path: where in the document it stands.
export const measured = (value, unit, path, text = null) =>
  withUnit(measuredNumber(value, unit, path, text), unit.unit);

// The same where the unit stands elsewhere.
export function measuredNumber(value, { unit, scale }, path, text = null) {
  if (!isNumber(value)) return MISSING;
  const shown = Number((scale * value).toPrecision(12));
  const attributes = { value: String(shown), "data-value": path, "data-unit": unit };
  return html("data", attributes, text ?? significant(shown));
}

// {value, half_width} -> "0.0512 ± 0.0003"; the half width with two digits.
export function estimate(found) {
  if (!isNumber(found?.value)) return MISSING;
  const width = found.half_width;
  if (!isNumber(width)) return number(found.value);
  return html(
    "span",
    { class: "estimate" },
    number(found.value),
    html("span", { class: "muted" }, " ± ", html("data", { value: String(width) }, significant(width, 2))),
  );
}
