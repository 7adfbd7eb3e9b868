// Statistics of errors and indices over the workspace, each with what it is certain to.
import * as Plot from "@observablehq/plot";
import { copyable } from "../shared/copy_table.js";
import { append, definitions, figure, html, muted, table } from "../shared/dom.js";
import {
  MISSING,
  isNumber,
  percent,
  plural,
  sentence,
  significant,
  tick,
  withUnit,
} from "../shared/format.js";
import { estimate, number } from "../shared/numbers.js";
import { COLOR, TIP, plot, responsive } from "../shared/plots.js";
import { pretty } from "./units.js";

const ROW_HEIGHT = 26;

export function renderWorkspace(section, { data }) {
  const { workspace } = data.document;
  const statistics = (workspace.statistics ?? []).map((each) => ({ ...each, unit: pretty(each.unit) }));
  append(
    section,
    workspace.over && html("p", null, `Over ${workspace.over}.`),
    (workspace.warnings ?? []).map((text) => html("p", { class: "notice" }, sentence(text))),
    definitions(keyFigures(workspace), "figures"),
    spreads(statistics.filter(hasQuantiles)),
    statistics.length > 0 && statisticsTable(statistics, workspace.certainty),
    boxTable(workspace.box, data.document.units),
  );
}

function keyFigures(workspace) {
  const { allowed_fraction: allowed, samples, replicates, rule } = workspace;
  const share = isNumber(allowed?.value) ? percent3(allowed.value) : MISSING;
  const width = isNumber(allowed?.half_width) ? ` ± ${percent(allowed.half_width)}` : "";
  return [
    ["Allowed part of the box", share + width, "of what was sampled; the rest is out of reach"],
    [
      "Global conditioning index",
      estimate(workspace.global_conditioning_index),
      "mean of 1 / condition number",
    ],
    ["Samples at or near a singularity", workspace.singular_samples ?? MISSING, "without errors"],
    [
      "Samples",
      samples ?? MISSING,
      [replicates && plural(replicates, "replicate"), rule].filter(Boolean).join(", "),
    ],
  ];
}

const percent3 = (share) => withUnit(significant(100 * share), "%");

// One drawing for each unit: quantiles of all that have it, on one axis.
function spreads(statistics) {
  if (statistics.length === 0) return null;
  const units = [...new Set(statistics.map(({ unit }) => unit))];
  return figure(
    "From the lowest to the highest quantile of the table, with the median where it is among them; diamonds are the " +
      "largest values seen. Point at a row for its numbers.",
    html(
      "div",
      { class: "plots spreads" },
      units.map((unit) => {
        const rows = statistics.filter((each) => each.unit === unit);
        return responsive((width) => spreadPlot(rows, unit, width));
      }),
    ),
  );
}

const hasQuantiles = ({ quantiles }) => quantiles?.some(({ value }) => isNumber(value));
const nameOf = ({ label, of }) => label ?? of;

function spreadPlot(rows, unit, width) {
  const margin = Math.min(190, Math.round(width * 0.42));
  const spread = rows.map((row) => {
    const values = row.quantiles.map(({ value }) => value).filter(isNumber);
    const median = row.quantiles.find(({ p }) => p === 0.5)?.value;
    return { name: nameOf(row), least: Math.min(...values), most: Math.max(...values), median, row };
  });
  const seen = rows.filter(({ largest_seen: value }) => isNumber(value));
  return plot(`Quantiles over the workspace, ${unit || "without unit"}`, {
    width,
    height: ROW_HEIGHT * rows.length + 62,
    marginLeft: margin,
    marginRight: 20,
    marginTop: 10,
    marginBottom: 40,
    x: {
      label: unit || "no unit",
      zero: true,
      nice: true,
      grid: true,
      labelArrow: false,
      ticks: 5,
      tickFormat: tick,
    },
    y: { label: null, domain: rows.map(nameOf), tickSize: 0, axis: null },
    marks: [
      Plot.axisY({ tickSize: 0, lineWidth: margin / 12, lineAnchor: "middle", label: null }),
      Plot.ruleY(spread, {
        y: "name",
        x1: "least",
        x2: "most",
        stroke: COLOR.first,
        strokeWidth: 7,
        strokeOpacity: 0.45,
      }),
      Plot.dot(
        spread.filter(({ median }) => isNumber(median)),
        { y: "name", x: "median", fill: COLOR.first, r: 4.5 },
      ),
      Plot.dot(seen, { y: nameOf, x: "largest_seen", stroke: COLOR.second, symbol: "diamond", r: 3.5 }),
      Plot.tip(spread, Plot.pointerY({ y: "name", x: "most", title: spreadTitle(unit), ...TIP })),
    ],
  });
}

const spreadTitle =
  (unit) =>
  ({ name, row }) =>
    [
      name,
      ...row.quantiles.map(({ p, value }) => `${tick(100 * p)} %: ${withUnit(significant(value), unit)}`),
    ].join("\n");

function statisticsTable(statistics, certainty) {
  const shares = [
    ...new Set(statistics.flatMap(({ quantiles }) => (quantiles ?? []).map(({ p }) => p))),
  ].sort((a, b) => a - b);
  const columns = [
    { label: "Of", text: true, cell: nameOf },
    { label: "Unit", text: true, cell: ({ unit }) => unit || "1" },
    { label: "Mean", cell: ({ mean }) => estimate(mean) },
    { label: "Variance", cell: ({ variance }) => estimate(variance) },
    ...shares.map((share) => ({
      label: share === 0.5 ? "Median" : `${tick(100 * share)} %`,
      cell: ({ quantiles }) => estimate(quantiles?.find(({ p }) => p === share)),
    })),
    { label: "Smallest seen", cell: ({ smallest_seen: value }) => number(value) },
    { label: "Largest seen", cell: ({ largest_seen: value }) => number(value) },
  ];
  return [
    copyable(table("Statistics over the workspace", columns, [{ rows: statistics }])),
    certainty && muted(`After ±: ${certainty}.`),
  ];
}

function boxTable(box, units) {
  const entries = Object.entries(box ?? {});
  if (entries.length === 0) return null;
  const unit = (name) => pretty(name.startsWith("r") ? units?.angle : units?.length);
  const columns = [
    { label: "Coordinate", text: true, cell: ([name]) => name },
    { label: "From", cell: ([, ends]) => number(ends?.[0]) },
    { label: "To", cell: ([, ends]) => number(ends?.[1]) },
    { label: "Unit", text: true, cell: ([name]) => unit(name) },
  ];
  return html(
    "details",
    null,
    html("summary", null, "The box"),
    copyable(table("The box of the workspace", columns, [{ rows: entries }])),
  );
}
