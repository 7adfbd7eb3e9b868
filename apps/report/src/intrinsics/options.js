// With what the camera was calibrated, how long that took, and everything that was found in numbers.
import { copyable } from "../shared/copy_table.js";
import { leavesOf } from "../shared/document.js";
import { append, definitions, html, table } from "../shared/dom.js";
import { MISSING, isNumber } from "../shared/format.js";
import { inText, spaced } from "../shared/option_words.js";
import { timeTable } from "../shared/timing.js";
import { figureOf } from "./quantities.js";

const STAGES = {
  read: "Read the images",
  detect: "Find the corners",
  solve: "Estimate",
  covariance: "Covariance",
  uncertainty: "Uncertainty over the image",
  halves: "Two halves",
  next_view: "The view to add next",
};

export function renderOptions(section, data) {
  const document = data.intrinsics ?? {};
  const options = Object.entries(data.options ?? {}).map(([name, value]) => [spaced(name), inText(value)]);
  const version = data.program_version ?? document.program_version;
  append(
    section,
    html("h3", null, "Provenance"),
    definitions(
      [
        ["Program", version ? `legible ${version}` : MISSING],
        ["Board", data.board ?? MISSING],
        ["Command line", document.options ?? MISSING],
        ["Content of the input", document.content_hash ?? MISSING],
      ],
      "list",
    ),
    html("h3", null, "Options"),
    options.length ? definitions(options, "list") : html("p", { class: "muted" }, "All default."),
    html("h3", null, "Time"),
    timing(document),
    Object.keys(document).length > 0 && everything(document),
  );
}

function timing(document) {
  const { time_s: time } = document;
  return isNumber(time)
    ? html("p", null, figureOf(document, "time_s"), " from the files to the result.")
    : timeTable(time ?? {}, STAGES);
}

// Whatever the document holds, a row each, under the name that it has there.
function everything(document) {
  const rows = leavesOf(document, { intoLists: true }).filter(([, value]) => typeof value !== "object");
  return html(
    "details",
    null,
    html("summary", null, "Everything that intrinsics.json holds"),
    copyable(
      table(
        "Elements of lists count from 0",
        [
          { label: "Name", text: true, cell: ([path]) => path },
          {
            label: "Value",
            text: true,
            cell: ([path, value]) => (isNumber(value) ? figureOf(document, path) : inText(value)),
          },
        ],
        [{ rows }],
      ),
    ),
  );
}
