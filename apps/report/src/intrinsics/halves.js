// Two cameras from half of the views each: where they differ, and what noise would explain.
import * as Plot from "@observablehq/plot";
import { append, definitions, figure, html, muted, paragraph, svg } from "../shared/dom.js";
import { isNumber, sentence, significant } from "../shared/format.js";
import { TIP, responsive } from "../shared/plots.js";
import { magnitudeQuantile } from "../shared/statistics.js";
import { arrows, circles, factorChooser, factorFor, imagePlot } from "./image_plot.js";
import { cellMiddles, imageSize, lengthOf } from "./observations.js";
import { distanceText, figureOf } from "./quantities.js";

const WIDEST = 700;
// Circles are drawn with this many times what is expected (rms): noise leaves them in fewer than 1 of 20 places.
const CIRCLE = 2;
// How long arrows are drawn, but for few, and how large the middle one of the circles, in cells.
const SHARE_SHORT = 0.95;
const LONG_ARROW = 1.4;
const MIDDLE_RADIUS = 0.5;

export const hasHalves = ({ intrinsics, halves }) =>
  Boolean(intrinsics?.cross_validation) || Boolean(halves?.difference_px?.some(Boolean));

export function renderHalves(section, data) {
  const document = data.intrinsics ?? {};
  const { why_not: whyNot, sentence: text } = document.cross_validation ?? {};
  append(
    section,
    text && paragraph(html("strong", null, sentence(text))),
    whyNot && paragraph(`There is none: ${sentence(whyNot)}`),
    muted(
      "Every other view goes into one half. A camera from each should map points to the same pixels, but for noise. Where " +
        "they differ by more, the lens model cannot follow this lens, or the board is not what its file says.",
    ),
    figures(document),
  );
  const points = pointsOf(data);
  if (points.length > 0) append(section, differenceMap(data, points));
}

function figures(document) {
  if (!isNumber(document.cross_validation?.ratio)) return null;
  const figureAt = (name) => figureOf(document, `cross_validation.${name}`);
  return definitions(
    [
      ["Difference", figureAt("difference_rms_px"), "root mean square over the image"],
      ["What noise would make", figureAt("expected_rms_px"), "the same, by both uncertainties"],
      ["Ratio", figureAt("ratio"), "place by place; 1 where only noise differs"],
      ["Limit of the ratio", figureAt("ratio_limit"), "a model that fits stays below, 999 times in 1000"],
      ["Factor on every σ", figureAt("sigma_factor"), "beyond what residuals give; 1 where the model fits"],
    ],
    "figures",
  );
}

// [{x, y, dx, dy, expected (px, rms), radius, isBeyond}] of the cells where the halves were compared.
export function pointsOf(data) {
  const { halves, intrinsics } = data;
  const overall = intrinsics?.cross_validation?.expected_rms_px;
  return cellMiddles(halves ?? { columns: 0, rows: 0 }, imageSize(data)).flatMap((middle, cell) => {
    const difference = halves.difference_px?.[cell];
    if (!difference || !difference.every(isNumber)) return [];
    const [dx, dy] = difference;
    const expected = halves.expected_px?.[cell] ?? overall ?? null;
    const radius = isNumber(expected) ? CIRCLE * expected : 0;
    return [{ ...middle, dx, dy, expected, radius, isBeyond: radius > 0 && Math.hypot(dx, dy) > radius }];
  });
}

function differenceMap(data, points) {
  const size = imageSize(data);
  const cell = size.width / data.halves.columns;
  const radii = points.map(({ radius }) => radius);
  const suits = factorFor(
    [magnitudeQuantile(points.map(lengthOf), SHARE_SHORT), LONG_ARROW * cell],
    [magnitudeQuantile(radii, 0.5), MIDDLE_RADIUS * cell],
  );
  const place = html("div");
  const show = (factor) =>
    place.replaceChildren(responsive((width) => map(size, points, factor, Math.min(width, WIDEST))));
  show(suits);
  return [
    html("div", { class: "toolbar" }, factorChooser(suits, "halves-factor", show)),
    html(
      "div",
      { class: "map-and-legend" },
      figure("Point at a place to read it.", place),
      html("div", { class: "map-legend" }, legend(points), summary(points, data.halves)),
    ),
  ];
}

function map(size, points, factor, width) {
  const isExpected = points.some(({ radius }) => radius > 0);
  return imagePlot("Differences between the cameras of the two halves, as arrows", size, width, {
    marks: [
      isExpected ? circles(points, factor, "expected") : null,
      arrows(
        points.filter(({ isBeyond }) => !isBeyond),
        factor,
        "within",
      ),
      arrows(
        points.filter(({ isBeyond }) => isBeyond),
        factor,
        "beyond",
      ),
      Plot.tip(points, Plot.pointer({ x: "x", y: "y", title: pointTitle, maxRadius: 40, ...TIP })),
    ],
  });
}

function pointTitle(point) {
  const expected = isNumber(point.expected) ? `\nby noise: ${significant(point.expected)} px (rms)` : "";
  return (
    `x = ${significant(point.x, 4)}, y = ${significant(point.y, 4)} px\n` +
    `difference ${significant(lengthOf(point))} px (${significant(point.dx)}, ${significant(point.dy)})${expected}`
  );
}

export const arrowSwatch = (className) =>
  svg(
    "svg",
    { width: 22, height: 16, "aria-hidden": "true" },
    svg("path", { class: `arrows ${className}`, d: "M1,8H20M14,4L20,8L14,12" }),
  );
export const circleSwatch = () =>
  svg(
    "svg",
    { width: 22, height: 16, "aria-hidden": "true" },
    svg("path", { class: "expected", d: "M4,8a7,7 0 1,0 14,0a7,7 0 1,0 -14,0Z" }),
  );

const legend = (points) =>
  html(
    "p",
    { class: "key" },
    html("span", null, arrowSwatch("within"), "difference, as noise explains it"),
    html("span", null, arrowSwatch("beyond"), "difference beyond its circle"),
    points.some(({ radius }) => radius > 0) &&
      html("span", null, circleSwatch(), `${CIRCLE} times what noise would make (rms)`),
  );

function summary(points, { distance_m: distance, expected_px: expected }) {
  const beyond = points.filter(({ isBeyond }) => isBeyond).length;
  const away = isNumber(distance) ? ` Points ${distanceText(distance)} away.` : "";
  const chance = expected
    ? "noise alone does that in fewer than one of twenty. Neighbouring places go together."
    : "all circles are as large as on average, and noise makes more towards the corners of the image.";
  return muted(`In ${beyond} of ${points.length} places the arrow leaves its circle; ${chance}${away}`);
}
