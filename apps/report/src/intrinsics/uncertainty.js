// How far off the pixel of a point is, all over the image, because the camera is not known better.
import * as Plot from "@observablehq/plot";
import { max } from "d3";
import { colorOptions, colorRamp, colorScaleOf, contours } from "../shared/color_map.js";
import { copyable } from "../shared/copy_table.js";
import { append, figure, html, muted, table } from "../shared/dom.js";
import { isNumber, significant, tick } from "../shared/format.js";
import { TIP, responsive } from "../shared/plots.js";
import { RECT, frameOf, imagePlot } from "./image_plot.js";
import { boardDistance, cellMiddles, imageSize, nearestToBoard } from "./observations.js";
import { distanceText, figureOf } from "./quantities.js";

const WIDEST = 700;
// Uncertainties grow steeply into the corners of the image: equal steps of colour then mean equal ratios.
const WIDE_RATIO = 4;

const mapsOf = ({ maps }) => (maps?.maps ?? []).filter(({ sigma_px: sigma }) => sigma?.some(isNumber));

export const hasUncertainty = (data) =>
  mapsOf(data).length > 0 || Boolean(data.intrinsics?.uncertainty?.length);

export function renderUncertainty(section, data) {
  append(
    section,
    muted(
      "One standard deviation of the pixel of a point that stands still before the camera, in the direction in the " +
        "image in which it is largest. Whoever measures with this camera has this error beside that of finding the point.",
    ),
  );
  if (mapsOf(data).length > 0) append(section, mapChooser(data));
  if (data.intrinsics?.uncertainty?.length) append(section, uncertaintyTable(data.intrinsics));
}

function uncertaintyTable(document) {
  const rows = document.uncertainty.map((each, index) => ({ ...each, index }));
  const cell = (member) => (row) => figureOf(document, `uncertainty.${row.index}.${member}`);
  return copyable(
    table(
      "Over the whole image, by distance",
      [
        {
          label: "Distance of the point",
          text: true,
          cell: (row) => distanceCell(document, row),
        },
        { label: "σ, root mean square", cell: cell("rms_px") },
        { label: "σ at its worst", cell: cell("worst_px") },
      ],
      [{ rows }],
    ),
  );
}

const distanceCell = (document, { index, distance_m: distance }) =>
  isNumber(distance)
    ? figureOf(document, `uncertainty.${index}.distance_m`, tick(distance))
    : distanceText(null);

function mapChooser(data) {
  const maps = mapsOf(data);
  const place = html("div", { class: "map" });
  const show = (index) => place.replaceChildren(mapFigure(data, maps[index]));
  const first = nearestToBoard(
    maps.map(({ distance_m: distance }) => distance),
    boardDistance(data),
  );
  const select = html(
    "select",
    { name: "distance", onchange: () => show(Number(select.value)) },
    maps.map(({ distance_m: distance }, index) =>
      html("option", { value: index, selected: index === first }, distanceText(distance)),
    ),
  );
  show(first);
  const toolbar = html("div", { class: "toolbar" }, html("label", null, "Distance of the point ", select));
  return [maps.length > 1 && toolbar, place];
}

function mapFigure(data, { distance_m: distance, sigma_px: sigma }) {
  const size = imageSize(data);
  const { columns, rows } = data.maps;
  const cells = cellMiddles(data.maps, size).map((middle, index) => ({
    ...middle,
    value: sigma[index] ?? null,
  }));
  const known = cells.map(({ value }) => value).filter(isNumber);
  const scale = colorScaleOf(known, { wideRatio: WIDE_RATIO });
  const grid = { width: columns, height: rows };
  return html(
    "div",
    { class: "map-and-legend" },
    figure(
      "Lines join equal values. Point at the map to read it.",
      responsive((width) => map(size, cells, scale, grid, Math.min(width, WIDEST))),
    ),
    legend(scale, distance, cells),
  );
}

function map(size, cells, scale, grid, width) {
  const frame = frameOf(size);
  const peak = max(cells, ({ value }) => value);
  return imagePlot("Map of the uncertainty of a pixel over the image", size, width, {
    color: colorOptions(scale),
    marks: [
      Plot.rect([frame], { ...RECT, fill: "var(--nowhere)" }),
      Plot.raster(
        cells.map(({ value }) => value),
        { ...grid, ...frame, imageRendering: "pixelated" },
      ),
      // Beyond the reach of the lens model nothing is known: lines close in on it as on a peak.
      contours(
        cells.map(({ value }) => value ?? peak),
        scale,
        grid,
        frame,
      ),
      Plot.tip(cells, Plot.pointer({ x: "x", y: "y", title: cellTitle, maxRadius: 40, ...TIP })),
    ],
  });
}

const cellTitle = ({ x, y, value }) =>
  `x = ${significant(x, 4)}, y = ${significant(y, 4)} px\n` +
  (isNumber(value) ? `σ = ${significant(value)} px` : "beyond the reach of the lens model");

function legend(scale, distance, cells) {
  const isPartly = cells.some(({ value }) => !isNumber(value));
  return html(
    "div",
    { class: "map-legend" },
    colorRamp(`σ of a pixel, px; ${distanceText(distance)}${isNumber(distance) ? " away" : ""}`, scale),
    html(
      "p",
      { class: "key" },
      isPartly &&
        html("span", null, html("span", { class: "map-key none" }), "beyond the reach of the lens model"),
      scale.clamped && html("span", null, "the brightest colour: this and more"),
    ),
  );
}
