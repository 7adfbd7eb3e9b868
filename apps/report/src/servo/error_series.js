// The errors of a run over its cycles, and how fast they fall. No page elements here.
import { quat, vec3 } from "gl-matrix";
import { isNumber } from "../shared/format.js";
import { MM, MRAD, PX } from "../shared/quantities.js";
import { ofError } from "./quantities.js";

// An error must be this many times what is left at the end to count for the rate.
const ABOVE_FLOOR = 5;
const FEWEST_FITTED = 8;

const CONTROLLED = {
  edges: "edges of the legs",
  directions: "directions of the legs",
  pose: "pose of the platform",
  joints: "joint readings",
};
const SAME_AS = { edges: "edge_error_px", directions: "direction_error_rad" };

// [{key, label, unit, values (in the unit, one a cycle), single?: {label, values of each}, tolerance?}], the controlled
// error first; those that the run does not know are left out.
export function errorSeries(data) {
  const { cycles = {}, document = {} } = data;
  const shown = (values, { scale }) =>
    (values ?? []).map((value) => (isNumber(value) ? scale * value : null));
  const edges = {
    unit: "px",
    values: shown(cycles.edge_error_px, PX),
    single: singles(cycles.edge_errors_px, PX, edgeName),
  };
  const directions = {
    unit: "mrad",
    values: shown(cycles.direction_error_rad, MRAD),
    single: singles(cycles.direction_errors_rad, MRAD, (index) => `leg ${index + 1}`),
  };
  const controlled = {
    key: "controlled",
    label: `Controlled: ${CONTROLLED[document.mode] ?? "error"}`,
    unit: ofError(document).unit,
    values: shown(cycles.error, ofError(document)),
    tolerance: shown(cycles.tolerance, ofError(document)),
  };
  const others = [
    { key: "edge_error_px", label: "Edges", ...edges },
    { key: "direction_error_rad", label: "Directions of the legs", ...directions },
    ...poseSeries(data),
    {
      key: "joints",
      label: "Joint readings, the farthest from the goal",
      unit: "mm",
      values: jointErrors(data),
    },
  ];
  return withoutRepetition(controlled, others, document.mode).filter(({ values }) => values.some(isNumber));
}

// The controlled error is not shown again under its other name, where it is the same.
function withoutRepetition(controlled, others, mode) {
  const same = others.find(({ key }) => key === SAME_AS[mode]);
  if (!same) return [controlled, ...others];
  const repeats = controlled.values.every((value, index) => closeTo(value, same.values[index]));
  const rest = repeats ? others.filter((other) => other !== same) : others;
  return [{ ...controlled, single: repeats ? same.single : null }, ...rest];
}

const closeTo = (a, b) => a === b || Math.abs(a - b) <= 1e-6 * Math.max(Math.abs(a), Math.abs(b));

const edgeName = (index) => `leg ${Math.floor(index / 2) + 1}, edge ${(index % 2) + 1}`;

function singles(rows, { scale }, name) {
  const count = rows?.[0]?.length ?? 0;
  return Array.from({ length: count }, (_, index) => ({
    label: name(index),
    leg: count > 6 ? Math.floor(index / 2) : index,
    values: rows.map((row) => (isNumber(row?.[index]) ? Math.abs(scale * row[index]) : null)),
  }));
}

function poseSeries({ cycles = {}, goal }) {
  const at = goal?.base_from_platform;
  if (!at) return [];
  const kinds = [
    ["position", "Position of the platform", "mm", (pose) => MM.scale * distance(pose, at)],
    ["rotation", "Rotation of the platform", "mrad", (pose) => MRAD.scale * angle(pose, at)],
  ];
  const sources = [
    ["poses", "by the readings"],
    ["true_poses", "true"],
  ].filter(([name]) => cycles[name]?.some(Boolean));
  return kinds.flatMap(([key, label, unit, errorOf]) =>
    sources.map(([name, source]) => ({
      key: `${key} ${source}`,
      panel: label,
      source,
      label: `${label}, ${source}`,
      unit,
      values: cycles[name].map((pose) => (pose ? errorOf(pose) : null)),
    })),
  );
}

const distance = (pose, goal) => vec3.distance(pose.translation_m, goal.translation_m);

// Of the rotation from one to the other; exact for small angles too.
export function angle({ rotation_xyzw: a }, { rotation_xyzw: b }) {
  const [x, y, z, w] = quat.multiply([], a, quat.conjugate([], b));
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}

function jointErrors({ cycles = {}, goal }) {
  const wanted = goal?.joint_readings_m;
  if (!wanted) return [];
  return (cycles.joint_readings_m ?? []).map((row) => {
    const errors = (row ?? []).map((value, index) =>
      isNumber(value) ? Math.abs(value - wanted[index]) : NaN,
    );
    const largest = Math.max(...errors);
    return isNumber(largest) ? MM.scale * largest : null;
  });
}

// How fast an error falls: the straight line through its logarithm, over the cycles in which no limit was in force and
// that are well above what is left at the end: {rate_per_s, from_s, to_s}; null where there are too few.
export function exponentialRate(times, values, limits = []) {
  const floor = ABOVE_FLOOR * restOf(values);
  const fitted = values
    .map((value, index) => ({ time: times[index], value, free: !limits[index] }))
    .filter(({ value, free }) => free && isNumber(value) && value > floor);
  if (fitted.length < FEWEST_FITTED) return null;
  return { rate_per_s: -slope(fitted), from_s: fitted[0].time, to_s: fitted[fitted.length - 1].time };
}

// The median of the last tenth.
function restOf(values) {
  const present = values.filter(isNumber);
  const last = present.slice(-Math.max(1, Math.floor(present.length / 10))).sort((a, b) => a - b);
  return last[Math.floor(last.length / 2)] ?? 0;
}

function slope(points) {
  const mean = (of) => points.reduce((sum, point) => sum + of(point), 0) / points.length;
  const [t, y] = [mean(({ time }) => time), mean(({ value }) => Math.log(value))];
  const [xy, xx] = [
    mean(({ time, value }) => (time - t) * (Math.log(value) - y)),
    mean(({ time }) => (time - t) ** 2),
  ];
  return xy / xx;
}
