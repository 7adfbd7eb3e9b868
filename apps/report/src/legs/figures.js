// Numbers and poses of the document in the units that people read.
import { valueAt } from "../shared/document.js";
import { MISSING } from "../shared/format.js";
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

// Columns of a pose, given the row's path to one: its place and its rotation vector, as options of the program take them.
export function poseColumns(document, pathOf) {
  const place = (label, axis) => ({
    label,
    unit: MM.unit,
    cell: (row) => bareFigureOf(document, `${pathOf(row)}.translation_m.${axis}`),
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
  return measuredNumber(rotationVector(rotation)[axis], DEGREES, `${path}.rotation_vector.${axis}`);
}
