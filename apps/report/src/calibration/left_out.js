// Images and edges that did not take part, with the reasons.
import { append, muted, table } from "../shared/dom.js";
import { plural, sentence } from "../shared/format.js";
import { pictureLink, pictureLinks } from "../shared/picture_links.js";
import { groupedByReason } from "../shared/reasons.js";
import { leftOutEdges } from "./observations.js";

export function renderLeftOut(section, data) {
  const images = data.calibration?.images_left_out ?? [];
  const edges = leftOutEdges(data);
  if (images.length === 0 && edges.length === 0)
    append(section, muted("Nothing: every image and every edge took part."));
  if (images.length > 0) append(section, imageTable(images));
  if (edges.length > 0) append(section, edgeTable(edges));
}

function imageTable(images) {
  return table(
    "Images left out",
    [
      { label: "Image", text: true, cell: ({ name }) => pictureLink(name) },
      { label: "Reason", text: true, cell: ({ reason }) => sentence(reason) },
    ],
    [{ rows: images }],
  );
}

function edgeTable(edges) {
  const groups = groupedByReason(edges).map(({ reason, members }) => ({
    label: `${sentence(reason).replace(/\.$/, "")}: ${plural(members.length, "edge")}`,
    rows: byLegAndEdge(members),
  }));
  return table(
    "Edges left out, by reason",
    [
      { label: "Edge", text: true, cell: ({ leg, edge }) => `Leg ${leg}, edge ${edge}` },
      { label: "Times", cell: ({ images }) => images.length },
      { label: "Images", text: true, cell: ({ images }) => pictureLinks(images) },
    ],
    groups,
  );
}

function byLegAndEdge(edges) {
  const rows = new Map();
  for (const { leg, edge, image } of edges) {
    const id = leg * 2 + edge;
    if (!rows.has(id)) rows.set(id, { leg, edge, images: [] });
    rows.get(id).images.push(image);
  }
  return [...rows].sort(([a], [b]) => a - b).map(([, row]) => row);
}
