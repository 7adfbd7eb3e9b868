// Residuals: what became of the corners, over the image, by view, and how they are distributed.
import * as Plot from "@observablehq/plot";
import { append, figure, html, muted, table } from "../shared/dom.js";
import { fixed, isNumber, significant, withUnit } from "../shared/format.js";
import { nameAxis } from "../shared/name_axis.js";
import { showPicture } from "../shared/picture_links.js";
import { COLOR, TIP, key, plot, responsive } from "../shared/plots.js";
import { renderDistribution } from "./distribution.js";
import { FATE, countOf, usedCorners, viewsOf } from "./observations.js";
import { residualField } from "./residual_field.js";

export const hasResiduals = (data) => usedCorners(data).length > 0;

export function renderResiduals(section, data) {
  const corners = usedCorners(data);
  append(
    section,
    muted("A residual is where the calibrated camera has a corner less where it was found, in pixels."),
    fates(data, corners),
    html("h3", null, "Over the image"),
    residualField(data, corners),
    html("h3", null, "By view"),
    byView(data),
    html("h3", null, "Distribution"),
    renderDistribution(data, corners),
  );
}

const MEANING = {
  [FATE.whole]: ["count whole", "less than 3 σ from where the camera has them"],
  [FATE.weighedDown]: ["weighed down", "3 to 6 σ off: the farther, the less they count"],
  [FATE.outlier]: [
    "left out as outliers",
    "6 σ off and more: found in a wrong place, or the board is bent there",
  ],
};

function fates(data, corners) {
  const before = viewsOf(data).flatMap(({ left_out_corners: leftOut }) => leftOut ?? []).length;
  const rows = Object.entries(MEANING).map(([fate, [name, why]]) => ({
    name,
    why,
    count: countOf(corners, fate),
  }));
  const others = { name: "left out before", why: "see “What was left out”", count: before };
  const total = corners.length + before;
  return table(
    "What became of the corners",
    [
      { label: "Corners", text: true, cell: ({ name }) => name },
      { label: "Number", cell: ({ count }) => count },
      { label: "Share", cell: ({ count }) => withUnit(fixed((100 * count) / total, 2), "%") },
      { label: "Why", text: true, cell: ({ why }) => why },
    ],
    [{ rows: before ? [...rows, others] : rows }],
  );
}

function byView(data) {
  const views = viewsOf(data);
  const leftOut = views.some((view) => view.left_out);
  return figure(
    "Root mean square of the corners' distances in each view. Click a bar to see its picture.",
    key([
      ["line", COLOR.first, "in the fit"],
      ...(leftOut ? [["cross", COLOR.muted, "left out"]] : []),
      ["dashes", COLOR.muted, "all views of the fit"],
    ]),
    responsive((width) => viewPlot(views, data.intrinsics?.rms_px, width)),
  );
}

function viewPlot(views, rms, width) {
  const names = views.map(({ name }) => name);
  const axis = nameAxis(names, width, "band");
  const drawing = plot("Root mean square of the residuals of each view", {
    width,
    height: 250,
    marginLeft: 52,
    marginBottom: 74,
    marginTop: 26,
    x: { ...axis, label: null, padding: names.length > 60 ? 0.1 : 0.25 },
    y: { label: "rms, px", zero: true, grid: true, nice: true, labelArrow: false },
    marks: [
      Plot.barY(
        views.filter((view) => isNumber(view.rms_px)),
        { x: "name", y: "rms_px", fill: COLOR.first },
      ),
      isNumber(rms) ? Plot.ruleY([rms], { stroke: COLOR.muted, strokeDasharray: "4 3" }) : null,
      Plot.dot(
        views.filter((view) => view.left_out),
        { x: "name", y: 0, dy: -6, stroke: COLOR.muted, symbol: "times" },
      ),
      Plot.tip(
        views,
        Plot.pointerX({ x: "name", y: ({ rms_px: value }) => value ?? 0, title: viewTip, ...TIP }),
      ),
    ],
  });
  drawing.addEventListener("click", () => drawing.value && showPicture(drawing.value.name));
  drawing.classList.add("clickable");
  return drawing;
}

const viewTip = ({ name, rms_px: rms, left_out: leftOut, corners }) =>
  leftOut
    ? `${name}\nleft out: ${leftOut}`
    : `${name}\n${withUnit(significant(rms), "px")}, ${(corners ?? []).length} corners`;
