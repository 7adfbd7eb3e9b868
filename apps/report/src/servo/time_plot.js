// Curves over the time of the run.
import * as Plot from "@observablehq/plot";
import { isNumber, significant, tick, withUnit } from "../shared/format.js";
import { COLOR, TIP, plot, responsive } from "../shared/plots.js";
import { thinned } from "./thinning.js";

// A curve keeps its extremes in each of this many columns of the drawing.
const PIXELS_A_COLUMN = 2;
const LOG_DECADES = 6; // at most
const MARGINS = { marginLeft: 52, marginRight: 12, marginTop: 22, marginBottom: 36 };

// run: {times, moment}; curves: [{label, color, values, width?, dash?, faint?}]; options: {description, label (of y), unit,
// height, log, zero, domain, levels: [{value, label, color, dash}], spans: [{from, to}]}. Returns the place of the plot,
// which is drawn once that is as wide as it is going to be.
export function timePlot(run, curves, options) {
  const place = responsive((width) => {
    const drawing = draw(run, curves, options, width);
    run.moment.markIn(drawing);
    return drawing;
  });
  place.classList.add("over-time");
  place.style.minHeight = `${options.height}px`;
  return place;
}

function draw({ times }, curves, options, width) {
  const { height, label, unit, log, levels = [], spans = [] } = options;
  const rows = curves.flatMap((curve) => rowsOf(times, curve, Math.ceil(width / PIXELS_A_COLUMN), log));
  const said = ({ curve, time, value }) =>
    `${curve.label}: ${withUnit(significant(value), unit)}\nat ${significant(time)} s`;
  return plot(options.description, {
    width,
    height,
    ...MARGINS,
    x: timeAxis(times),
    y: { ...valueAxis(rows, options), label: label ? withUnit(`${label},`, unit).replace(/,$/, "") : unit },
    color: { type: "identity" },
    marks: [
      spans.length > 0 && Plot.rectX(spans, { x1: "from", x2: "to", fill: "var(--care)", fillOpacity: 0.13 }),
      levels.map((level) => levelMark(level)),
      Plot.line(rows, {
        x: "time",
        y: "value",
        z: ({ curve }) => curve.label,
        stroke: ({ curve }) => curve.color,
        strokeWidth: 1.8,
        curve: "linear",
        render: asStyled,
      }),
      Plot.tip(rows, Plot.pointer({ x: "time", y: "value", title: said, ...TIP })),
    ].flat(),
  });

  // Widths and dashes are no channels of a line.
  function asStyled(index, scales, values, dimensions, context, next) {
    const group = next(index, scales, values, dimensions, context);
    [...group.children].forEach((path) => {
      const { curve } = rows[path.__data__?.[0]] ?? {};
      if (!curve) return;
      if (curve.width) path.setAttribute("stroke-width", curve.width);
      if (curve.dash) path.setAttribute("stroke-dasharray", curve.dash);
      if (curve.faint) path.setAttribute("stroke-opacity", 0.55);
    });
    return group;
  }
}

const rowsOf = (times, curve, columns, log) =>
  thinned(times, curve.values, columns).map(({ time, value }) => ({
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
  const values = rows.map(({ value }) => value).filter(isNumber);
  const most = Math.max(...values);
  const least = Math.max(Math.min(...values), most / 10 ** LOG_DECADES);
  const wide = most > 3 * least ? [least, most] : [least / 2, 2 * most];
  return { ...shared, type: "log", domain: values.length ? wide : [0.1, 1], nice: true, clamp: true };
}
