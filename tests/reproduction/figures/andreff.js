// Figures 5 to 8 of Andreff, Dallej and Martinet 2007, from the data that section_4 wrote.
import * as Plot from "@observablehq/plot";
import { MUTED, TEXT, compose, plot } from "./sheet.js";

const DIRECTIONS = "#4269d0";
const EDGES = "#d1495b";
const LEGS = ["#4269d0", "#e39d00", "#ff725c", "#3ba5a0", "#3ca951", "#a463f2"];
const SHOWN_EVERY = 3; // cycles: 60 ms

// ---- Figure 5.

const platformAt = ({ rear_mm, front_mm }) => [rear_mm, front_mm];

const legsTo = (legs_mm, end, stroke) =>
  legs_mm.map((joints) => Plot.line([joints[0], joints[end]], { stroke, strokeWidth: 1.2 }));

function overview(paths) {
  const { moments, legs_mm } = paths.directions;
  const [first, last] = [moments[0], moments.at(-1)];
  return plot({
    width: 350,
    height: 300,
    marginLeft: 50,
    marginRight: 10,
    marginTop: 20,
    marginBottom: 40,
    x: { domain: [-240, 310], label: "x, mm (the camera is at the right)", ticks: 5 },
    y: { domain: [0, 455], label: "z, mm", grid: true },
    marks: [
      ...legsTo(legs_mm, 2, "#afb8c1"),
      ...legsTo(legs_mm, 1, TEXT),
      Plot.line(platformAt(last), { stroke: "#8c959f", strokeWidth: 4, strokeLinecap: "round" }),
      Plot.line(platformAt(first), { stroke: TEXT, strokeWidth: 4, strokeLinecap: "round" }),
      Plot.line(
        moments.map(({ origin_mm }) => origin_mm),
        { stroke: DIRECTIONS, strokeWidth: 2 },
      ),
      Plot.line(
        paths.edges.moments.map(({ origin_mm }) => origin_mm),
        { stroke: EDGES, strokeWidth: 2 },
      ),
      Plot.text([first.front_mm], { text: ["start"], dx: 10, textAnchor: "start", fill: TEXT }),
      Plot.text([last.rear_mm], { text: ["goal"], dx: 30, dy: -6, fill: MUTED }),
    ],
  });
}

function pathPanel({ moments, goal_mm }, color) {
  const path = moments.map(({ origin_mm }) => origin_mm);
  const ticks = moments.filter(({ time_s }) => [0.25, 0.5, 1, 2].some((t) => Math.abs(t - time_s) < 1e-6));
  const [x0, z0] = path[0];
  const [x1, z1] = goal_mm;
  const half = 0.62 * Math.max(Math.abs(x1 - x0), Math.abs(z1 - z0));
  const [xm, zm] = [(x0 + x1) / 2, (z0 + z1) / 2];
  return plot({
    width: 320,
    height: 300,
    marginLeft: 50,
    marginBottom: 40,
    marginRight: 10,
    marginTop: 20,
    x: { domain: [xm - half * (260 / 240), xm + half * (260 / 240)], label: "x, mm", ticks: 5 },
    y: { domain: [zm - half, zm + half], label: "z, mm", grid: true },
    marks: [
      Plot.line([path[0], goal_mm], { stroke: MUTED, strokeDasharray: "4 3" }),
      Plot.line(path, { stroke: color, strokeWidth: 2.5 }),
      Plot.dot([path[0]], { fill: TEXT, r: 4 }),
      Plot.dot([goal_mm], { stroke: TEXT, r: 5, fill: "white" }),
      Plot.dot(ticks, { x: (d) => d.origin_mm[0], y: (d) => d.origin_mm[1], fill: color, r: 3 }),
      Plot.text(ticks, {
        x: (d) => d.origin_mm[0],
        y: (d) => d.origin_mm[1],
        text: (d) => `${d.time_s} s`,
        dx: -10,
        textAnchor: "end",
        fill: TEXT,
      }),
    ],
  });
}

function figure5({ side_view }) {
  return compose(
    "Path of the platform's origin in the symmetry plane under both laws",
    [
      { title: "Side view of the platform", drawing: overview(side_view) },
      { title: "Its origin under directions", drawing: pathPanel(side_view.directions, DIRECTIONS) },
      { title: "and under edges", drawing: pathPanel(side_view.edges, EDGES) },
    ],
    [
      [DIRECTIONS, "directions"],
      [EDGES, "edges"],
      [MUTED, "straight line to the goal", "4 3"],
    ],
  );
}

// ---- Figures 6 and 7.

// Rows {time_s, value, leg, curve} of a list of numbers a moment, as many a leg.
function curvesOf(moments, name) {
  const each = moments[0][name].length / 6;
  return moments
    .filter((_, i) => i % SHOWN_EVERY === 0)
    .flatMap(({ time_s, [name]: values }) =>
      values.map((value, curve) => ({ time_s, value: value ?? NaN, leg: Math.floor(curve / each), curve })),
    );
}

function curvesPanel(moments, name, label, domain) {
  return plot({
    width: 470,
    height: 300,
    marginLeft: 55,
    marginBottom: 40,
    x: { label: "time, s" },
    y: { label, grid: true, domain },
    marks: [
      Plot.ruleY([0], { stroke: MUTED }),
      Plot.line(curvesOf(moments, name), {
        x: "time_s",
        y: "value",
        z: "curve",
        stroke: (d) => LEGS[d.leg],
        strokeWidth: 1,
        clip: true,
      }),
    ],
  });
}

function extent(error_curves, name) {
  const all = Object.values(error_curves).flatMap((moments) => moments.flatMap((moment) => moment[name]));
  const largest = 1.05 * all.reduce((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
  return [-largest, largest];
}

function errorsFigure(law, data) {
  const moments = data.error_curves[law];
  const [directions, edges] = ["directions_mrad", "edges_px"].map((name) => extent(data.error_curves, name));
  const role = (name) => (name === law ? "controlled" : "not controlled");
  return compose(
    `Errors of directions and edges under the law of ${law}`,
    [
      {
        title: `Directions (${role("directions")})`,
        drawing: curvesPanel(moments, "directions_mrad", "u × u*, mrad", directions),
      },
      {
        title: `Edges (${role("edges")})`,
        drawing: curvesPanel(moments, "edges_px", "offset at the goal's ends, px", edges),
      },
    ],
    LEGS.map((color, leg) => [color, `leg ${leg + 1}`]),
  );
}

// ---- Figure 8.

function normsPanel(error_curves, name, y) {
  const lines = [
    [error_curves.directions, DIRECTIONS, undefined],
    [error_curves.edges, EDGES, "2 2"],
  ];
  return plot({
    width: 470,
    height: 300,
    marginLeft: 55,
    marginBottom: 40,
    x: { label: "time, s" },
    y: { grid: true, ...y },
    marks: lines.map(([moments, stroke, strokeDasharray]) =>
      Plot.line(moments, { x: "time_s", y: name, stroke, strokeWidth: 1.6, strokeDasharray }),
    ),
  });
}

const LOG_PX = { label: "rms, px (logarithmic)", type: "log", ticks: 6, tickFormat: "~g" };

function figure8({ error_curves }) {
  return compose(
    "Root mean square of the errors under both laws",
    [
      { title: "Directions", drawing: normsPanel(error_curves, "direction_rms_mrad", { label: "rms, mrad", zero: true }) },
      { title: "Edges", drawing: normsPanel(error_curves, "edge_rms_px", LOG_PX) },
    ],
    [
      [DIRECTIONS, "under the law of directions"],
      [EDGES, "under the law of edges", "2 2"],
    ],
  );
}

// By the names of their files.
export const andreffFigures = (data) => ({
  "andreff-figure-5": figure5(data),
  "andreff-figure-6": errorsFigure("directions", data),
  "andreff-figure-7": errorsFigure("edges", data),
  "andreff-figure-8": figure8(data),
});
