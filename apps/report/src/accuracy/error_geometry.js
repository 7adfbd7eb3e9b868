// Errors as shapes: how much to magnify them, how they look from a side. No page elements here.
import { vec3 } from "gl-matrix";
import { roundBelow } from "../shared/scale_bars.js";

// Poses whose errors differ by no more than this are magnified alike, so that their pictures can be compared.
const COMPARABLE = 4;

// The magnification at which an error becomes about as large as `room`; `all` are the errors of all poses (same unit).
export function magnification(error, all, room) {
  const comparable = all.filter(
    (other) => other > 0 && other < COMPARABLE * error && error < COMPARABLE * other,
  );
  return roundBelow(room / Math.max(error, ...comparable));
}

// The outline of an ellipsoid seen along the screen's third axis: {major, minor, angle (rad, from right to up)}, in the
// unit of the semi-axes.
export function ellipseOf({ semi_axes: lengths, directions }, { right, up }) {
  let [xx, xy, yy] = [0, 0, 0];
  directions.forEach((direction, index) => {
    const x = lengths[index] * vec3.dot(direction, right);
    const y = lengths[index] * vec3.dot(direction, up);
    [xx, xy, yy] = [xx + x * x, xy + x * y, yy + y * y];
  });
  const mean = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  return {
    major: Math.sqrt(mean + spread),
    minor: Math.sqrt(Math.max(0, mean - spread)),
    angle: 0.5 * Math.atan2(2 * xy, xx - yy),
  };
}

// Whether the outer side of a facet, counterclockwise from outside, is turned to the eye.
export function isFront(vertices, facet, toward) {
  const [a, b, c] = facet.map((index) => vertices[index]);
  const normal = vec3.cross([], vec3.subtract([], b, a), vec3.subtract([], c, a));
  return vec3.dot(normal, toward) > 0;
}

// Points of the ellipse in which a plane of two principal axes cuts an ellipsoid.
export function principalSection({ semi_axes: lengths, directions }, first, second, count = 48) {
  return Array.from({ length: count }, (_, step) => {
    const angle = (2 * Math.PI * step) / count;
    const along = vec3.scale([], directions[first], lengths[first] * Math.cos(angle));
    return vec3.scaleAndAdd([], along, directions[second], lengths[second] * Math.sin(angle));
  });
}
