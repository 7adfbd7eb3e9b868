// Errors as SVG: polyhedra, ellipsoids, arrows, ghosts of the platform, scale bars.
import { vec3 } from "gl-matrix";
import { svg } from "../shared/dom.js";
import { isNumber } from "../shared/format.js";
import { arrow, outline, path } from "../shared/paint_robot.js";
import { ellipseOf, isFront, principalSection } from "./error_geometry.js";

// shape: {vertices, facets}; magnified: metres on the scene for one unit of the vertices.
export function paintPolyhedron(shape, origin, magnified, screen, className = "") {
  if (!shape?.vertices?.length) return null;
  const points = shape.vertices.map((vertex) => screen.at(vec3.scaleAndAdd([], origin, vertex, magnified)));
  const facets = (shape.facets ?? []).filter((facet) => facet.length >= 3);
  const drawn = (front) =>
    facets
      .filter((facet) => isFront(shape.vertices, facet, screen.axes.toward) === front)
      .map((facet) =>
        svg("path", { class: front ? "front" : "back", d: path(facet.map((index) => points[index])) }),
      );
  return svg(
    "g",
    { class: `polyhedron ${className}` },
    drawn(false),
    drawn(true),
    svg("path", { class: "outline", d: path(outline(points)) }),
  );
}

export function paintEllipsoid(ellipsoid, origin, magnified, screen) {
  if (!ellipsoid?.semi_axes?.every(isNumber) || !ellipsoid.directions) return null;
  const { x, y } = screen.at(origin);
  const scale = magnified * screen.scale;
  const { major, minor, angle } = ellipseOf(ellipsoid, screen.axes);
  const section = ([first, second]) =>
    path(
      principalSection(ellipsoid, first, second).map((point) =>
        screen.at(vec3.scaleAndAdd([], origin, point, magnified)),
      ),
    );
  return svg(
    "g",
    { class: "ellipsoid" },
    svg("ellipse", {
      rx: (major * scale).toFixed(2),
      ry: (minor * scale).toFixed(2),
      transform: `translate(${x.toFixed(1)},${y.toFixed(1)}) rotate(${((-angle * 180) / Math.PI).toFixed(2)})`,
    }),
    [
      [0, 1],
      [1, 2],
      [2, 0],
    ].map((pair) => svg("path", { class: "section", d: section(pair) })),
  );
}

// From the platform's origin to the largest error.
export function paintDirection(direction, size, origin, magnified, screen) {
  if (!direction?.every?.(isNumber) || !isNumber(size)) return null;
  const end = screen.at(vec3.scaleAndAdd([], origin, direction, size * magnified));
  return svg("g", { class: "direction" }, arrow(screen.at(origin), end));
}
