// The drawing over one picture: corners by what became of them, their residuals enlarged.
import { svg } from "../shared/dom.js";
import { isNumber, significant } from "../shared/format.js";
import { symbol } from "../shared/picture_symbols.js";
import { FATE, cornersOf, lengthOf } from "./observations.js";

export function overlay(view, factor) {
  const corners = cornersOf(view);
  return svg(
    "g",
    null,
    corners.map((corner) => whisker(corner, factor)),
    corners.map(mark),
    (view.left_out_corners ?? []).map((corner) =>
      symbol(corner, "square", "left-out-corner", leftOutTitle(corner)),
    ),
  );
}

export const leftOutTitle = ({ what, why }) =>
  [what, `left out: ${why ?? "no reason given"}`].filter(Boolean).join("\n");

function whisker({ x, y, dx, dy, fate }, factor) {
  if (fate !== FATE.whole && fate !== FATE.weighedDown) return null;
  return svg("path", {
    class: `whisker ${fate}`,
    d: `M${x},${y}l${(dx * factor).toFixed(2)},${(dy * factor).toFixed(2)}`,
  });
}

function titleOf(corner) {
  const { dx, dy, weight, fate } = corner;
  if (fate === FATE.unused) return "took no part";
  const residual = `residual ${significant(lengthOf(corner))} px (${significant(dx)}, ${significant(dy)})`;
  if (fate === FATE.outlier) return `left out as an outlier: 6 σ off or more\n${residual}`;
  return `${residual}\nweight ${significant(weight, 2)}`;
}

// Strokes keep their width on the screen, so a dot is a stroke of no length.
function mark(corner) {
  const { x, y, fate } = corner;
  if (!isNumber(x) || !isNumber(y)) return null;
  if (fate === FATE.outlier) return symbol(corner, "cross", "outlier", titleOf(corner));
  if (fate === FATE.weighedDown) return symbol(corner, "diamond", "weighed-down-corner", titleOf(corner));
  const dot = `M${x},${y}h0`;
  return svg(
    "g",
    null,
    svg("path", { class: "halo", d: dot }),
    svg("path", { class: `found ${fate}`, d: dot }, svg("title", null, titleOf(corner))),
  );
}
