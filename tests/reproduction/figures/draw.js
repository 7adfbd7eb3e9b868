// Figures 5 to 8 of Andreff, Dallej and Martinet 2007 from the data that section_4 wrote, as SVG files that stand by
// themselves: on white, for pages light and dark. Runs in a browser.
import * as Plot from "@observablehq/plot";

const TEXT = "#24292f";
const MUTED = "#6e7781";
const DIRECTIONS = "#4269d0";
const EDGES = "#d1495b";
const LEGS = ["#4269d0", "#e39d00", "#ff725c", "#3ba5a0", "#3ca951", "#a463f2"];
const FONT = "system-ui, -apple-system, 'Segoe UI', Helvetica, Arial, sans-serif";
const SHOWN_EVERY = 3; // cycles: 60 ms

const svgNode = (name, attributes, ...children) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
};

const plot = (options) =>
  Plot.plot({
    ...options,
    style: { background: "none", color: TEXT, fontSize: "12px", fontFamily: FONT, overflow: "visible" },
  });

const titleText = (title, x, y) =>
  svgNode("text", { x, y, fill: TEXT, "font-family": FONT, "font-size": 14, "font-weight": 600 }, title);

// Entries [colour, label, dashes] in a row.
function legend(entries, x, y) {
  const group = svgNode("g", { "font-family": FONT, "font-size": 12, fill: TEXT });
  let at = x;
  for (const [color, label, dashes] of entries) {
    const line = { x1: at, x2: at + 22, y1: y - 4, y2: y - 4, stroke: color, "stroke-width": 2 };
    group.append(svgNode("line", dashes ? { ...line, "stroke-dasharray": dashes } : line));
    group.append(svgNode("text", { x: at + 28, y }, label));
    at += 28 + 7 * label.length + 22;
  }
  return group;
}

// Panels [{title, drawing}] side by side on white, under a legend.
function compose(description, panels, entries) {
  const top = entries ? 34 : 8;
  const heads = 24;
  const widths = panels.map(({ drawing }) => +drawing.getAttribute("width"));
  const height = Math.max(...panels.map(({ drawing }) => +drawing.getAttribute("height"))) + top + heads + 8;
  const width = widths.reduce((sum, each) => sum + each, 0) + 20 * (panels.length + 1);
  const sheet = svgNode("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
  sheet.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  sheet.append(svgNode("title", {}, description));
  sheet.append(svgNode("rect", { width, height, fill: "white", rx: 6 }));
  if (entries) sheet.append(legend(entries, 30, 26));
  let x = 20;
  panels.forEach(({ title, drawing }, i) => {
    sheet.append(titleText(title, x + 10, top + 18));
    drawing.setAttribute("x", x);
    drawing.setAttribute("y", top + heads);
    sheet.append(drawing);
    x += widths[i] + 20;
  });
  return new XMLSerializer().serializeToString(sheet);
}

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
window.drawFigures = (data) => ({
  "andreff-figure-5": figure5(data),
  "andreff-figure-6": errorsFigure("directions", data),
  "andreff-figure-7": errorsFigure("edges", data),
  "andreff-figure-8": figure8(data),
});
