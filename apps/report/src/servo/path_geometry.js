// The way of the platform's centre. SI, in base. No page elements here.
import { vec3 } from "gl-matrix";

export const centersOf = (poses) => (poses ?? []).map((pose) => pose?.translation_m ?? null);
export const firstOf = (items) => items?.find(Boolean) ?? null;
export const lastOf = (items) => items?.findLast(Boolean) ?? null;

// The straight way that the path is compared with: to the goal, or where that is not known to the path's end.
export function straightWay({ cycles, goal }) {
  const centers = centersOf(cycles?.poses);
  const from = firstOf(centers);
  if (!from) return null;
  const to = goal?.base_from_platform?.translation_m ?? lastOf(centers);
  return { from, to, toGoal: Boolean(goal?.base_from_platform) };
}

// Distances of points from the straight line through from and to (m; null where a point is missing).
export function deviations(points, { from, to }) {
  const way = vec3.subtract([], to, from);
  const length = vec3.length(way);
  return points.map((point) => {
    if (!point) return null;
    const there = vec3.subtract([], point, from);
    return length > 0 ? vec3.length(vec3.cross([], there, way)) / length : vec3.length(there);
  });
}
