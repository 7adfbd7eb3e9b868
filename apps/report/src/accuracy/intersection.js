// The errors that two poses have in common, inside those of each.
import { append, figure, html } from "../shared/dom.js";
import { isNumber } from "../shared/format.js";
import { number, withUnit } from "../shared/numbers.js";
import { paintAxes } from "../shared/paint_robot.js";
import { paintScaleBars } from "../shared/scale_bars.js";
import { TurnableView } from "../shared/turnable_view.js";
import { enclosing, projection } from "../shared/turntable.js";
import { paintPolyhedron } from "./paint_errors.js";
import { SIZES, unitsOf } from "./units.js";

const MARGIN = 1.15;
const HEIGHT_SHARE = 0.6;

export function renderIntersection(section, { data }) {
  const found = data.document?.intersection;
  if (!found) return;
  const units = unitsOf(data.document);
  const names = found.between ?? [];
  append(
    section,
    html("h3", null, `Errors that ${names.join(" and ")} have in common`),
    html(
      "div",
      { class: "pair" },
      SIZES.filter(({ key }) => found[key]?.vertices?.length).map((size) =>
        commonErrors(size, found[size.key], polyhedraOf(data.document, names, size.key), units[size.kind]),
      ),
    ),
  );
}

const polyhedraOf = (document, names, key) =>
  names
    .map((name) => document.poses?.find((pose) => pose.name === name)?.polyhedron?.[key])
    .filter((shape) => shape?.vertices?.length);

function commonErrors({ label }, common, wholes, unit) {
  const { radius } = enclosing([...common.vertices, ...wholes.flatMap(({ vertices }) => vertices)]);
  const scene = { center: [0, 0, 0], radius: MARGIN * radius };
  const draw = (look, size) => {
    const screen = projection(look, scene, size);
    const bar = { className: "errors", pixelsPerUnit: screen.scale, unit, text: (value) => `bar = ${value}` };
    return [
      ...paintAxes([0, 0, 0], scene.radius * 0.7, screen),
      ...wholes.map((whole, index) =>
        paintPolyhedron(hullOnly(whole), [0, 0, 0], 1, screen, `whole-${index}`),
      ),
      paintPolyhedron(common, [0, 0, 0], 1, screen),
      ...paintScaleBars([bar], size),
    ];
  };
  const view = new TurnableView(`${label} errors in common, inside those of each pose`, draw, HEIGHT_SHARE);
  const volume = isNumber(common.volume) && [" Volume ", withUnit(number(common.volume), `${unit}³`), "."];
  return figure(html("span", null, `${label} errors; lines: those of each pose.`, volume), view.element);
}

const hullOnly = ({ vertices }) => ({ vertices, facets: [] });
