// The residuals of all views over the image: corner by corner, or their means over cells, which show what is systematic.
import * as Plot from "@observablehq/plot";
import { figure, html } from "../shared/dom.js";
import { isNumber, plural, significant } from "../shared/format.js";
import { COLOR, TIP, key, responsive } from "../shared/plots.js";
import { magnitudeQuantile, thinned } from "../shared/statistics.js";
import { arrowSwatch, circleSwatch } from "./halves.js";
import { arrows, circles, factorChooser, factorFor, imagePlot } from "./image_plot.js";
import { FATE, cellMiddles, countOf, imageSize, lengthOf } from "./observations.js";

const WIDEST = 900;
const COLUMNS = 24;
// More arrows than that nobody can tell apart.
const DRAWN_ARROWS = 5000;
// Of how many corners on the single ones are hidden at first.
const MANY = 4000;
const LEAST_IN_CELL = 4;
const CIRCLE = 2;
// How long arrows are drawn: those of single corners as a share of the image's width, means in cells.
const SINGLE_SHARE = 0.025;
const LONG_ARROW = 1.2;
const MIDDLE_RADIUS = 0.45;

export function residualField(data, corners) {
  const size = imageSize(data);
  const field = { size, corners, means: meansOver(size, corners, data.intrinsics?.noise_px) };
  const place = html("div");
  const chooser = html("span");
  const show = (mode) => {
    const drawing = mode === "means" ? meansOf(field) : singlesOf(field);
    const draw = (factor) => place.replaceChildren(drawing.figureFor(factor));
    chooser.replaceChildren(factorChooser(drawing.suits, "residual-factor", draw));
    draw(drawing.suits);
  };
  const first = corners.length > MANY ? "means" : "single";
  const select = html(
    "select",
    { name: "residual-mode", onchange: () => show(select.value) },
    html("option", { value: "single", selected: first === "single" }, "every corner"),
    html("option", { value: "means", selected: first === "means" }, "means of cells"),
  );
  show(first);
  return [html("div", { class: "toolbar" }, html("label", null, "Show ", select), chooser), place];
}

// The weighted mean residual of each cell that has a few corners: [{x, y, dx, dy, count, radius, isBeyond}]; radius: CIRCLE
// times what noise (sigma of one coordinate, px) would make of the mean's length.
export function meansOver(size, corners, noise) {
  const rows = Math.max(1, Math.round((COLUMNS * size.height) / size.width));
  const cells = cellMiddles({ columns: COLUMNS, rows }, size).map((middle) => ({
    ...middle,
    weight: 0,
    squares: 0,
    sum: [0, 0],
    count: 0,
  }));
  const place = (at, extent, count) =>
    Math.max(0, Math.min(count - 1, Math.floor(((at + 0.5) / extent) * count)));
  for (const { x, y, dx, dy, weight } of corners) {
    const cell = cells[place(y, size.height, rows) * COLUMNS + place(x, size.width, COLUMNS)];
    cell.count += weight > 0;
    cell.weight += weight;
    cell.squares += weight ** 2;
    cell.sum = [cell.sum[0] + weight * dx, cell.sum[1] + weight * dy];
  }
  return cells.filter(({ count }) => count >= LEAST_IN_CELL).map((cell) => meanOf(cell, noise));
}

function meanOf({ x, y, weight, squares, sum, count }, noise) {
  const [dx, dy] = sum.map((value) => value / weight);
  const radius = isNumber(noise) ? (CIRCLE * Math.SQRT2 * noise * Math.sqrt(squares)) / weight : 0;
  return { x, y, dx, dy, count, radius, isBeyond: radius > 0 && Math.hypot(dx, dy) > radius };
}

function meansOf({ size, means }) {
  const cell = size.width / COLUMNS;
  const radii = means.map(({ radius }) => radius);
  const beyond = means.filter(({ isBeyond }) => isBeyond);
  const caption =
    `Mean residuals of cells with at least ${LEAST_IN_CELL} corners. In ${beyond.length} of ${plural(means.length, "cell")} ` +
    "the arrow leaves its circle; noise alone does that in about one of fifty. Where many neighbours do, and point the same " +
    "way, the lens model does not follow the lens there.";
  return {
    suits: factorFor(
      [magnitudeQuantile(means.map(lengthOf), 0.95), LONG_ARROW * cell],
      [magnitudeQuantile(radii, 0.5), MIDDLE_RADIUS * cell],
    ),
    figureFor: (factor) =>
      figure(
        caption,
        html(
          "p",
          { class: "key" },
          html("span", null, arrowSwatch("within"), "mean of a cell, as noise explains it"),
          html("span", null, arrowSwatch("beyond"), "beyond its circle"),
          html("span", null, circleSwatch(), `${CIRCLE} times what noise would make (rms)`),
        ),
        responsive((width) =>
          imagePlot("Mean residuals over the image, as arrows", size, Math.min(width, WIDEST), {
            marks: [
              circles(means, factor, "expected"),
              arrows(
                means.filter(({ isBeyond }) => !isBeyond),
                factor,
                "within",
              ),
              arrows(beyond, factor, "beyond"),
              Plot.tip(means, Plot.pointer({ x: "x", y: "y", title: meanTitle, maxRadius: 30, ...TIP })),
            ],
          }),
        ),
      ),
  };
}

const meanTitle = (mean) =>
  `${plural(mean.count, "corner")}\nmean ${significant(lengthOf(mean))} px (${significant(mean.dx)}, ` +
  `${significant(mean.dy)})`;

function singlesOf({ size, corners }) {
  const all = corners.filter(({ fate }) => fate === FATE.whole);
  const whole = thinned(all, DRAWN_ARROWS);
  const weighedDown = corners.filter(({ fate }) => fate === FATE.weighedDown);
  const outliers = corners.filter(({ fate }) => fate === FATE.outlier);
  const drawn = [...whole, ...weighedDown, ...outliers];
  return {
    suits: factorFor([magnitudeQuantile(all.map(lengthOf), 0.95), SINGLE_SHARE * size.width]),
    figureFor: (factor) =>
      figure(
        captionOf(all, whole),
        key([
          ["line", COLOR.first, `counts whole: ${all.length}`],
          ["diamond", COLOR.second, `weighed down: ${weighedDown.length}`],
          [
            "cross",
            "var(--bad)",
            `outlier, left out: ${countOf(corners, FATE.outlier)}; drawn without arrow`,
          ],
        ]),
        responsive((width) =>
          imagePlot("Residuals of all corners over the image, as arrows", size, Math.min(width, WIDEST), {
            marks: [
              arrows(whole, factor, "fine within"),
              arrows(weighedDown, factor, "fine weighed-down"),
              Plot.dot(weighedDown, { x: "x", y: "y", symbol: "diamond", stroke: COLOR.second, r: 3.5 }),
              Plot.dot(outliers, {
                x: "x",
                y: "y",
                symbol: "times",
                stroke: "var(--bad)",
                r: 3.5,
                strokeWidth: 2,
              }),
              Plot.tip(drawn, Plot.pointer({ x: "x", y: "y", title: cornerTitle, maxRadius: 12, ...TIP })),
            ],
          }),
        ),
      ),
  };
}

function captionOf(all, drawn) {
  const share =
    drawn.length < all.length
      ? ` Of the ${all.length} that count whole, ${drawn.length} are drawn; of the others, all.`
      : "";
  return `Residuals of the corners of all views.${share} Point at a corner to read it.`;
}

const cornerTitle = ({ view, dx, dy, weight, fate }) =>
  `${view}\nresidual ${significant(Math.hypot(dx, dy))} px (${significant(dx)}, ${significant(dy)})` +
  (fate === FATE.whole
    ? ""
    : `\n${fate === FATE.outlier ? "outlier, left out" : `weight ${significant(weight, 2)}`}`);
