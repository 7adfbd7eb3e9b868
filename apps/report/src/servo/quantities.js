// Quantities of a run in the units that people read: millimetres, milliradians, milliseconds.
import { valueAt } from "../shared/document.js";
import { measured } from "../shared/numbers.js";
import { MM, MRAD, PURE, PX, SECONDS } from "../shared/quantities.js";

// scale takes SI to the unit
export const MM_PER_S = { unit: "mm/s", scale: 1e3 };
const PER_SECOND = { unit: "1/s", scale: 1 };
const MS = { unit: "ms", scale: 1e3 };
const MICROSECONDS = { unit: "µs", scale: 1e6 };

const OF_UNIT = { m: MM, rad: MRAD, px: PX };
const OF_SUFFIX = [
  [/_m_per_s$/, MM_PER_S],
  [/_per_s$/, PER_SECOND],
  [/_px$/, PX],
  [/_m$/, MM],
  [/_rad$/, MRAD],
  [/_s$/, SECONDS],
];

// The unit in which the controlled error is shown.
export const ofError = (document) => OF_UNIT[document?.unit] ?? { unit: document?.unit ?? "", scale: 1 };

// A short time: by its size.
export const shortTime = (seconds) => (Math.abs(seconds) < 1e-3 ? MICROSECONDS : MS);

// The unit for a member of the document, such as "final_pose_error.position_m".
export function unitOf(path, value, document) {
  if (path === "final_error" || path === "tolerance") return ofError(document);
  if (/(compute|look)_time_s\./.test(path)) return shortTime(value);
  const [, found] = OF_SUFFIX.find(([suffix]) => suffix.test(path)) ?? [];
  return found ?? PURE;
}

// A number of the document as an element that keeps all its digits and says where it comes from. A count stays whole.
export function figureOf(document, path) {
  const value = valueAt(document, path);
  return measured(value, unitOf(path, value, document), path, isCount(path) ? String(value) : null);
}

const isCount = (path) => path === "iterations" || /^legs\./.test(path);
