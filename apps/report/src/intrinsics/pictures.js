// The pictures of the views, or empty frames where there are none, with the corners in them.
import { append, definitions, html, muted, svg } from "../shared/dom.js";
import { isNumber, plural, sentence, significant, withUnit } from "../shared/format.js";
import { PictureViewer, VIEWER_HINT } from "../shared/picture_viewer.js";
import { magnitudeQuantile } from "../shared/statistics.js";
import { factorFor } from "./image_plot.js";
import {
  FATE,
  cornersOf,
  countOf,
  extentOf,
  imageSize,
  lengthOf,
  usedCorners,
  viewsOf,
} from "./observations.js";
import { overlay } from "./overlay.js";
import { distanceText } from "./quantities.js";

const WHISKER_SHARE = 0.02; // of the image's width, for long residuals

export const hasPictures = (data) => viewsOf(data).length > 0;

export function renderPictures(section, data) {
  const views = viewsOf(data);
  if (!views.some(({ picture }) => picture))
    append(
      section,
      muted("The corners came from a file, so there are no pictures: they are drawn on an empty frame."),
    );
  const residuals = usedCorners(data).map(lengthOf);
  const first = factorFor([magnitudeQuantile(residuals, 0.95), WHISKER_SHARE * imageSize(data).width]);
  new PictureViewer(views, {
    nouns: { one: "view", many: "views", order: "in the order of the files" },
    errorOf: ({ rms_px: rms }) => rms,
    sizeOf,
    describe,
    captionOf,
    detailsOf,
    overlay,
    factor: residuals.length > 0 ? { first, largest: 5 * first, step: first / 4 } : null,
    toggles: [
      ["Corners", "hide-found"],
      ["Left out", "hide-left-out"],
    ],
    legend: legend(residuals.length > 0),
  }).showIn(section);
}

const sizeOf = (view) => (view.width > 0 && view.height > 0 ? view : extentOf([view]));

function countsText(view) {
  const corners = cornersOf(view);
  const used = countOf(corners, FATE.whole) + countOf(corners, FATE.weighedDown);
  const others = [
    [countOf(corners, FATE.weighedDown), "weighed down"],
    [countOf(corners, FATE.outlier), "left out as outliers"],
    [view.left_out_corners?.length ?? 0, "left out before"],
  ].filter(([count]) => count > 0);
  const rest = others.map(([count, what]) => `, ${count} ${what}`).join("");
  const tookPart = corners.some(({ fate }) => fate !== FATE.unused);
  return (tookPart ? `${plural(used, "corner")} used` : `${plural(corners.length, "corner")} found`) + rest;
}

// What the picture shows, for those who cannot see it.
const describe = (view) => `View ${view.name}: ${countsText(view)}`;

function captionOf(view) {
  const rms = isNumber(view.rms_px) ? `; rms ${withUnit(significant(view.rms_px), "px")}` : "";
  return [
    html("strong", null, view.name),
    view.left_out ? ` Left out: ${sentence(view.left_out)} ` : " ",
    `${countsText(view)}${rms}.`,
  ];
}

function detailsOf(view) {
  const degrees = (angle) => withUnit(significant((180 / Math.PI) * angle), "°");
  const entries = [
    ["Distance of the board", isNumber(view.distance_m) && distanceText(view.distance_m)],
    ["Tilt of the board", isNumber(view.tilt_rad) && degrees(view.tilt_rad)],
    ["Not used", view.unused?.length > 0 && view.unused.map((text) => html("div", null, sentence(text)))],
  ].filter(([, value]) => value);
  return definitions(entries, "list");
}

const swatch = (...marks) =>
  svg("svg", { width: 26, height: 16, class: "on-picture", "aria-hidden": "true" }, marks);

const residualKey = () => [
  html(
    "span",
    null,
    swatch(
      svg("path", { class: "found whole", d: "M6,8h0" }),
      svg("path", { class: "whisker whole", d: "M6,8L24,5" }),
    ),
    "corner with its residual, enlarged",
  ),
  html(
    "span",
    null,
    swatch(svg("path", { class: "weighed-down-corner", d: "M13,2L19,8L13,14L7,8Z" })),
    "weighed down",
  ),
  html(
    "span",
    null,
    swatch(svg("path", { class: "outlier", d: "M9,4L17,12M9,12L17,4" })),
    "outlier, left out",
  ),
];

const legend = (hasResiduals) =>
  html(
    "div",
    { class: "legend" },
    html(
      "p",
      { class: "key" },
      hasResiduals
        ? residualKey()
        : html("span", null, swatch(svg("path", { class: "found unused", d: "M13,8h0" })), "corner"),
      html(
        "span",
        null,
        swatch(svg("path", { class: "left-out-corner", d: "M8,3H18V13H8Z" })),
        "left out before; point at it for the reason",
      ),
    ),
    muted(VIEWER_HINT),
  );
