// Each index against the error, pose by pose: do they put the poses in the same order?
import * as Plot from "@observablehq/plot";
import { copyable } from "../shared/copy_table.js";
import { append, figure, html, muted, table } from "../shared/dom.js";
import {
  MISSING,
  fixed,
  isNumber,
  percent,
  sentence,
  significant,
  tick,
  withUnit,
} from "../shared/format.js";
import { COLOR, TIP, plot, responsive } from "../shared/plots.js";
import { SIZES, pretty } from "./units.js";

const WIDE_RATIO = 50;
const HEIGHT = 210;

export const hasComparison = (data) => Boolean(data.document?.comparison || data.scatter?.indices?.length);

export function renderComparison(section, { data }) {
  const comparison = data.document?.comparison ?? {};
  append(
    section,
    verdictOf(comparison.verdict ?? []),
    muted(
      "An index is of use for choosing poses if it puts them in the same order as the error does. Kendall’s τ says how " +
        "far it does: 1 always, 0 no better than chance, −1 the other way round.",
    ),
    data.scatter?.indices?.length && scatters(data.scatter, comparison.indices ?? []),
    comparison.indices?.length && tauTable(comparison),
    worstPairs(comparison.indices ?? []),
  );
}

// What matters first; the rest as a list.
function verdictOf([first, ...rest]) {
  if (!first) return null;
  const items = rest.map((text) => html("li", null, sentence(text)));
  return [html("p", { class: "lead" }, sentence(first)), items.length > 0 && html("ul", null, items)];
}

function scatters(scatter, judged) {
  const errors = scatter.errors ?? [];
  const place = html("div", { class: "scatters" });
  const show = (error) =>
    place.replaceChildren(...scatter.indices.map((index) => small(scatter, index, error, judged)));
  const radio = (error, index) => {
    const box = html("input", {
      type: "radio",
      name: "scatter-error",
      value: error.key,
      onchange: () => show(error),
    });
    box.checked = index === 0;
    return html("label", null, box, ` ${error.label ?? error.key}`);
  };
  if (errors.length === 0) return null;
  show(errors[0]);
  const caption = `${sentence(scatter.over ?? "")} Orange: the pair of poses about which the index is most wrong.`;
  return [
    html("div", { class: "toolbar", role: "radiogroup", "aria-label": "Error" }, errors.map(radio)),
    figure(caption.trim(), place),
  ];
}

function small(scatter, index, error, judged) {
  const points = pointsOf(scatter.names ?? [], index, error);
  const verdict = judged.find(({ key }) => key === index.key);
  const worst = (verdict?.worst_inversions ?? []).find(({ of }) => (of ?? "position") === error.key);
  const tau = verdict?.tau?.[error.key];
  const head = html(
    "h4",
    null,
    index.label ?? index.key,
    isNumber(tau) &&
      html("span", { class: verdict.trusted?.[error.key] ? "tau trusted" : "tau" }, ` τ = ${fixed(tau, 2)}`),
  );
  const drawing =
    points.length > 0
      ? responsive((width) => scatterPlot(points, index, error, worst, width))
      : muted("No values.");
  return html("div", { class: "scatter" }, head, drawing);
}

// [{name, index, error}] of poses that have both.
export function pointsOf(names, index, error) {
  return (index.values ?? [])
    .map((value, place) => ({
      name: names[place] ?? `${place + 1}`,
      index: value,
      error: error.values?.[place],
    }))
    .filter((point) => isNumber(point.index) && isNumber(point.error));
}

// Logarithmic where values differ by a large factor.
export function scaleType(values) {
  const least = Math.min(...values);
  return least > 0 && Math.max(...values) / least > WIDE_RATIO ? "log" : "linear";
}

function scatterPlot(points, index, error, worst, width) {
  const marked = points.filter(({ name }) => name === worst?.better || name === worst?.worse);
  const axis = (values, label, unit) => ({
    type: scaleType(values),
    label: unit ? `${label}, ${pretty(unit)}` : label,
    labelArrow: false,
    nice: true,
    // Powers of ten need room.
    ticks: values.some((value) => significant(value).includes("·")) ? 2 : 4,
    tickFormat: tick,
  });
  const mark = { x: "index", y: "error" };
  return plot(`${index.label ?? index.key} against ${error.label ?? error.key}`, {
    width,
    height: HEIGHT,
    marginLeft: 50,
    marginTop: 24,
    marginRight: 16,
    marginBottom: 38,
    x: {
      ...axis(
        points.map((point) => point.index),
        "index",
        index.unit,
      ),
      labelAnchor: "right",
    },
    y: {
      ...axis(
        points.map((point) => point.error),
        "error",
        error.unit,
      ),
      grid: true,
    },
    marks: [
      marked.length === 2
        ? Plot.line(marked, { ...mark, stroke: COLOR.second, strokeDasharray: "3 3" })
        : null,
      Plot.dot(points, { ...mark, r: 2.6, fill: COLOR.first, fillOpacity: 0.55 }),
      Plot.dot(marked, { ...mark, r: 4, fill: COLOR.second, stroke: COLOR.page }),
      Plot.tip(points, Plot.pointer({ ...mark, title: pointTitle(index, error), ...TIP })),
    ],
  });
}

const pointTitle =
  (index, error) =>
  ({ name, index: of, error: is }) =>
    `${name}\nindex ${withUnit(significant(of), pretty(index.unit))}\nerror ${withUnit(significant(is), pretty(error.unit))}`;

function tauTable({ indices, over, poses }) {
  const trusted =
    (key) =>
    ({ trusted }) =>
      typeof trusted?.[key] === "boolean" ? (trusted[key] ? "yes" : "no") : MISSING;
  const columns = [
    { label: "Index", text: true, cell: ({ label, key }) => label ?? key },
    ...SIZES.flatMap(({ key, label }) => [
      { label: `τ, ${label.toLowerCase()}`, cell: ({ tau }) => fixed(tau?.[key], 2) },
      { label: "Misranked", cell: ({ misranked }) => percent(misranked?.[key]) },
      { label: "Trusted", text: true, cell: trusted(key) },
    ]),
  ];
  const caption = `Index against error over ${over ?? `${poses ?? MISSING} poses`}`;
  return copyable(table(caption, columns, [{ rows: indices }]));
}

// Names of sampled poses are long: folded away.
function worstPairs(indices) {
  const rows = indices.flatMap((index) =>
    (index.worst_inversions ?? []).map((pair) => ({ ...pair, label: index.label ?? index.key })),
  );
  if (rows.length === 0) return null;
  const ratio = ({ error }) =>
    isNumber(error?.[0]) && isNumber(error?.[1]) ? Math.max(error[0] / error[1], error[1] / error[0]) : null;
  const columns = [
    { label: "Index", text: true, cell: ({ label }) => label },
    { label: "Error", text: true, cell: ({ of }) => of ?? "position" },
    { label: "Prefers", text: true, cell: ({ better }) => better },
    { label: "To", text: true, cell: ({ worse }) => worse },
    { label: "Whose error is smaller by a factor of", cell: (pair) => significant(ratio(pair)) },
  ];
  return html(
    "details",
    null,
    html("summary", null, "Pairs of poses about which the indices are most wrong"),
    copyable(table("Pairs in the wrong order, the worst of each index", columns, [{ rows }])),
  );
}
