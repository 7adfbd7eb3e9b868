// What the viewer says about one image: caption, alternative text, table of its edges.
import { html, muted, table } from "../shared/dom.js";
import { MISSING, fixed, plural, sentence, significant, withUnit } from "../shared/format.js";
import { edgesOf, isOutlier, namedSample } from "./observations.js";

const foundCount = (image) => edgesOf(image).filter((edge) => !edge.left_out).length;

// What the picture shows, for those who cannot see it.
export function altText(image) {
  const { name, left_out: leftOut } = image;
  return `Picture ${name} with ${plural(foundCount(image), "found edge")}${leftOut ? `; left out: ${leftOut}` : ""}`;
}

// What stands above the picture.
export function captionOf(image) {
  const { name, left_out: leftOut, rms_px: rms, held_out_rms_px: heldOut } = image;
  const pixels = (value) => withUnit(significant(value), "px");
  const used =
    ` ${foundCount(image)} of ${plural(edgesOf(image).length, "edge")} used; ` +
    `rms ${pixels(rms)} in the fit, ${pixels(heldOut)} held out.`;
  return [html("strong", null, name), leftOut ? ` Left out: ${sentence(leftOut)}` : used];
}

export function edgeTable(image) {
  const columns = [
    { label: "Edge", text: true, cell: ({ leg, edge }) => `Leg ${leg}, edge ${edge}` },
    { label: "Points", cell: ({ samples }) => samples?.length ?? MISSING },
    {
      label: "Outliers",
      cell: ({ samples }) => (samples ? samples.map(namedSample).filter(isOutlier).length : MISSING),
    },
    { label: "rms", unit: "px", cell: ({ rms_px: rms }) => fixed(rms, 3) },
    { label: "Mean", unit: "px", cell: ({ shift_px: shift }) => fixed(shift, 3) },
    { label: "Blur", unit: "px", cell: ({ blur_px: blur }) => fixed(blur, 2) },
    { label: "Left out because", text: true, cell: ({ left_out: reason }) => reason ?? "" },
  ];
  const edges = edgesOf(image);
  return edges.length
    ? table(`Edges of ${image.name}`, columns, [{ rows: edges }])
    : muted("No edges in this image.");
}
