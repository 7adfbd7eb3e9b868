// Curves over the time of the run.
import * as Plot from "@observablehq/plot";
import { isNumber, significant, tick, withUnit } from "./format.js";
import { COLOR, TIP, plot, responsive } from "./plots.js";
import { roundBelow } from "./scale_bars.js";
import { thinnedCurve } from "./thinning.js";

// A curve keeps its extremes in each of this many columns of the drawing.
const PIXELS_A_COLUMN = 2;
const LOG_DECADES = 6; // at most
const FEW_DECADES = 50; // most over least
const MARGINS = { marginLeft: 52, marginRight: 12, marginTop: 22, marginBottom: 36 };

// run: {times, moment?: of the run, to be marked and chosen}; curves: [{label, color, values, width?, dash?, faint?}];
// options: {description, label (of y), unit, height, log, zero, domain, levels: [{value, label, color, dash}], spans:
// [{from, to}]}. Returns the place of the plot, which is drawn once that is as wide as it is going to be.
export function timePlot(run, curves, options) {
  const place = responsive((width) => {
    const drawing = draw(run, curves, options, width);
    run.moment?.markIn(drawing);
    return drawing;
  });
  if (run.moment) place.classList.add("choosable");
  place.style.minHeight = `${options.height}px`;
  return place;
}

function draw({ times }, curves, options, width) {
  const { height, label, unit, log, levels = [], spans = [] } = options;
  const columns = Math.ceil(width / PIXELS_A_COLUMN);
  const drawn = curves.map((curve) => ({ curve, rows: rowsOf(times, curve, columns, log) }));
  const rows = drawn.flatMap((each) => each.rows);
  return plot(options.description, {
    width,
    height,
    ...MARGINS,
    x: timeAxis(times),
    y: { ...valueAxis(rows, options), label: label ?? unit },
    marks: [
      Plot.rectX(spans, { x1: "from", x2: "to", fill: "var(--care)", fillOpacity: 0.13 }),
      levels.map(levelMark),
      drawn.map(curveMark),
      Plot.tip(rows, Plot.pointer({ x: "time", y: "value", title: (row) => tipOf(row, unit), ...TIP })),
    ],
  });
}

const curveMark = ({ curve, rows }) =>
  Plot.line(rows, {
    x: "time",
    y: "value",
    stroke: curve.color,
    strokeWidth: curve.width ?? 1.8,
    strokeDasharray: curve.dash,
  });

const tipOf = ({ curve, time, value }, unit) =>
  `${curve.label}: ${withUnit(significant(value), unit)}\nat ${significant(time)} s`;

const rowsOf = (times, curve, columns, log) =>
  thinnedCurve(times, curve.values, columns).map(({ time, value }) => ({
    curve,
    time,
    value: log && !(value > 0) ? null : value,
  }));

const levelMark = ({ value, color = COLOR.muted, dash }) =>
  Plot.ruleY([value], { stroke: color, strokeDasharray: dash, strokeWidth: 1.3 });

export const timeAxis = (times) => ({
  label: "time, s",
  domain: [times[0], times[times.length - 1]],
  labelAnchor: "center",
  labelArrow: false,
  tickFormat: tick,
});

function valueAxis(rows, { log, zero, domain, ticks = 5 }) {
  const shared = { grid: true, labelArrow: false, tickFormat: tick, ticks };
  if (domain) return { ...shared, domain };
  if (!log) return { ...shared, zero, nice: true };
  const [least, most] = logDomain(rows.map(({ value }) => value).filter(isNumber));
  return { ...shared, type: "log", domain: [least, most], ticks: logTicks(least, most), clamp: true };
}

// Ends of a logarithmic axis: at 1, 2 or 5 times a power of ten.
export function logDomain(values) {
  const most = values.length ? values.reduce((a, b) => Math.max(a, b)) : 1;
  const smallest = values.length ? values.reduce((a, b) => Math.min(a, b)) : most;
  const least = Math.max(smallest, most / 10 ** LOG_DECADES);
  const below = roundBelow(least);
  const above = Number((1 / roundBelow(1 / most)).toPrecision(1));
  return above > 1.5 * below ? [below, above] : [below / 2, 2 * above];
}

// Powers of ten; with few of them 2 and 5 times those too.
export function logTicks(least, most) {
  const [from, to] = [Math.floor(Math.log10(least)), Math.ceil(Math.log10(most))];
  const powers = Array.from({ length: to - from + 1 }, (_, index) => from + index);
  const steps = most / least > FEW_DECADES ? [1] : [1, 2, 5];
  return powers
    .flatMap((power) => steps.map((step) => Number((step * 10 ** power).toPrecision(1))))
    .filter((value) => value >= least * (1 - 1e-9) && value <= most * (1 + 1e-9));
}
