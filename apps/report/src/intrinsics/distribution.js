// How the residuals are distributed, beside the normal distribution of the noise that was found.
import * as Plot from "@observablehq/plot";
import { figure } from "../shared/dom.js";
import { isNumber, significant } from "../shared/format.js";
import { COLOR, key, plot, responsive } from "../shared/plots.js";
import { FATE } from "./observations.js";

const WIDEST = 760;
const SHOWN_SIGMAS = 5;
const BINS = 50;
const CURVE_POINTS = 121;

// Counts of values in equal bins within +- limit: {bins: [{from, to, count}], outside}.
export function histogram(values, limit, count = BINS) {
  const width = (2 * limit) / count;
  const bins = Array.from({ length: count }, (_, index) => ({
    from: -limit + index * width,
    to: -limit + (index + 1) * width,
    count: 0,
  }));
  let outside = 0;
  for (const value of values) {
    const bin = bins[Math.floor((value + limit) / width)];
    if (bin) bin.count += 1;
    else outside += 1;
  }
  return { bins, outside };
}

const density = (value, sigma) => Math.exp(-0.5 * (value / sigma) ** 2) / (sigma * Math.sqrt(2 * Math.PI));

export function renderDistribution(data, corners) {
  const values = corners.filter(({ fate }) => fate !== FATE.outlier).flatMap(({ dx, dy }) => [dx, dy]);
  const noise = data.intrinsics?.noise_px;
  const sigma = isNumber(noise) && noise > 0 ? noise : spreadOf(values);
  const limit = SHOWN_SIGMAS * sigma;
  const { bins, outside } = histogram(values, limit);
  const beyond =
    outside > 0 ? ` ${outside} of ${values.length} lie beyond ± ${significant(limit, 2)} px.` : "";
  return figure(
    `Both coordinates of the residuals of all corners but outliers.${beyond} Longer tails than the curve has are corners ` +
      "found badly; a lens model that does not fit makes the middle broad.",
    key([
      ["line", COLOR.first, "residuals"],
      ["line", COLOR.second, `normal distribution of σ = ${significant(sigma)} px`],
    ]),
    responsive((width) => distributionPlot(bins, values.length, sigma, limit, Math.min(width, WIDEST))),
  );
}

const spreadOf = (values) =>
  Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / Math.max(1, values.length)) || 1;

function distributionPlot(bins, total, sigma, limit, width) {
  const share = total * (bins[0].to - bins[0].from);
  const curve = Array.from({ length: CURVE_POINTS }, (_, index) => {
    const value = limit * ((2 * index) / (CURVE_POINTS - 1) - 1);
    return { value, count: share * density(value, sigma) };
  });
  return plot("Histogram of the residuals with the normal distribution of the noise", {
    width,
    height: 250,
    marginLeft: 56,
    marginBottom: 40,
    marginTop: 24,
    x: {
      domain: [-limit, limit],
      label: "residual of one coordinate, px",
      labelArrow: false,
      labelAnchor: "center",
    },
    y: { label: "coordinates", grid: true, labelArrow: false, ticks: 5 },
    marks: [
      Plot.rectY(bins, {
        x1: "from",
        x2: "to",
        y: "count",
        fill: COLOR.first,
        fillOpacity: 0.55,
        inset: 0.5,
      }),
      Plot.line(curve, { x: "value", y: "count", stroke: COLOR.second, strokeWidth: 2 }),
      Plot.ruleY([0], { stroke: COLOR.muted }),
    ],
  });
}
