// Residuals by image, by leg and edge, and along the legs.
import * as Plot from "@observablehq/plot";
import { append, figure, html, muted } from "../shared/dom.js";
import { isNumber, significant, withUnit } from "../shared/format.js";
import { nameAxis } from "../shared/name_axis.js";
import { showPicture } from "../shared/picture_links.js";
import { COLOR, TIP, asOnePath, key, plot, responsive } from "../shared/plots.js";
import { thinned } from "../shared/statistics.js";
import {
  OUTLIER_WEIGHT,
  imagesOf,
  isOutlier,
  meanAlong,
  residualLimit,
  usedEdges,
  usedSamples,
} from "./observations.js";

const DRAWN_DOTS = 12000;
const LEGS = [1, 2, 3, 4, 5, 6];
const EDGES = [1, 2];
const EDGE_COLOR = { 1: COLOR.first, 2: COLOR.second };

export function renderResiduals(section, data) {
  const edges = usedEdges(data);
  const samples = usedSamples(edges);
  append(
    section,
    muted(
      "A residual is the distance of a found edge point from the edge that the calibrated model predicts, " +
        "in pixels, positive outward from the leg.",
    ),
    html("h3", null, "By image"),
    byImage(data),
    html("h3", null, "By leg and edge"),
    samples.length ? byEdge(edges, samples) : nothing(),
    html("h3", null, "Along the legs"),
    samples.length ? alongLegs(samples) : nothing(),
  );
}

const nothing = () => muted("No residuals: no edges took part.");

function byImage(data) {
  const images = imagesOf(data);
  if (images.length === 0) return muted("No images.");
  return figure(
    "Root mean square of the residuals of each image. Click a point to see its picture.",
    key([
      ["dot", COLOR.first, "in the fit"],
      ["diamond", COLOR.second, "the same image held out of the fit"],
      ["cross", COLOR.muted, "left out"],
      ["dashes", COLOR.muted, "all images of the fit"],
    ]),
    responsive((width) => imagePlot(images, data.calibration?.rms_px, width)),
  );
}

function imagePlot(images, rms, width) {
  const fitted = images.filter(({ rms_px: value }) => isNumber(value));
  const heldOut = images.filter(({ held_out_rms_px: value }) => isNumber(value));
  const both = fitted.filter(({ held_out_rms_px: value }) => isNumber(value));
  const drawing = plot("Residual rms of each image, in the fit and held out", {
    width,
    height: 260,
    marginLeft: 52,
    marginBottom: 56,
    marginTop: 26,
    x: {
      ...nameAxis(
        images.map(({ name }) => name),
        width,
      ),
      label: null,
    },
    y: { label: "rms, px", zero: true, grid: true, nice: true, labelArrow: false },
    marks: [
      isNumber(rms) ? Plot.ruleY([rms], { stroke: COLOR.muted, strokeDasharray: "4 3" }) : null,
      Plot.link(both, {
        x: "name",
        y1: "rms_px",
        y2: "held_out_rms_px",
        stroke: COLOR.rule,
        strokeWidth: 1.5,
      }),
      Plot.dot(fitted, { x: "name", y: "rms_px", fill: COLOR.first, r: 3.5 }),
      Plot.dot(heldOut, { x: "name", y: "held_out_rms_px", stroke: COLOR.second, symbol: "diamond", r: 3.5 }),
      Plot.dot(
        images.filter((image) => image.left_out),
        { x: "name", y: 0, stroke: COLOR.muted, symbol: "times" },
      ),
      Plot.tip(
        images,
        Plot.pointerX({
          x: "name",
          y: (image) => image.rms_px ?? image.held_out_rms_px ?? 0,
          title: imageTip,
          ...TIP,
        }),
      ),
    ],
  });
  drawing.addEventListener("click", () => drawing.value && showPicture(drawing.value.name));
  drawing.classList.add("clickable");
  return drawing;
}

function imageTip({ name, rms_px: rms, held_out_rms_px: heldOut, left_out: leftOut }) {
  const pixels = (value) => withUnit(significant(value), "px");
  return leftOut
    ? `${name}\nleft out: ${leftOut}`
    : `${name}\nin the fit ${pixels(rms)}\nheld out ${pixels(heldOut)}`;
}

function byEdge(edges, samples) {
  return figure(
    "Boxes: the middle half of all points, with the median; whiskers reach the last point within 1.5 box " +
      "lengths. Short lines beside them: the mean of that edge in each image. Means that stray more than the points " +
      "would explain, or sit together off zero, are shading rather than noise.",
    responsive((width) => edgePlot(edges, samples, width)),
  );
}

function edgePlot(edges, samples, width) {
  const limit = residualLimit(samples);
  return plot("Distribution of the residuals of each leg and edge", {
    width,
    height: 290,
    marginLeft: 52,
    marginTop: 32,
    marginBottom: 40,
    fx: { label: "leg", domain: LEGS, padding: 0.08, tickFormat: "d" },
    x: { label: "edge", domain: EDGES, tickFormat: "d", padding: 0.25 },
    y: { label: "residual, px", domain: [-limit, limit], grid: true, labelArrow: false, clamp: true },
    color: { type: "identity" },
    marks: [
      Plot.ruleY([0], { stroke: COLOR.muted }),
      Plot.boxY(samples, {
        fx: "leg",
        x: "edge",
        y: "residual",
        fill: (d) => EDGE_COLOR[d.edge],
        stroke: COLOR.text,
        fillOpacity: 0.45,
        insetRight: Math.max(6, width / 60),
        r: 0,
        strokeOpacity: 0.85,
      }),
      Plot.tickY(edges, {
        fx: "leg",
        x: "edge",
        y: "shift_px",
        stroke: (d) => EDGE_COLOR[d.edge],
        strokeOpacity: 0.8,
        insetLeft: Math.max(12, width / 32),
      }),
    ],
  });
}

function alongLegs(samples) {
  const limit = residualLimit(samples);
  const shown = samples.filter(({ residual }) => Math.abs(residual) <= limit);
  const dots = thinned(shown, DRAWN_DOTS);
  return figure(
    alongCaption(samples, shown, dots, limit),
    key([
      ["dot", COLOR.muted, "found points"],
      ["line", COLOR.first, "mean, edge 1"],
      ["line", COLOR.second, "mean, edge 2"],
    ]),
    responsive((width) => alongPlot(dots, meansAlong(samples), limit, width)),
  );
}

function alongCaption(samples, shown, dots, limit) {
  const outside = samples.length - shown.length;
  return (
    "Residual against the place along the leg (0 at the base joint, 1 at the platform joint). A mean that " +
    "bends away from zero shows shading, or a leg that is not straight." +
    (outside
      ? ` ${outside} of ${samples.length} points lie beyond ± ${significant(limit, 2)} px and are not drawn.`
      : "") +
    (dots.length < shown.length ? ` Of the others, ${dots.length} are drawn.` : "") +
    ` Points with a weight below ${OUTLIER_WEIGHT} do not enter the mean.`
  );
}

function meansAlong(samples) {
  const inliers = samples.filter((sample) => !isOutlier(sample));
  return LEGS.flatMap((leg) =>
    EDGES.flatMap((edge) =>
      meanAlong(inliers.filter((sample) => sample.leg === leg && sample.edge === edge)).map((point) => ({
        leg,
        edge,
        ...point,
      })),
    ),
  );
}

function alongPlot(dots, means, limit, width) {
  return plot("Residual along each leg, with its running mean", {
    width,
    height: 350,
    marginLeft: 52,
    marginRight: 56,
    marginTop: 32,
    marginBottom: 42,
    fx: { label: "leg", domain: LEGS, tickFormat: "d", padding: 0.12 },
    fy: { label: null, domain: EDGES, tickFormat: (edge) => `edge ${edge}`, padding: 0.12 },
    x: {
      label: "place along the leg",
      domain: [0, 1],
      ticks: [0, 0.5, 1],
      tickFormat: "~g",
      labelArrow: false,
      labelAnchor: "center",
    },
    y: { label: "residual, px", domain: [-limit, limit], ticks: 4, grid: true, labelArrow: false },
    color: { type: "identity" },
    marks: [
      Plot.dot(dots, { fx: "leg", fy: "edge", x: "place", y: "residual", render: asOnePath(1.1) }),
      Plot.ruleY([0], { stroke: COLOR.muted }),
      Plot.line(means, {
        fx: "leg",
        fy: "edge",
        x: "place",
        y: "mean",
        z: null,
        stroke: (d) => EDGE_COLOR[d.edge],
        strokeWidth: 2.25,
      }),
    ],
  });
}
