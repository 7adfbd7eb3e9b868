// How the board was tilted, view by view, around the direction to its far side.
import * as Plot from "@observablehq/plot";
import { max } from "d3";
import { figure } from "../shared/dom.js";
import { isNumber, significant } from "../shared/format.js";
import { showPicture } from "../shared/picture_links.js";
import { COLOR, TIP, key, plot, responsive } from "../shared/plots.js";
import { usedViews } from "./observations.js";
import { distanceText } from "./quantities.js";

const WIDEST = 430;
const RING_DEGREES = 15;
const RING_POINTS = 91;
const ROOM = 1.16; // beyond the outermost ring, for the words

const isTilted = ({ tilt_rad: tilt, tilt_direction_rad: direction }) => isNumber(tilt) && isNumber(direction);
const degrees = (angle) => (180 / Math.PI) * angle;

export const hasTilts = (data) => usedViews(data).some(isTilted);

// Where a tilt stands in the plot (degrees): to the side of the board that is farther away, y down.
export const tiltPoint = ({ tilt_rad: tilt, tilt_direction_rad: direction }) => ({
  x: degrees(tilt) * Math.cos(direction),
  y: degrees(tilt) * Math.sin(direction),
});

export function tiltPlot(data) {
  const views = usedViews(data)
    .filter(isTilted)
    .map((view) => ({ ...view, ...tiltPoint(view) }));
  const next = data.intrinsics?.next_view;
  const proposed = next && isTilted(next) ? [{ ...tiltPoint(next), ...next }] : [];
  return figure(
    "Tilts of the board: how far from parallel to the image (rings), and which of its sides was farther away. Views on all " +
      "sides and at 30° and more tell focal length and principal point. Click a point to see its picture.",
    key([
      ["dot", COLOR.first, "view"],
      ...(proposed.length ? [["diamond", COLOR.second, "the view to add next"]] : []),
    ]),
    responsive((width) => polarPlot(views, proposed, Math.min(width, WIDEST))),
  );
}

function polarPlot(views, proposed, width) {
  const largest = max([...views, ...proposed], ({ tilt_rad: tilt }) => degrees(tilt)) ?? 0;
  const rings = Math.max(2, Math.ceil(largest / RING_DEGREES));
  const outermost = rings * RING_DEGREES;
  const domain = [-ROOM * outermost, ROOM * outermost];
  const scale = { domain, axis: null };
  const drawing = plot("Tilts of the board in the views, around the direction of its far side", {
    width,
    height: width,
    margin: 4,
    x: scale,
    y: { ...scale, reverse: true },
    marks: [
      ringLines(rings),
      Plot.ruleX([0], { y1: -outermost, y2: outermost, stroke: COLOR.rule }),
      Plot.ruleY([0], { x1: -outermost, x2: outermost, stroke: COLOR.rule }),
      ringNumbers(rings),
      sides(outermost),
      Plot.dot(views, {
        x: "x",
        y: "y",
        fill: COLOR.first,
        r: views.length > 60 ? 3 : 4.5,
        fillOpacity: 0.75,
      }),
      Plot.dot(proposed, { x: "x", y: "y", symbol: "diamond", stroke: COLOR.second, strokeWidth: 2.5, r: 6 }),
      Plot.tip(views, Plot.pointer({ x: "x", y: "y", title: viewTitle, maxRadius: 20, ...TIP })),
    ],
  });
  drawing.addEventListener("click", () => drawing.value && showPicture(drawing.value.name));
  drawing.classList.add("clickable");
  return drawing;
}

const ringRadii = (rings) => Array.from({ length: rings }, (_, index) => (index + 1) * RING_DEGREES);

function ringLines(rings) {
  const points = ringRadii(rings).flatMap((radius) =>
    Array.from({ length: RING_POINTS }, (_, index) => {
      const angle = (2 * Math.PI * index) / (RING_POINTS - 1);
      return { ring: radius, x: radius * Math.cos(angle), y: radius * Math.sin(angle) };
    }),
  );
  return Plot.line(points, { x: "x", y: "y", z: "ring", stroke: COLOR.rule });
}

const ringNumbers = (rings) =>
  Plot.text(ringRadii(rings), {
    x: (radius) => radius * Math.SQRT1_2,
    y: (radius) => -radius * Math.SQRT1_2,
    text: (radius) => `${radius}°`,
    fill: COLOR.muted,
    stroke: COLOR.page,
    strokeWidth: 3,
    fontSize: 11,
  });

const sides = (outermost) =>
  Plot.text(
    [
      { x: 1, y: 0, text: "right", rotate: 90 },
      { x: -1, y: 0, text: "left", rotate: -90 },
      { x: 0, y: -1, text: "upper side farther", rotate: 0 },
      { x: 0, y: 1, text: "lower", rotate: 0 },
    ],
    {
      x: ({ x }) => 1.08 * x * outermost,
      y: ({ y }) => 1.08 * y * outermost,
      text: "text",
      rotate: "rotate",
      fill: COLOR.text,
    },
  );

const viewTitle = ({ name, tilt_rad: tilt, distance_m: distance }) =>
  `${name}\ntilted by ${significant(degrees(tilt))}°${isNumber(distance) ? `, ${distanceText(distance)} away` : ""}`;
