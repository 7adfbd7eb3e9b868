// Errors and nearness to singularities over a slice of the workspace through the goal, and where the singularities are.
import * as Plot from "@observablehq/plot";
import { append, html } from "../shared/dom.js";
import { isNumber, significant, withUnit } from "../shared/format.js";
import { STATE } from "../shared/map_grid.js";
import { key } from "../shared/plots.js";
import { DEGREES, MM, PURE } from "../shared/quantities.js";
import { rotationVector } from "../shared/robot_geometry.js";
import { sliceFigure } from "../shared/slice_map.js";
import { legsOf } from "./wording.js";
import { zeroLines } from "./zero_lines.js";

const QUANTITIES = [
  { of: "set", member: "position_error_m", label: "largest position error", in: MM },
  { of: "set", member: "rotation_error_rad", label: "largest rotation error", in: DEGREES },
  { of: "set", member: "type_2_matrix", label: "distance from Type 2, hidden robot", in: PURE },
  { of: "robot", member: "type_2_matrix", label: "distance from Type 2, real robot", in: PURE },
  { of: "set", member: "type_1", label: "distance from Type 1, seen legs", in: PURE },
  { of: "robot", member: "type_1", label: "distance from Type 1, all legs", in: PURE },
];
const COORDINATES = ["x", "y", "z", "rx", "ry", "rz"];
// A start that is off by less (m or rad) is in the slice.
const IN_SLICE = 1e-6;
const LOCI = [
  { of: "set", color: "var(--hidden-locus)", text: "singular hidden robot (Type 2)" },
  { of: "robot", color: "var(--real-locus)", dash: "5 3", text: "singular real robot (Type 2)" },
];

export const hasMaps = ({ document }) => Boolean(document?.maps?.sets?.length && document.maps.robot);

const unitOf = (coordinate) => (coordinate.startsWith("r") ? DEGREES : MM);

export class Maps {
  constructor({ document }) {
    this.document = document;
    this.maps = document.maps;
    this.place = html("div");
    this.sets = this.selectOf("set", "Legs", this.maps.sets.map(legsOf));
    const labels = QUANTITIES.map(({ label, in: { unit } }) => (unit ? `${label}, ${unit}` : label));
    this.quantities = this.selectOf("quantity", "Show", labels);
  }

  selectOf(name, label, texts) {
    const options = texts.map((text, index) => html("option", { value: index }, text));
    const select = html("select", { name, onchange: () => this.draw() }, options);
    return { select, element: html("label", null, `${label} `, select) };
  }

  renderInto(section) {
    const toolbar = html("div", { class: "toolbar" }, this.sets.element, this.quantities.element);
    append(section, toolbar, this.place);
    this.draw();
  }

  // A set without maps leaves those of another.
  show(set) {
    const index = this.maps.sets.findIndex((each) => legsOf(each) === legsOf(set));
    if (index >= 0) this.sets.select.value = String(index);
    this.draw();
  }

  draw() {
    const { robot, sets } = this.maps;
    const of = { robot, set: sets[Number(this.sets.select.value)] };
    const quantity = QUANTITIES[Number(this.quantities.select.value)];
    const values = scaledGrid(of[quantity.of][quantity.member], quantity.in);
    const slice = { x: axis(this.maps.x), y: axis(this.maps.y), states: statesOf(robot.states, values) };
    const loci = lociOf(slice, of);
    const title = `${quantity.label}, legs ${legsOf(of.set)}, at ${heldText(this.maps)}`;
    const figure = sliceFigure(slice, { label: quantity.label, unit: quantity.in.unit, values }, title, {
      marks: [...loci.map(locusMarks), placeMarks(placesIn(this.document))],
      legend: key(loci.map(({ dash, color, text }) => [dash ? "dashes" : "line", color, text])),
      note: noteOf(quantity, of),
      tip: (cell) => measuresAt(of, cell),
    });
    this.place.replaceChildren(figure);
  }
}

const scaledGrid = (grid, { scale }) =>
  (grid ?? []).map((row) => row.map((value) => (isNumber(value) ? scale * value : null)));

function axis({ coordinate, values }) {
  const { unit, scale } = unitOf(coordinate);
  return { label: coordinate, unit, values: values.map((value) => scale * value) };
}

const STATES = { "outside-joint-ranges": STATE.outsideJointRanges, "out-of-reach": STATE.outOfReach };

// What is within reach and has no value is singular.
export const statesOf = (states, values) =>
  states.map((row, y) =>
    row.map((state, x) => {
      const isSingular = state !== "out-of-reach" && !isNumber(values[y]?.[x]);
      return isSingular ? STATE.singular : (STATES[state] ?? STATE.fine);
    }),
  );

function lociOf(slice, of) {
  return LOCI.map((locus) => ({
    ...locus,
    pieces: zeroLines(slice.x.values, slice.y.values, of[locus.of].type_2_geometric ?? []),
  })).filter(({ pieces }) => pieces.length > 0);
}

const locusMarks = ({ pieces, color, dash }) =>
  [
    { stroke: "white", strokeWidth: 4.5, strokeOpacity: 0.7 },
    { stroke: color, strokeWidth: 2.4, strokeDasharray: dash },
  ].map((style) => Plot.link(pieces, { x1: "x1", y1: "y1", x2: "x2", y2: "y2", ...style }));

const placeMarks = (places) => [
  Plot.dot(places, { x: "x", y: "y", r: 5, fill: "white", stroke: "black", strokeWidth: 1.6 }),
  Plot.text(places, {
    x: "x",
    y: "y",
    text: "name",
    dy: -13,
    fill: "black",
    stroke: "white",
    strokeWidth: 4,
    fontWeight: 600,
  }),
];

// Start and goal as far as they are in the slice, in its units.
export function placesIn({ maps, from, to }) {
  const [x, y] = [maps.x.coordinate, maps.y.coordinate];
  return [
    ["goal", to],
    ["start", from],
  ]
    .map(([name, pose]) => ({ name, at: coordinatesOf(pose) }))
    .filter(({ at }) =>
      COORDINATES.every(
        (each) => each === x || each === y || Math.abs(at[each] - maps.held[each]) < IN_SLICE,
      ),
    )
    .map(({ name, at }) => ({ name, x: unitOf(x).scale * at[x], y: unitOf(y).scale * at[y] }));
}

function coordinatesOf({ translation_m: translation, rotation_xyzw: rotation }) {
  const values = [...translation, ...rotationVector(rotation)];
  return Object.fromEntries(COORDINATES.map((name, index) => [name, values[index]]));
}

const heldText = ({ x, y, held }) =>
  COORDINATES.filter((each) => each !== x.coordinate && each !== y.coordinate)
    .map(
      (each) => `${each} = ${withUnit(significant(unitOf(each).scale * held[each], 4), unitOf(each).unit)}`,
    )
    .join(", ");

const isKnown = (grid) => (grid ?? []).flat().some(isNumber);

function noteOf({ member }, { set }) {
  const measure = {
    type_2_matrix: "The smallest singular value of what is held over the largest: 0 in a singularity.",
    type_1: "Of the leg nearest to it: 0 where it is stretched or folded, 1 at best.",
  }[member];
  const withoutLines =
    !isKnown(set.type_2_geometric) && "No line is known for the hidden robot of these legs.";
  return [measure, withoutLines].filter(Boolean).join(" ");
}

// The measures of Type 2 at a cell, signed as lines are drawn where they are known.
function measuresAt(of, { row, column }) {
  return [
    ["hidden robot", of.set],
    ["real robot", of.robot],
  ].flatMap(([name, { type_2_geometric: signed, type_2_matrix: matrix }]) => {
    const values = [matrix, signed].map((grid) => grid?.[row]?.[column]).filter(isNumber);
    return values.length
      ? [`${name}, Type 2: ${values.map((value) => significant(value)).join(", signed ")}`]
      : [];
  });
}
