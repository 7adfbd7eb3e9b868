// The table of the largest errors: coordinate by coordinate, and by source.
import { copyable } from "../shared/copy_table.js";
import { append, html, muted, table } from "../shared/dom.js";
import { isNumber } from "../shared/format.js";
import { barred, number } from "../shared/numbers.js";
import { ERRORS, unitsOf } from "./units.js";

export function renderErrors(section, { data, pose }) {
  append(
    section,
    explanation(data.document.conventions ?? {}),
    copyable(
      table(`Largest errors at ${pose.name ?? "this pose"}`, columnsOf(data.document, pose), groups()),
    ),
  );
}

// As the document has it, for it knows how each source was taken.
function explanation({ bound, value_95: likely }) {
  const most = bound ?? "the most that errors within their bounds can add up to";
  const usual = likely ?? "what the error stays below in 19 of 20 cases when they are random";
  return [
    muted(html("strong", null, "Bound"), `: ${most}.`),
    muted(html("strong", null, "95 %"), `: ${usual}.`),
  ];
}

function groups() {
  return [
    { label: "Coordinates, one by one", rows: ERRORS.slice(0, 6) },
    { label: "Together", rows: ERRORS.slice(6) },
  ];
}

function columnsOf(document, pose) {
  const units = unitsOf(document);
  const largest = (kind) => Math.max(0, ...ERRORS.filter((error) => error.kind === kind).map(valueOf(pose)));
  const errorCell = ({ key, kind }) => barred(pose.max_error?.[key], largest(kind), `max_error.${key}`);
  return [
    { label: "Error of", text: true, cell: ({ label }) => label },
    { label: "Unit", text: true, cell: ({ kind }) => units[kind] },
    { label: "joint readings, bound", cell: errorCell },
    ...(pose.sources ?? []).flatMap((source, index) => sourceColumns(source, index, pose.max_error)),
    ...(pose.together ? pair("all together", pose.together, "together") : []),
  ];
}

const valueOf =
  (pose) =>
  ({ key }) =>
    isNumber(pose.max_error?.[key]) ? pose.max_error[key] : 0;

// A source whose bound is max_error itself, the joint readings, is not shown twice.
function sourceColumns(source, index, shown) {
  const columns = pair(source.label ?? source.name ?? `Source ${index + 1}`, source, `sources.${index}`);
  const same = ERRORS.every(({ key }) => source.bound?.[key] === shown?.[key]);
  return same ? columns.slice(1) : columns;
}

const pair = (label, { bound, value_95: likely }, path) => [
  { label: `${label}, bound`, cell: ({ key }) => number(bound?.[key], `${path}.bound.${key}`) },
  { label: `${label}, 95 %`, cell: ({ key }) => number(likely?.[key], `${path}.value_95.${key}`) },
];
