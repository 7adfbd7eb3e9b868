// The pictures of the session: found points and predicted outlines over each.
import { append, html, muted } from "../shared/dom.js";
import { significant } from "../shared/format.js";
import { PictureViewer, VIEWER_HINT } from "../shared/picture_viewer.js";
import { magnitudeQuantile } from "../shared/statistics.js";
import { edgesOf, imagesOf, isOutlier, usedEdges, usedSamples } from "./observations.js";
import { overlay, residualColor } from "./overlay.js";
import { altText, captionOf, edgeTable } from "./picture_text.js";

export function renderPictures(section, data) {
  const images = imagesOf(data);
  if (images.length === 0) return append(section, muted("No images."));
  const limit = colorLimit(data);
  new PictureViewer(images, {
    nouns: { one: "image", many: "images", order: "in the order of the session" },
    errorOf: ({ rms_px: rms, held_out_rms_px: heldOut }) => rms ?? heldOut,
    sizeOf,
    describe: altText,
    captionOf,
    detailsOf: edgeTable,
    overlay: (image, factor) => overlay(image, { limit, factor }),
    factor: { first: 200, largest: 1000, step: 50 },
    toggles: [
      ["Points", "hide-found"],
      ["Outlines", "hide-predicted"],
    ],
    legend: legend(limit),
  }).showIn(section);
}

// The residual (px) of full colour: nineteen in twenty points stay below.
function colorLimit(data) {
  const residuals = usedSamples(usedEdges(data))
    .filter((sample) => !isOutlier(sample))
    .map(({ residual }) => residual);
  return Math.max(magnitudeQuantile(residuals, 0.95), 0.01);
}

function legend(limit) {
  const colors = [-1, -0.5, 0, 0.5, 1].map((share) => residualColor(share, 1));
  const bar = html("span", {
    class: "ramp",
    "aria-hidden": "true",
    style: `background:linear-gradient(to right,${colors.join(",")})`,
  });
  const end = significant(limit, 2);
  return html(
    "div",
    { class: "legend" },
    html(
      "p",
      null,
      `inward −${end} px `,
      bar,
      ` +${end} px outward. Whiskers: residuals, exaggerated. ` +
        "Crosses: outliers. Thin lines: predicted outlines; dashed: edge left out.",
    ),
    muted(VIEWER_HINT),
  );
}

// The extent of the data where the size of the image is not known.
function sizeOf(image) {
  if (image.width > 0 && image.height > 0) return image;
  const points = edgesOf(image).flatMap(({ predicted, samples }) => [
    ...(predicted ?? []),
    ...(samples ?? []),
  ]);
  return {
    width: Math.max(640, ...points.map(([x]) => x + 1)),
    height: Math.max(480, ...points.map(([, y]) => y + 1)),
  };
}
