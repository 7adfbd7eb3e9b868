// Maps of errors and indices over a slice of the workspace.
import * as Plot from "@observablehq/plot";
import { max } from "d3";
import { colorOptions, colorRamp, contours } from "../shared/color_map.js";
import { append, figure, html, svg } from "../shared/dom.js";
import { isNumber, sentence, significant, withUnit } from "../shared/format.js";
import { COLOR, TIP, plot, responsive } from "../shared/plots.js";
import { STATE, cellsOf, colorScale, edgesOf, stripsOf } from "./map_grid.js";
import { pretty } from "./units.js";

const WIDEST = 700;
const MARGIN = { left: 56, right: 14, top: 26, bottom: 42 };

export const hasMaps = (maps) =>
  Boolean(maps?.quantities?.length && maps.x?.values?.length && maps.y?.values?.length);

export function renderMaps(section, { data }) {
  const { maps } = data;
  const place = html("div", { class: "map" });
  const show = (index) => place.replaceChildren(mapFigure(maps, maps.quantities[index]));
  append(section, chooser(maps.quantities, show), place);
  show(0);
}

function chooser(quantities, show) {
  if (quantities.length < 2) return null;
  const select = html(
    "select",
    { onchange: () => show(Number(select.value)) },
    quantities.map(({ label, key }, index) => html("option", { value: index }, label ?? key)),
  );
  return html("div", { class: "toolbar" }, html("label", null, "Show ", select));
}

function mapFigure(maps, quantity) {
  const cells = cellsOf(maps, quantity);
  const scale = colorScale(cells);
  const title = `${quantity.label ?? quantity.key}${maps.fixed ? ` at ${maps.fixed}` : ""}`;
  if (!scale) return figure(sentence(`${title}: no value anywhere in this slice`));
  return figure(
    `${sentence(title)} Lines join equal values. Point at the map to read it.`,
    html(
      "div",
      { class: "map-and-legend" },
      responsive((width) => map(maps, quantity, cells, scale, Math.min(width, WIDEST))),
      legend(quantity, scale, new Set(cells.map(({ state }) => state))),
    ),
  );
}

function legend({ label, key, unit }, scale, states) {
  const ramp = colorRamp(withUnit(`${label ?? key},`, pretty(unit)).replace(/,$/, ""), scale);
  const entry = (state, name, text) =>
    states.has(state) && html("span", null, html("span", { class: `map-key ${name}` }), text);
  return html(
    "div",
    { class: "map-legend" },
    ramp,
    html(
      "p",
      { class: "key" },
      entry(STATE.outsideJointRanges, "outside", "outside the joint ranges"),
      entry(STATE.singular, "none", "singular or near it"),
      scale.clamped && html("span", null, "the brightest colour: this and more"),
    ),
  );
}

function sizes(maps, width) {
  const [left, right] = edgesOf(maps.x.values);
  const [bottom, top] = edgesOf(maps.y.values);
  const inner = width - MARGIN.left - MARGIN.right;
  const alike = maps.x.unit === maps.y.unit;
  const ratio = alike ? Math.max(0.4, Math.min(1.4, (top - bottom) / (right - left))) : 0.8;
  return { left, right, bottom, top, height: Math.round(inner * ratio) + MARGIN.top + MARGIN.bottom };
}

function map(maps, quantity, cells, scale, width) {
  const { left, right, bottom, top, height } = sizes(maps, width);
  const grid = { width: maps.x.values.length, height: maps.y.values.length };
  const frame = { x1: left, x2: right, y1: bottom, y2: top };
  const axis = ({ label, unit }) => ({
    label: unit ? `${label}, ${pretty(unit)}` : label,
    labelArrow: false,
    ticks: Math.max(3, Math.round(width / 90)),
  });
  const strips = (wanted) => stripsOf(maps, (state) => state === wanted);
  const drawing = plot(`Map of ${quantity.label ?? quantity.key} over ${maps.x.label} and ${maps.y.label}`, {
    width,
    height,
    marginLeft: MARGIN.left,
    marginRight: MARGIN.right,
    marginTop: MARGIN.top,
    marginBottom: MARGIN.bottom,
    x: { ...axis(maps.x), domain: [left, right] },
    y: { ...axis(maps.y), domain: [bottom, top] },
    color: colorOptions(scale),
    marks: [
      Plot.rect([frame], { x1: "x1", x2: "x2", y1: "y1", y2: "y2", fill: "var(--nowhere)" }),
      Plot.raster(
        cells.map(({ value }) => value),
        { ...grid, ...frame, imageRendering: "pixelated" },
      ),
      contours(closedIn(cells), scale, grid, frame),
      Plot.rect([frame], { x1: "x1", x2: "x2", y1: "y1", y2: "y2", stroke: COLOR.page, strokeWidth: 2 }),
      stripMark(strips(STATE.outsideJointRanges), "url(#outside)"),
      stripMark(strips(STATE.singular), "url(#nowhere)"),
      Plot.tip(
        cells,
        Plot.pointer({ x: "x", y: "y", title: cellTitle(maps, quantity), maxRadius: 30, ...TIP }),
      ),
    ],
  });
  drawing.prepend(hatches());
  return drawing;
}

// Where nothing is known the robot is singular or cannot be: lines close in on it as on a peak.
function closedIn(cells) {
  const peak = max(cells, ({ value }) => value);
  return cells.map(({ value }) => value ?? peak);
}

const stripMark = (strips, fill) =>
  Plot.rect(strips, { x1: "x1", x2: "x2", y1: "y1", y2: "y2", fill, shapeRendering: "crispEdges" });

function hatches() {
  const lines = (id, className, path) =>
    svg(
      "pattern",
      { id, width: 7, height: 7, patternUnits: "userSpaceOnUse", class: className },
      svg("rect", { width: 7, height: 7 }),
      svg("path", { d: path }),
    );
  return svg(
    "defs",
    null,
    lines("outside", "hatch outside", "M-1,8L8,-1M-2,2L2,-2M5,9L9,5"),
    lines("nowhere", "hatch nowhere", "M0,0L7,7M0,7L7,0"),
  );
}

const STATE_TEXT = {
  [STATE.outsideJointRanges]: "outside the joint ranges",
  [STATE.singular]: "singular or near it",
};

const cellTitle =
  (maps, { unit }) =>
  ({ x, y, value, state }) => {
    const place = ({ label, unit: of }, at) => `${label} = ${withUnit(significant(at, 4), pretty(of))}`;
    const lines = [`${place(maps.x, x)}, ${place(maps.y, y)}`];
    if (isNumber(value)) lines.push(withUnit(significant(value), pretty(unit)));
    if (STATE_TEXT[state]) lines.push(STATE_TEXT[state]);
    return lines.join("\n");
  };
