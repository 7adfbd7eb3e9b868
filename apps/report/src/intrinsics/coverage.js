// Where in the image the board was and how it was tilted, and which view to add next.
import * as Plot from "@observablehq/plot";
import { interpolateBlues, max } from "d3";
import { append, figure, html, muted, paragraph } from "../shared/dom.js";
import { isNumber, plural, sentence } from "../shared/format.js";
import { COLOR, TIP, responsive } from "../shared/plots.js";
import { RECT, imagePlot } from "./image_plot.js";
import { imageSize } from "./observations.js";
import { figureOf } from "./quantities.js";
import { hasTilts, tiltPlot } from "./tilts.js";

const WIDEST = 640;
const LEAST_CELL_PX = 30; // for its number
// Of the blues: the lightest are too like the page.
const BLUES = { from: 0.18, to: 0.85 };
const WHITE_TEXT_FROM = 0.5;

const hasCells = ({ coverage }) => coverage?.columns > 0 && coverage.corners?.length > 0;

export const hasCoverage = (data) =>
  Boolean(
    hasCells(data) || hasTilts(data) || data.intrinsics?.coverage?.sentence || data.intrinsics?.next_view,
  );

export function renderCoverage(section, data) {
  const document = data.intrinsics ?? {};
  append(
    section,
    document.coverage?.sentence && paragraph(sentence(document.coverage.sentence)),
    nextView(document),
    html("div", { class: "pair" }, hasCells(data) && cellFigure(data), hasTilts(data) && tiltPlot(data)),
  );
}

function nextView(document) {
  const next = document.next_view;
  if (!next?.sentence) return null;
  const gain = [
    muted(
      "Worst uncertainty over the image: now ",
      figureOf(document, "next_view.now_px"),
      ", with that view ",
      figureOf(document, "next_view.then_px"),
      ".",
    ),
  ];
  return html(
    "div",
    { class: "next-view" },
    paragraph(html("strong", null, sentence(next.sentence))),
    isNumber(next.now_px) && isNumber(next.then_px) && gain,
  );
}

// [{x1, x2, y1, y2, x, y, count}] of the cells of the image.
export function coverageCells({ columns, rows, corners }, { width, height }) {
  return Array.from({ length: columns * rows }, (_, cell) => {
    const [column, row] = [cell % columns, Math.floor(cell / columns)];
    const [x1, x2] = [column, column + 1].map((at) => (at * width) / columns - 0.5);
    const [y1, y2] = [row, row + 1].map((at) => (at * height) / rows - 0.5);
    return { x1, x2, y1, y2, x: (x1 + x2) / 2, y: (y1 + y2) / 2, count: corners[cell] ?? 0 };
  });
}

function cellFigure(data) {
  const size = imageSize(data);
  const cells = coverageCells(data.coverage, size);
  const outline = data.next_view?.outline_px ?? [];
  return figure(
    "Corners that count, by cells of the image, of all views. Where there are none, nothing ties the lens model down.",
    html(
      "p",
      { class: "key" },
      html("span", null, html("span", { class: "map-key empty-cell" }), "no corner"),
      outline.length > 2 &&
        html("span", null, html("span", { class: "map-key proposed" }), "the board in the view to add next"),
    ),
    responsive((width) => cellPlot(size, cells, data.coverage.columns, outline, Math.min(width, WIDEST))),
  );
}

function cellPlot(size, cells, columns, outline, width) {
  const most = max(cells, ({ count }) => count) || 1;
  const shade = ({ count }) => BLUES.from + (BLUES.to - BLUES.from) * Math.sqrt(count / most);
  const hasRoom = width / columns >= LEAST_CELL_PX;
  return imagePlot("Numbers of corners in the cells of the image", size, width, {
    color: { type: "identity" },
    marks: [
      ...cellMarks(cells, shade),
      outline.length > 2 ? outlineMark(outline) : null,
      hasRoom ? numberMark(cells, shade) : null,
      Plot.tip(
        cells,
        Plot.pointer({
          x: "x",
          y: "y",
          title: ({ count }) => plural(count, "corner"),
          maxRadius: 40,
          ...TIP,
        }),
      ),
    ],
  });
}

const cellMarks = (cells, shade) => [
  Plot.rect(
    cells.filter(({ count }) => count > 0),
    { ...RECT, fill: (cell) => interpolateBlues(shade(cell)), inset: 0.5 },
  ),
  Plot.rect(
    cells.filter(({ count }) => count === 0),
    { ...RECT, fill: "var(--empty)", stroke: "var(--care)", strokeDasharray: "4 3", inset: 1.5 },
  ),
];

const outlineMark = (outline) =>
  Plot.line([...outline, outline[0]], {
    x: ([x]) => x,
    y: ([, y]) => y,
    stroke: COLOR.second,
    strokeWidth: 3,
    strokeLinejoin: "round",
    clip: true,
  });

function numberMark(cells, shade) {
  const color = (cell) =>
    cell.count === 0 ? "var(--care)" : shade(cell) > WHITE_TEXT_FROM ? "#fff" : "#16324a";
  const text = ({ count }) => String(count);
  return Plot.text(cells, { x: "x", y: "y", text, fill: color, fontSize: 11 });
}
