// The correlations of the parameters as a map, and the strongest pairs as a table.
import * as Plot from "@observablehq/plot";
import { append, figure, html, muted, table } from "./dom.js";
import { fixed, isNumber } from "./format.js";
import { describeParameter, parameterTitle } from "./parameter_names.js";
import { COLOR, TIP, plot, responsive } from "./plots.js";

const STRONGEST_PAIRS = 12;
// So few parameters have room for their names and numbers in the map.
const FEW = 16;

export function renderCorrelations(section, data) {
  const parameters = orderedParameters(data.correlations ?? {});
  if (parameters.length < 2) {
    append(section, muted("Not available: no covariance was computed."));
    return;
  }
  const cells = cellsOf(parameters, data.correlations.matrix);
  append(
    section,
    muted(
      "How the errors of two parameters go together: 1 or −1 means that the images tell only a combination " +
        "of the two, 0 that they tell them apart.",
    ),
    html(
      "div",
      { class: "beside" },
      figure(
        mapCaption(),
        responsive((width) => map(parameters, cells, width)),
      ),
      pairTable(parameters, cells),
    ),
  );
}

// [{name, row, group, label}] by group, camera first; without those that have no correlations (held fixed).
export function orderedParameters({ names = [], matrix = [] }) {
  const known = (index) => (matrix[index] ?? []).some((value, other) => other !== index && isNumber(value));
  const rank = ({ group }) =>
    group === "Camera" ? 0 : group === "Other" ? Infinity : Number(group.slice(4));
  return names
    .map((name, row) => ({ name, row, ...describeParameter(name) }))
    .filter(({ row }) => known(row))
    .sort((a, b) => (rank(a) === rank(b) ? a.row - b.row : rank(a) - rank(b)));
}

function cellsOf(parameters, matrix) {
  return parameters
    .flatMap((a, y) => parameters.map((b, x) => ({ a, b, x, y, value: matrix[a.row]?.[b.row] })))
    .filter(({ value }) => isNumber(value));
}

function mapCaption() {
  return html(
    "span",
    null,
    html("span", { class: "swatch positive" }),
    " positive, ",
    html("span", { class: "swatch negative" }),
    " negative; full colour is ± 1. Point at a cell to see its two parameters.",
  );
}

function map(parameters, cells, available) {
  const groups = groupSpans(parameters);
  const size = Math.min(available, 530);
  const margin = 58;
  const scale = { type: "linear", domain: [-0.5, parameters.length - 0.5], axis: null };
  return plot("Map of the correlations between all parameters", {
    width: size,
    height: size,
    marginLeft: margin,
    marginTop: 24,
    marginRight: 4,
    marginBottom: margin - 24,
    x: scale,
    y: { ...scale, reverse: true },
    opacity: { type: "identity" },
    color: { type: "identity" },
    marks: [
      Plot.rect(cells, {
        x1: ({ x }) => x - 0.5,
        x2: ({ x }) => x + 0.5,
        y1: ({ y }) => y - 0.5,
        y2: ({ y }) => y + 0.5,
        fill: ({ value }) => (value > 0 ? "var(--positive)" : "var(--negative)"),
        fillOpacity: ({ value }) => Math.abs(value),
        shapeRendering: "crispEdges",
      }),
      ...(parameters.length > FEW ? groupMarks(groups, parameters.length) : nameMarks(parameters, cells)),
      Plot.tip(cells, Plot.pointer({ x: "x", y: "y", title: cellTitle, maxRadius: 12, ...TIP })),
    ],
  });
}

function groupSpans(parameters) {
  const names = [...new Set(parameters.map(({ group }) => group))];
  return names.map((name) => {
    const first = parameters.findIndex(({ group }) => group === name);
    const count = parameters.filter(({ group }) => group === name).length;
    return { name, end: first + count - 0.5, middle: first + (count - 1) / 2 };
  });
}

function groupMarks(groups, count) {
  const line = { stroke: COLOR.muted, strokeWidth: 0.75 };
  const inner = groups.slice(0, -1);
  return [
    Plot.ruleX(inner, { x: "end", ...line }),
    Plot.ruleY(inner, { y: "end", ...line }),
    Plot.text(groups, { x: "middle", y: -0.5, text: "name", dy: -9, fill: COLOR.text }),
    Plot.text(groups, { x: -0.5, y: "middle", text: "name", dx: -7, textAnchor: "end", fill: COLOR.text }),
    Plot.rect([0], { x1: -0.5, x2: count - 0.5, y1: -0.5, y2: count - 0.5, fill: null, ...line }),
  ];
}

const nameMarks = (parameters, cells) => [
  Plot.text(parameters, { x: (_, index) => index, y: -0.5, text: shortName, dy: -9, fill: COLOR.text }),
  Plot.text(parameters, {
    x: -0.5,
    y: (_, index) => index,
    text: shortName,
    dx: -7,
    textAnchor: "end",
    fill: COLOR.text,
  }),
  Plot.text(
    cells.filter(({ x, y }) => x !== y),
    {
      x: "x",
      y: "y",
      text: ({ value }) => fixed(value, 2).replace("0.", "."),
      fill: ({ value }) => (Math.abs(value) > 0.6 ? COLOR.page : COLOR.text),
      fontSize: 11,
    },
  ),
];

// "focal length fx" -> "fx"
const shortName = ({ label }) => label.split(" ").at(-1);

const cellTitle = ({ a, b, value }) =>
  `${parameterTitle(a.name)}\n${a === b ? "with itself" : parameterTitle(b.name)}\n${fixed(value, 3)}`;

// Without the group where there is only one.
const titlesOf = (parameters) =>
  new Set(parameters.map(({ group }) => group)).size > 1
    ? ({ name }) => parameterTitle(name)
    : ({ label }) => label;

function pairTable(parameters, cells) {
  const title = titlesOf(parameters);
  const pairs = cells.filter(({ x, y }) => x < y).sort((a, b) => Math.abs(b.value) - Math.abs(a.value));
  return table(
    "Strongest pairs",
    [
      { label: "Parameter", text: true, cell: ({ b }) => title(b) },
      { label: "with", text: true, cell: ({ a }) => title(a) },
      { label: "Correlation", cell: ({ value }) => fixed(value, 3) },
    ],
    [{ rows: pairs.slice(0, STRONGEST_PAIRS) }],
  );
}
