// The drawing over one picture: found points coloured by residual, predicted outlines, exaggerated residuals.
import { interpolateRdYlBu } from "d3";
import { svg } from "../shared/dom.js";
import { isNumber, significant, signed } from "../shared/format.js";
import { symbol } from "../shared/picture_symbols.js";
import { edgesOf, isOutlier, namedSample } from "./observations.js";

// Colour of a residual: blue inward, yellow none, red outward; full at `limit`.
export const residualColor = (residual, limit) =>
  interpolateRdYlBu(0.5 - 0.5 * Math.max(-1, Math.min(1, residual / limit)));

// Unit normal of the polyline at the place nearest to the point; null for fewer than two points.
function normalNear(polyline, { x, y }) {
  let best = null;
  for (let i = 1; i < polyline.length; ++i) {
    const [ax, ay] = polyline[i - 1];
    const [dx, dy] = [polyline[i][0] - ax, polyline[i][1] - ay];
    const length = Math.hypot(dx, dy);
    if (length === 0) continue;
    const along = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / length ** 2));
    const distance = Math.hypot(x - ax - along * dx, y - ay - along * dy);
    if (!best || distance < best.distance) best = { distance, x: -dy / length, y: dx / length };
  }
  return best;
}

function middle(points) {
  const sum = points.reduce(([sx, sy], [x, y]) => [sx + x, sy + y], [0, 0]);
  return { x: sum[0] / points.length, y: sum[1] / points.length };
}

// The outward unit normal of an edge at a point: away from the middle of the leg's other edge.
export function outwardNormal(predicted, otherPredicted, point) {
  const normal = normalNear(predicted ?? [], point);
  if (!normal || !otherPredicted?.length) return null;
  const inside = middle(otherPredicted);
  const here = middle(predicted);
  const sign = (here.x - inside.x) * normal.x + (here.y - inside.y) * normal.y < 0 ? -1 : 1;
  return { x: sign * normal.x, y: sign * normal.y };
}

export function overlay(image, { limit, factor }) {
  const edges = edgesOf(image);
  return svg(
    "g",
    null,
    edges.map((edge) => {
      const other = edges.find(({ leg, edge: number }) => leg === edge.leg && number !== edge.edge);
      const samples = (edge.samples ?? []).map(namedSample);
      return svg(
        "g",
        null,
        outline(edge),
        samples.map((sample) => whisker(sample, edge, other, limit, factor)),
        samples.map((sample) => foundPoint(sample, edge, limit)),
      );
    }),
    legNumbers(edges),
  );
}

function outline({ leg, edge, predicted, left_out: leftOut }) {
  if (!predicted?.length) return null;
  const title = `Leg ${leg}, edge ${edge}: predicted${leftOut ? `; left out: ${leftOut}` : ""}`;
  return svg(
    "polyline",
    {
      points: predicted.map(([x, y]) => `${x},${y}`).join(" "),
      class: leftOut ? "predicted unused" : "predicted",
    },
    svg("title", null, title),
  );
}

function whisker(sample, edge, other, limit, factor) {
  const normal = outwardNormal(edge.predicted, other?.predicted, sample);
  if (!normal || !isNumber(sample.residual) || isOutlier(sample)) return null;
  const length = sample.residual * factor;
  return svg("path", {
    class: "whisker",
    stroke: residualColor(sample.residual, limit),
    d: `M${sample.x},${sample.y}l${(normal.x * length).toFixed(2)},${(normal.y * length).toFixed(2)}`,
  });
}

// Strokes keep their width on the screen, so a dot is a stroke of no length.
function foundPoint(sample, { leg, edge }, limit) {
  const weight = significant(sample.weight, 2);
  const title = `Leg ${leg}, edge ${edge}: ${signed(sample.residual, 3)} px, weight ${weight}`;
  const dot = `M${sample.x},${sample.y}h0`;
  if (isOutlier(sample)) return symbol(sample, "cross", "outlier", title);
  const fill = isNumber(sample.residual) ? residualColor(sample.residual, limit) : "gray";
  return svg(
    "g",
    null,
    svg("path", { class: "halo", d: dot }),
    svg("path", { class: "found", d: dot, stroke: fill }, svg("title", null, title)),
  );
}

// The number of each leg, halfway along it.
function legNumbers(edges) {
  const legs = [...new Set(edges.map(({ leg }) => leg))];
  return legs.map((leg) => {
    const points = edges.filter((edge) => edge.leg === leg).flatMap(({ predicted }) => predicted ?? []);
    if (points.length === 0) return null;
    const { x, y } = middle(points);
    return svg("text", { x, y, class: "leg-number" }, String(leg));
  });
}
