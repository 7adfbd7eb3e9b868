// Quantities of the document in the units that people read.
import { valueAt } from "../shared/document.js";
import { isNumber, tick } from "../shared/format.js";
import { measured } from "../shared/numbers.js";
import { DEGREES, METRES, MM, PERCENT, PURE, PX, SECONDS } from "../shared/quantities.js";

const OF_PATH = [
  [/\.[fc][xy]$/, PX],
  [/_px(\.\d+)?$/, PX],
  [/^board_warp_m\./, MM],
  [/_m$/, METRES],
  [/_rad$/, DEGREES],
  [/^time_s/, SECONDS],
  [/^coverage\.share$/, PERCENT],
];
const COUNTS = /^(views_used|corners_\w+|iterations|camera\.(width|height)_px)$/;

// The unit for a member of the document, such as "camera.sigma.fx".
export const unitOf = (path) => OF_PATH.find(([pattern]) => pattern.test(path))?.[1] ?? PURE;

// A number of the document as an element that keeps all its digits and says where it comes from. A count stays whole.
export function figureOf(document, path, text = null) {
  const value = valueAt(document, path);
  return measured(value, unitOf(path), path, text ?? (COUNTS.test(path) ? String(value) : null));
}

// A distance of the document (m; null: infinitely far).
export const distanceText = (distance) => (isNumber(distance) ? `${tick(distance)} m` : "infinitely far");
