// Figures 19 to 21 of Briot et al. 2016: largest errors of the Quattro over slices, with the singularities of its hidden
// robots, from the documents of `legible legs --map`.
import * as Plot from "@observablehq/plot";
import { interpolateViridis } from "d3";
import { MUTED, TEXT, compose, plot, svgNode } from "./sheet.js";

const SINGULAR = "#d1495b";
const MM = 1e3;
const DEG = 180 / Math.PI;

// Steps of a colour, in mm and in deg.
const POSITION_STEPS = [2, 2.5, 3, 4, 5, 7, 10, 15, 20, 30, 50];
const ROTATION_STEPS = [1, 1.5, 2, 2.5, 3, 4, 5, 7, 10, 15, 20];

const colorOf = (steps, index) => interpolateViridis(index / steps.length);

// One value a cell, row by row; NaN where there is none.
const flat = (grid, factor = 1) => Float64Array.from(grid.flat(), (value) => (value === null ? NaN : factor * value));

const setOf = ({ maps }, legs) => maps.sets.find((set) => String(set.legs) === String(legs));

// Everything above the last step has one colour; lines where it changes.
function errorMarks(maps, values, steps) {
  const grid = { width: maps.x.values.length, height: maps.y.values.length };
  const frame = { x1: maps.x.values[0], x2: maps.x.values.at(-1), y1: maps.y.values[0], y2: maps.y.values.at(-1) };
  const filled = [0, ...steps].map((step, index) =>
    Plot.contour(values, { ...grid, ...frame, thresholds: [step], fill: colorOf(steps, index), stroke: "none" }),
  );
  return { grid, frame, marks: filled };
}

// Where the signed condition is zero; for more legs than the platform needs, which have none, the pose with the least
// singular value.
function singularMark(maps, { type_2_geometric, type_2_matrix }, grid, frame) {
  const signed = type_2_geometric.flat().some((value) => value !== null);
  if (signed)
    return Plot.contour(flat(type_2_geometric), {
      ...grid,
      ...frame,
      thresholds: [0],
      stroke: SINGULAR,
      strokeWidth: 2.2,
      fill: "none",
    });
  const values = flat(type_2_matrix);
  const least = values.reduce((best, value, i) => (value < values[best] ? i : best), 0);
  const point = [maps.x.values[least % grid.width], maps.y.values[Math.floor(least / grid.width)]];
  return Plot.dot([point], { fill: SINGULAR, stroke: "white", r: 5 });
}

function mapPanel(maps, set, values, steps) {
  const { grid, frame, marks } = errorMarks(maps, values, steps);
  const axis = (label) => ({ label, ticks: 7, labelArrow: "none" });
  return plot({
    width: 410,
    height: 400,
    marginLeft: 50,
    marginBottom: 40,
    marginTop: 20,
    marginRight: 12,
    x: { ...axis("x, m"), domain: [frame.x1, frame.x2] },
    y: { ...axis("y, m"), domain: [frame.y1, frame.y2] },
    marks: [
      ...marks,
      singularMark(maps, set, grid, frame),
      Plot.frame({ stroke: "white", strokeWidth: 6 }), // contours close along the border
      Plot.frame({ stroke: MUTED }),
    ],
  });
}

// A strip of the colours with the value at which each begins.
function colorStrip(steps, unit, x, y) {
  const width = 30;
  const group = svgNode("g", { "font-size": 11, fill: TEXT, "font-family": "sans-serif" });
  [0, ...steps].forEach((step, index) => {
    const at = x + width * index;
    group.append(svgNode("rect", { x: at, y, width, height: 12, fill: colorOf(steps, index) }));
    if (index > 0) group.append(svgNode("text", { x: at, y: y + 24, "text-anchor": "middle" }, `${step}`));
  });
  group.append(svgNode("text", { x: x + width * (steps.length + 1) + 8, y: y + 11 }, unit));
  return group;
}

function panel(document, legs, quantity) {
  const set = setOf(document, legs);
  const position = quantity === "position";
  const values = position ? flat(set.position_error_m, MM) : flat(set.rotation_error_rad, DEG);
  const drawing = mapPanel(document.maps, set, values, position ? POSITION_STEPS : ROTATION_STEPS);
  drawing.setAttribute("height", 440);
  drawing.setAttribute("viewBox", "0 0 410 440");
  drawing.append(colorStrip(...(position ? [POSITION_STEPS, "mm"] : [ROTATION_STEPS, "deg"]), 4, 408));
  return { title: `${position ? "position" : "rotation"}, legs {${legs.join(", ")}}`, drawing };
}

const pairs = (document, quantity) => [panel(document, [2, 3], quantity), panel(document, [2, 4], quantity)];
const singular = (label) => [[SINGULAR, label]];

export const briotFigures = ({ slice_070, slice_061 }) => ({
  "briot-figure-19": compose(
    "Largest position error of the Quattro at z = -0.7 m, two legs seen",
    pairs(slice_070, "position"),
    singular("Type 2 singularities of the hidden robot"),
  ),
  "briot-figure-20": compose(
    "Largest rotation error of the Quattro at z = -0.7 m, two legs seen",
    pairs(slice_070, "rotation"),
    singular("Type 2 singularities of the hidden robot"),
  ),
  "briot-figure-21": compose(
    "Largest errors of the Quattro at z = -0.61 m, all legs seen",
    [panel(slice_061, [1, 2, 3, 4], "position"), panel(slice_061, [1, 2, 3, 4], "rotation")],
    singular("where what the directions hold has its least singular value"),
  ),
});
