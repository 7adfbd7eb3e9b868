// A slice of the workspace as a map: colours for the values, lines of equal value, hatches for what is out of bounds.
import * as Plot from "@observablehq/plot";
import { max } from "d3";
import { colorOptions, colorRamp, contours } from "./color_map.js";
import { figure, html, svg } from "./dom.js";
import { isNumber, sentence, significant, tick, withUnit } from "./format.js";
import { STATE, cellsOf, colorScale, edgesOf, stripsOf } from "./map_grid.js";
import { COLOR, TIP, plot, responsive } from "./plots.js";

const WIDEST = 700;
const MARGIN = { left: 56, right: 14, top: 26, bottom: 42 };
const STATES = [
  { state: STATE.outsideJointRanges, name: "outside", text: "outside the joint ranges" },
  { state: STATE.singular, name: "none", text: "singular or near it" },
  { state: STATE.outOfReach, name: "beyond", text: "out of reach" },
];

// slice: {x, y: {label, unit, values (equally spaced)}, states: STATE of each cell}; quantity: {label, unit, values};
// title: what the map is of; also: {marks: Plot's, drawn over the map; legend: elements of its key; tip(cell): further
// lines of what the pointer shows; note: a sentence for the caption}.
export function sliceFigure(slice, quantity, title, also = {}) {
  const cells = cellsOf(slice, quantity);
  const scale = colorScale(cells);
  if (!scale) return figure(sentence(`${title}: no value anywhere in this slice`));
  return figure(
    [sentence(title), also.note, "Lines join equal values. Point at the map to read it."]
      .filter(Boolean)
      .join(" "),
    html(
      "div",
      { class: "map-and-legend" },
      responsive((width) => map(slice, quantity, cells, scale, also, Math.min(width, WIDEST))),
      legend(quantity, scale, new Set(cells.map(({ state }) => state)), also.legend),
    ),
  );
}

function legend({ label, unit }, scale, states, further) {
  const ramp = colorRamp(unit ? withUnit(`${label},`, unit) : label, scale);
  const entries = STATES.filter(({ state }) => states.has(state)).map(({ name, text }) =>
    html("span", null, html("span", { class: `map-key ${name}` }), text),
  );
  return html(
    "div",
    { class: "map-legend" },
    ramp,
    html(
      "p",
      { class: "key" },
      entries,
      scale.clamped && html("span", null, "the brightest colour: this and more"),
    ),
    further,
  );
}

function sizes(slice, width) {
  const [left, right] = edgesOf(slice.x.values);
  const [bottom, top] = edgesOf(slice.y.values);
  const inner = width - MARGIN.left - MARGIN.right;
  const alike = slice.x.unit === slice.y.unit;
  const ratio = alike ? Math.max(0.4, Math.min(1.4, (top - bottom) / (right - left))) : 0.8;
  return { left, right, bottom, top, height: Math.round(inner * ratio) + MARGIN.top + MARGIN.bottom };
}

function map(slice, quantity, cells, scale, also, width) {
  const { left, right, bottom, top, height } = sizes(slice, width);
  const grid = { width: slice.x.values.length, height: slice.y.values.length };
  const frame = { x1: left, x2: right, y1: bottom, y2: top };
  const axis = ({ label, unit }) => ({
    label: unit ? `${label}, ${unit}` : label,
    labelArrow: false,
    ticks: Math.max(3, Math.round(width / 90)),
    tickFormat: tick,
  });
  const strips = (wanted) => stripsOf(slice, (state) => state === wanted);
  const drawing = plot(`Map of ${quantity.label} over ${slice.x.label} and ${slice.y.label}`, {
    width,
    height,
    marginLeft: MARGIN.left,
    marginRight: MARGIN.right,
    marginTop: MARGIN.top,
    marginBottom: MARGIN.bottom,
    x: { ...axis(slice.x), domain: [left, right] },
    y: { ...axis(slice.y), domain: [bottom, top] },
    color: colorOptions(scale),
    marks: [
      Plot.rect([frame], { x1: "x1", x2: "x2", y1: "y1", y2: "y2", fill: "var(--nowhere)" }),
      Plot.raster(
        cells.map(({ value }) => value),
        { ...grid, ...frame, imageRendering: "pixelated" },
      ),
      contours(closedIn(cells), scale, grid, frame),
      Plot.rect([frame], { x1: "x1", x2: "x2", y1: "y1", y2: "y2", stroke: COLOR.page, strokeWidth: 2 }),
      stripMark(strips(STATE.outsideJointRanges), "url(#outside)"),
      stripMark(strips(STATE.singular), "url(#nowhere)"),
      stripMark(strips(STATE.outOfReach), "url(#beyond)"),
      also.marks,
      Plot.tip(
        cells,
        Plot.pointer({ x: "x", y: "y", title: cellTitle(slice, quantity, also.tip), maxRadius: 30, ...TIP }),
      ),
    ],
  });
  drawing.prepend(hatches());
  return drawing;
}

// Where nothing is known the robot is singular or cannot be: lines close in on it as on a peak.
function closedIn(cells) {
  const peak = max(cells, ({ value }) => value);
  return cells.map(({ value }) => value ?? peak);
}

const stripMark = (strips, fill) =>
  Plot.rect(strips, { x1: "x1", x2: "x2", y1: "y1", y2: "y2", fill, shapeRendering: "crispEdges" });

function hatches() {
  const lines = (id, path) =>
    svg(
      "pattern",
      { id, width: 7, height: 7, patternUnits: "userSpaceOnUse", class: `hatch ${id}` },
      svg("rect", { width: 7, height: 7 }),
      svg("path", { d: path }),
    );
  return svg(
    "defs",
    null,
    lines("outside", "M-1,8L8,-1M-2,2L2,-2M5,9L9,5"),
    lines("nowhere", "M0,0L7,7M0,7L7,0"),
    lines("beyond", "M3.5,3.5h0.1"),
  );
}

const cellTitle =
  (slice, { unit }, tip) =>
  (cell) => {
    const place = ({ label, unit: of }, at) => `${label} = ${withUnit(significant(at, 4), of)}`;
    const lines = [`${place(slice.x, cell.x)}, ${place(slice.y, cell.y)}`];
    if (isNumber(cell.value)) lines.push(withUnit(significant(cell.value), unit));
    const state = STATES.find(({ state }) => state === cell.state);
    if (state) lines.push(state.text);
    return [...lines, ...(tip?.(cell) ?? [])].join("\n");
  };
