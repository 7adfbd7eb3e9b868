// With what the servo was run, and its result in numbers.
import { copyable } from "../shared/copy_table.js";
import { leavesOf } from "../shared/document.js";
import { append, html, table } from "../shared/dom.js";
import { MISSING, capitalized, isNumber } from "../shared/format.js";
import { inText, spaced } from "../shared/option_words.js";
import { figureOf } from "./quantities.js";

export function renderSettings(section, { data }) {
  const settings = Object.entries(data.settings ?? {}).map(([name, value]) => [
    capitalized(spaced(name)),
    inText(value),
  ]);
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

// Whatever the document holds, a row each, under the name that it has there: [[name, text or element]].
function resultRows(document) {
  return leavesOf(document).map(([path, value]) => [
    path,
    isNumber(value) ? figureOf(document, path) : inText(value),
  ]);
}
