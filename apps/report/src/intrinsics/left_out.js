// Views, corners and parts of the board that did not take part, with the reasons.
import { append, muted, table } from "../shared/dom.js";
import { sentence } from "../shared/format.js";
import { pictureLink, pictureLinks } from "../shared/picture_links.js";
import { groupedByReason } from "../shared/reasons.js";
import { FATE, cornersOf, usedViews, viewsOf } from "./observations.js";

const OUTLIER = "found 6 σ and more from where the camera has it: an outlier";

export function renderLeftOut(section, data) {
  const views = leftOutViews(data);
  const parts = leftOutParts(data);
  if (views.length === 0 && parts.length === 0)
    append(section, muted("Nothing: every view and every corner took part."));
  if (views.length > 0) append(section, viewTable(views, new Set(viewsOf(data).map(({ name }) => name))));
  if (parts.length > 0) append(section, partTable(parts));
}

// [{name, why}]: those of the document, and of the views that it does not name.
export function leftOutViews(data) {
  const named = data.intrinsics?.views_left_out ?? [];
  const known = new Set(named.map(({ name }) => name));
  const others = viewsOf(data).filter(({ name, left_out: why }) => why && !known.has(name));
  return [...named, ...others.map(({ name, left_out: why }) => ({ name, why }))];
}

// [{reason, view}] of corners and parts of the board: of views that took part, and what was found in the others.
export function leftOutParts(data) {
  const outliers = usedViews(data).flatMap((view) =>
    cornersOf(view)
      .filter(({ fate }) => fate === FATE.outlier)
      .map(() => ({ reason: OUTLIER, view: view.name })),
  );
  const others = viewsOf(data).flatMap((view) => [
    ...(view.left_out_corners ?? []).map(({ why }) => ({
      reason: why ?? "no reason given",
      view: view.name,
    })),
    ...(view.unused ?? []).map((reason) => ({ reason, view: view.name })),
  ]);
  return [...outliers, ...others];
}

const viewTable = (views, shown) =>
  table(
    "Views left out",
    [
      { label: "View", text: true, cell: ({ name }) => (shown.has(name) ? pictureLink(name) : name) },
      { label: "Reason", text: true, cell: ({ why }) => sentence(why) },
    ],
    [{ rows: views }],
  );

const partTable = (parts) =>
  table(
    "Corners and tags left out, by reason",
    [
      { label: "Reason", text: true, cell: ({ reason }) => sentence(reason) },
      { label: "Times", cell: ({ members }) => members.length },
      { label: "Views", text: true, cell: ({ members }) => pictureLinks(viewNames(members)) },
    ],
    [{ rows: groupedByReason(parts) }],
  );

const viewNames = (members) => [...new Set(members.map(({ view }) => view))];
