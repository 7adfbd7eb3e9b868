// Bars of where the error of the selected pose comes from: by source, and the single parameters that matter most.
import { copyable } from "../shared/copy_table.js";
import { append, html, muted, table } from "../shared/dom.js";
import { MISSING, capitalized, isNumber, sentence } from "../shared/format.js";
import { number } from "../shared/numbers.js";
import { parameterTitle } from "../shared/parameter_names.js";
import { SIZES, unitsOf } from "./units.js";

const CONTRIBUTIONS_SHOWN = 12;
const COLORS = ["var(--first)", "var(--second)", "var(--third)", "var(--fourth)"];

export function renderSources(section, { data, pose }) {
  const sources = (pose.sources ?? []).map((source, index) => ({
    ...source,
    label: source.label ?? source.name ?? `source ${index + 1}`,
    path: `sources.${index}`,
    color: COLORS[index % COLORS.length],
  }));
  if (sources.length === 0) return append(section, muted("No errors are known at this pose."));
  const units = unitsOf(data.document);
  const sideBySide = (draw) => html("div", { class: "pair" }, SIZES.map(draw));
  append(
    section,
    sideBySide((size) => bySource(size, units[size.kind], sources, pose.together)),
    sources
      .filter(({ message }) => message)
      .map(({ label, message }) => muted(`${capitalized(label)}: ${message}`)),
    muted(
      "Bars: pale up to the bound, and within it full up to what the error stays below in 19 of 20 cases.",
    ),
    largestContributions(sources).length > 0 && [
      html("h3", null, "Single parameters that matter most"),
      data.document.conventions?.contributions && muted(sentence(data.document.conventions.contributions)),
    ],
    sideBySide((size) => byParameter(size, units[size.kind], sources)),
  );
}

function bySource({ key, label }, unit, sources, together) {
  const rows = [
    ...sources,
    ...(together ? [{ ...together, label: "together", path: "together", color: "var(--muted)" }] : []),
  ];
  const full = Math.max(0, ...rows.map(({ bound }) => bound?.[key] ?? 0));
  const columns = [
    { label: "Source", text: true, cell: (row) => row.label },
    { label: "", cell: (row) => bar(row.bound?.[key], row.value_95?.[key], full, row.color) },
    { label: "Bound", unit, cell: (row) => number(row.bound?.[key], `${row.path}.bound.${key}`) },
    { label: "95 %", unit, cell: (row) => number(row.value_95?.[key], `${row.path}.value_95.${key}`) },
  ];
  return copyable(table(`${label} error by source`, columns, [{ rows }]));
}

function byParameter({ key, label }, unit, sources) {
  const rows = largestContributions(sources, key);
  if (rows.length === 0) return null;
  const full = Math.abs(rows[0][key]);
  const columns = [
    { label: "Parameter", text: true, cell: ({ name }) => parameterTitle(name ?? MISSING) },
    { label: "", cell: (row) => bar(Math.abs(row[key]), null, full, row.color) },
    { label: "Share", unit, cell: (row) => number(row[key], `${row.path}.${key}`) },
  ];
  return copyable(table(`${label} error by parameter, the largest ${rows.length}`, columns, [{ rows }]));
}

// The contributions of all sources, the largest first, which may be negative (correlations can cancel): [{name, position, rotation, color, path}].
export function largestContributions(sources, key = "position", count = CONTRIBUTIONS_SHOWN) {
  return sources
    .flatMap(({ contributions, color, path }) =>
      (contributions ?? []).map((each, index) => ({
        ...each,
        color,
        path: `${path}.contributions.${index}`,
      })),
    )
    .filter((each) => isNumber(each[key]))
    .sort((a, b) => Math.abs(b[key]) - Math.abs(a[key]))
    .slice(0, count);
}

// A bar as long as the cell at `full`, with a darker one inside it.
function bar(value, inner, full, color) {
  if (!isNumber(value) || !(full > 0)) return "";
  const width = (part) => `width:${(100 * Math.min(1, Math.max(0, part / full))).toFixed(2)}%`;
  return html(
    "span",
    { class: "source-bar", style: `--color:${color}`, "aria-hidden": "true" },
    html("span", { class: isNumber(inner) ? "bound" : "only", style: width(value) }),
    isNumber(inner) && html("span", { class: "likely", style: width(inner) }),
  );
}
