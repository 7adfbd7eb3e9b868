// Values over a plane as colours with lines of equal value between them.
import * as Plot from "@observablehq/plot";
import { interpolateViridis, min, quantile } from "d3";
import { tick } from "./format.js";

// Beyond this ratio of largest to smallest, equal steps of colour mean equal ratios.
const WIDE_RATIO = 30;
// What few places have must not take the colours from the rest.
const SHARE_IN_COLOR = 0.98;
const CONTOURS = 9;
const MOST_TICKS = 5;
const STEPS = [[1, 1.5, 2, 3, 4, 5, 7], [1, 2, 3, 5], [1, 2, 5], [1]];

// {type, domain, clamped}: the scale of the colours for the values (at least one); `all`: with those that are shown with
// the same colours.
export function colorScaleOf(values, { all = values, wideRatio = WIDE_RATIO } = {}) {
  const least = min(values);
  const top = Math.max(quantile(values, SHARE_IN_COLOR), least);
  const wide = least > 0 && top / least > wideRatio;
  const end = top > least ? top : least + (Math.abs(least) || 1);
  return {
    type: wide ? "log" : "linear",
    domain: [least, end],
    clamped: all.some((value) => value > end),
  };
}

export const colorOptions = ({ type, domain }) => ({
  type,
  domain,
  interpolate: interpolateViridis,
  clamp: true,
});

// Round numbers within the domain, few enough to stand beside each other.
export function logTicks([least, most]) {
  const first = Math.floor(Math.log10(least));
  const powers = Array.from({ length: Math.ceil(Math.log10(most)) - first + 1 }, (_, i) => 10 ** (first + i));
  const all = STEPS.map((steps) =>
    powers
      .flatMap((power) => steps.map((step) => step * power))
      .filter((value) => value >= least && value <= most),
  );
  return all.find((ticks) => ticks.length <= MOST_TICKS) ?? all.at(-1);
}

export const colorRamp = (label, scale) =>
  Plot.legend({
    color: { ...colorOptions(scale), label },
    width: 280,
    marginLeft: 16,
    marginRight: 16,
    ticks: scale.type === "log" ? logTicks(scale.domain) : 4,
    tickFormat: tick,
    style: { fontSize: "12px", fontFamily: "inherit", background: "none", overflow: "visible" },
  });

// values: row by row, all of them numbers; grid: {width, height} in cells; frame: {x1, x2, y1, y2} around them.
export function contours(values, { type, domain: [least, most] }, grid, frame) {
  if (grid.width < 3 || grid.height < 3) return null;
  const levels = Array.from({ length: CONTOURS }, (_, index) => {
    const share = (index + 1) / (CONTOURS + 1);
    return type === "log" ? least * (most / least) ** share : least + share * (most - least);
  });
  return Plot.contour(values, {
    ...grid,
    ...frame,
    thresholds: levels,
    stroke: "white",
    strokeOpacity: 0.55,
    strokeWidth: 0.8,
    fill: "none",
  });
}
