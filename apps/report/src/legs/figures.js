// Numbers and poses of the document in the units that people read.
import { valueAt } from "../shared/document.js";
import { MISSING, fixed } from "../shared/format.js";
import { measured, measuredNumber } from "../shared/numbers.js";
import { DEGREES, MM, MRAD, PERCENT, PURE, SECONDS } from "../shared/quantities.js";
import { rotationVector } from "../shared/robot_geometry.js";

const OF_PATH = [
  [/_m(\.\d)?$/, MM],
  [/direction_error_rad$/, MRAD],
  [/_rad$/, DEGREES],
  [/_s$/, SECONDS],
  [/free_up_to$/, PERCENT],
];
const COUNTS = /(pieces|freedoms|most_possible|with_a_reversed_leg)$/;

export const unitOf = (path) => OF_PATH.find(([pattern]) => pattern.test(path))?.[1] ?? PURE;

// A number of the document as an element that keeps all its digits and says where it comes from. A count stays whole.
export function figureOf(document, path) {
  const value = valueAt(document, path);
  return measured(value, unitOf(path), path, COUNTS.test(path) ? String(value) : null);
}

// The same in a column whose head has the unit.
export const bareFigureOf = (document, path) => measuredNumber(valueAt(document, path), unitOf(path), path);

// A length or an angle with as many digits as a robot is good for, so that rounding does not show.
export function placeOf(document, path) {
  const unit = unitOf(path);
  const value = valueAt(document, path);
  return measuredNumber(value, unit, path, placeText(value, unit));
}

const DECIMALS = { [MM.unit]: 2, [DEGREES.unit]: 3 };
// Of what the element holds, which is free of rounding by the scale.
const placeText = (value, { unit, scale }) => fixed(Number((scale * value).toPrecision(12)), DECIMALS[unit]);

// Columns of a pose, given the row's path to one: its place and its rotation vector, as options of the program take them.
export function poseColumns(document, pathOf) {
  const place = (label, axis) => ({
    label,
    unit: MM.unit,
    cell: (row) => placeOf(document, `${pathOf(row)}.translation_m.${axis}`),
  });
  const turn = (label, axis) => ({
    label,
    unit: DEGREES.unit,
    cell: (row) => turnCell(document, pathOf(row), axis),
  });
  return [...["x", "y", "z"].map(place), ...["rx", "ry", "rz"].map(turn)];
}

function turnCell(document, path, axis) {
  const rotation = valueAt(document, `${path}.rotation_xyzw`);
  if (!rotation) return MISSING;
  const angle = rotationVector(rotation)[axis];
  return measuredNumber(angle, DEGREES, `${path}.rotation_vector.${axis}`, placeText(angle, DEGREES));
}
