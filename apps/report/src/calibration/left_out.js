// Images and edges that did not take part, with the reasons.
import { append, html, muted, table } from "../shared/dom.js";
import { plural, sentence } from "../shared/format.js";
import { leftOutEdges } from "./observations.js";
import { pictureLink } from "./picture_links.js";

const LINKS_SHOWN = 12;

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
      { label: "Images", text: true, cell: ({ images }) => links(images) },
    ],
    groups,
  );
}

// Reasons that differ only in their numbers belong together; their numbers are then shown as "…".
export function groupedByReason(edges) {
  const groups = new Map();
  for (const edge of edges) {
    const pattern = edge.reason.replace(/[-+]?\d+(\.\d+)?/g, "…");
    groups.set(pattern, [...(groups.get(pattern) ?? []), edge]);
  }
  return [...groups]
    .map(([pattern, members]) => {
      const same = members.every(({ reason }) => reason === members[0].reason);
      return { reason: same ? members[0].reason : pattern, members };
    })
    .sort((a, b) => b.members.length - a.members.length);
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

function links(names) {
  const separated = (some) => some.flatMap((name, index) => [index ? " " : "", pictureLink(name)]);
  const rest = names.slice(LINKS_SHOWN);
  return html(
    "span",
    { class: "links" },
    separated(names.slice(0, LINKS_SHOWN)),
    rest.length > 0 &&
      html("details", null, html("summary", null, `and ${rest.length} more`), separated(rest)),
  );
}
