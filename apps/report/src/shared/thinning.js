// Fewer points for drawings, with every extreme kept. No page elements here.
import { isNumber } from "./format.js";

// The points [{time, value}] of a curve that a drawing with so many columns needs: of each column the first, the last,
// the smallest and the largest, in order, and one point without a value where there is a gap.
export function thinnedCurve(times, values, columns) {
  const points = times.map((time, index) => ({
    time,
    value: isNumber(values[index]) ? values[index] : null,
  }));
  if (points.length <= 4 * columns) return points;
  const kept = new Set();
  for (let column = 0; column < columns; ++column) {
    const end = Math.floor(((column + 1) * points.length) / columns);
    keepOf(points, Math.floor((column * points.length) / columns), end, kept);
  }
  return [...kept].sort((a, b) => a - b).map((index) => points[index]);
}

function keepOf(points, start, end, kept) {
  let [least, most, gap] = [null, null, null];
  for (let index = start; index < end; ++index) {
    const { value } = points[index];
    if (value === null) {
      gap = gap ?? index;
      continue;
    }
    if (least === null || value < points[least].value) least = index;
    if (most === null || value > points[most].value) most = index;
  }
  for (const index of [start, least, most, gap, end - 1]) if (index !== null) kept.add(index);
}

// The indices of a path's points that are at least `apart` from the one kept before, the first and the last among them;
// points that are missing are left out.
export function sparse(points, apart) {
  const kept = [];
  points.forEach((point, index) => {
    if (!point) return;
    const last = points[kept[kept.length - 1]];
    if (!last || Math.hypot(...point.map((value, axis) => value - last[axis])) >= apart) kept.push(index);
  });
  const end = points.findLastIndex((point) => point);
  if (end >= 0 && kept[kept.length - 1] !== end) kept.push(end);
  return kept;
}
