// How long the computer took in each cycle.
import * as Plot from "@observablehq/plot";
import { bin } from "d3";
import { copyable } from "../shared/copy_table.js";
import { append, figure, html, muted, table } from "../shared/dom.js";
import { isNumber, percent, significant, tick } from "../shared/format.js";
import { COLOR, TIP, plot, responsive } from "../shared/plots.js";
import { shortTime } from "./quantities.js";
import { periodOf } from "./spans.js";

const HEIGHT = 230;
const BINS = 30;
// Times that spread over more than this get a logarithmic axis.
const WIDE = 12;
const QUANTILES = [
  ["Median", 0.5],
  ["90 %", 0.9],
  ["99 %", 0.99],
  ["Longest", 1],
];

const KINDS = [
  { name: "look_s", label: "From the image to the edges" },
  { name: "law_s", label: "From the edges to the command" },
];

export const hasTimes = ({ cycles }) => KINDS.some(({ name }) => cycles?.[name]?.some(isNumber));

export function renderTimes(section, { data, times }) {
  const kinds = KINDS.map((kind) => ({ ...kind, sorted: sortedTimes(data.cycles[kind.name]) })).filter(
    ({ sorted }) => sorted.length,
  );
  const period = periodOf(times);
  append(
    section,
    html("div", { class: "panels" }, kinds.map(histogram)),
    copyable(quantileTable(kinds)),
    period > 0 &&
      muted(`From command to command ${significant(1e3 * period)} ms went by; ${shares(kinds, period)}.`),
  );
}

// The smallest of the values that no more than this share of them stays above.
export const quantile = (sorted, share) => sorted[Math.max(0, Math.ceil(share * sorted.length - 1e-9) - 1)];

const sortedTimes = (values) => Float64Array.from((values ?? []).filter(isNumber)).sort();

const shares = (kinds, period) =>
  kinds
    .map(
      ({ label, sorted }) =>
        `${label.toLowerCase()} took ${percent(quantile(sorted, 0.99) / period)} of that at most`,
    )
    .join(", ") + ", in 99 % of the cycles";

function quantileTable(kinds) {
  const columns = [
    { label: "Time of a cycle", text: true, cell: ({ label }) => label },
    { label: "Unit", text: true, cell: ({ sorted }) => shortTime(quantile(sorted, 0.5)).unit },
    ...QUANTILES.map(([label, share]) => ({
      label,
      cell: ({ sorted }) => {
        const value = shortTime(quantile(sorted, 0.5)).scale * quantile(sorted, share);
        return html("data", { value: String(value) }, significant(value));
      },
    })),
  ];
  return table("Half, nine in ten, 99 in a hundred and all of the cycles took no longer than this", columns, [
    { rows: kinds },
  ]);
}

function histogram({ label, sorted }) {
  const { unit, scale } = shortTime(quantile(sorted, 0.5));
  const bars = barsOf(Array.from(sorted, (value) => scale * value));
  return figure(
    null,
    html("h4", null, label),
    responsive((width) => histogramPlot(label, bars, unit, width)),
  );
}

// {log, bars: [{from, to, count}]}; bins of equal ratios where the times spread far.
export function barsOf(sorted) {
  const [least, most] = [sorted[0], sorted[sorted.length - 1]];
  const log = least > 0 && most > WIDE * least;
  const thresholds = Array.from({ length: BINS - 1 }, (_, index) => {
    const share = (index + 1) / BINS;
    return log ? least * (most / least) ** share : least + share * (most - least);
  });
  const bins = bin().domain([least, most]).thresholds(thresholds)(sorted);
  const bars = bins.map(({ x0, x1, length }) => ({ from: x0, to: x1, count: length }));
  return {
    log,
    bars:
      least < most
        ? bars.filter(({ count }) => count)
        : [{ from: 0.95 * least, to: 1.05 * most, count: sorted.length }],
  };
}

function histogramPlot(label, { log, bars }, unit, width) {
  return plot(`How often it took how long: ${label.toLowerCase()}`, {
    width,
    height: HEIGHT,
    marginLeft: 52,
    marginBottom: 36,
    marginTop: 22,
    x: {
      type: log ? "log" : "linear",
      label: `time, ${unit}${log ? ", logarithmic" : ""}`,
      labelAnchor: "center",
      labelArrow: false,
      tickFormat: tick,
      ticks: Math.max(3, Math.floor(width / 90)),
    },
    y: { label: "cycles", grid: true, ticks: 4, tickFormat: tick, labelArrow: false },
    marks: [
      Plot.rectY(bars, { x1: "from", x2: "to", y: "count", fill: COLOR.first, inset: 0.3 }),
      Plot.ruleY([0], { stroke: COLOR.muted }),
      Plot.tip(
        bars,
        Plot.pointerX({
          x1: "from",
          x2: "to",
          y: "count",
          title: ({ from, to, count }) => `${significant(from)} to ${significant(to)} ${unit}: ${count}`,
          ...TIP,
        }),
      ),
    ],
  });
}
