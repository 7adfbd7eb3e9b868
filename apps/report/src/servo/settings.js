// With what the servo was run, and its result in numbers.
import { copyable } from "../shared/copy_table.js";
import { append, html, table } from "../shared/dom.js";
import { MISSING, capitalized, isNumber } from "../shared/format.js";
import { figureOf } from "./quantities.js";

export function renderSettings(section, { data }) {
  const settings = Object.entries(data.settings ?? {}).map(([name, value]) => [spaced(name), inText(value)]);
  append(
    section,
    html(
      "div",
      { class: "tables" },
      html(
        "div",
        null,
        settings.length > 0 && words("Settings", settings),
        words("Provenance", provenance(data)),
      ),
      data.document && words("The result", resultRows(data.document)),
    ),
  );
}

const spaced = (name) => capitalized(name.replaceAll("_", " "));

const words = (caption, rows) =>
  copyable(
    table(
      caption,
      [
        { label: "Name", text: true, cell: ([name]) => name },
        { label: "Value", text: true, cell: ([, value]) => value },
      ],
      [{ rows }],
    ),
  );

const provenance = (data) => [
  ["Program", data.program_version ? `legible ${data.program_version}` : MISSING],
  ["Model", data.model ?? MISSING],
  ["Rig", data.rig ?? MISSING],
  ["Log", data.log ?? MISSING],
  ["Robot", data.title ?? MISSING],
];

function inText(value) {
  if (value === null || value === undefined || value === "") return MISSING;
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return value.length ? value.map(inText).join(", ") : "none";
  if (typeof value === "object")
    return Object.entries(value)
      .map(([name, part]) => `${spaced(name)}: ${inText(part)}`)
      .join("; ");
  return String(value);
}

// Whatever the document holds, a row each, under the name that it has there: [[name, text or element]].
function resultRows(document) {
  return leavesOf(document).map(([path, value]) => [
    path,
    isNumber(value) ? figureOf(document, path) : inText(value),
  ]);
}

// [[path, value]] of all members that hold no others; a list is one.
export function leavesOf(value, path = "") {
  const isBranch = value && typeof value === "object" && !Array.isArray(value);
  if (!isBranch) return [[path, value]];
  return Object.entries(value).flatMap(([name, part]) => leavesOf(part, path ? `${path}.${name}` : name));
}
