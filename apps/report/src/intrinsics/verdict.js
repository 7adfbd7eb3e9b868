// The verdict in plain words, and the key figures.
import { append, definitions } from "../shared/dom.js";
import { MISSING, isNumber, plusMinus } from "../shared/format.js";
import { verdictBox } from "../shared/verdict_box.js";
import { judge, uncertaintyAtBoard } from "./judgement.js";
import { distanceText, figureOf } from "./quantities.js";

export function renderVerdict(section, data) {
  const { warnings, advice, ...judgement } = judge(data);
  const lists = [
    ["Look at", warnings],
    [judgement.level === "bad" ? "What to do" : "What would make it better", advice],
  ];
  const figures = keyFigures(data);
  append(section, verdictBox({ ...judgement, lists }), figures.length > 0 && definitions(figures, "figures"));
}

function keyFigures(data) {
  const document = data.intrinsics ?? {};
  const figure = (path) => figureOf(document, path);
  const entries = [
    ["Residual", figure("rms_px"), "root mean square of the corners' distances"],
    ["Noise of one coordinate", figure("noise_px"), "σ, as the residuals show it"],
    ["Noise among neighbours", figure("neighbour_noise_px"), "σ, whatever the lens model"],
    ...uncertaintyFigures(data, figure),
    ["Focal length fx", focalLength(document.camera)],
    ["Views", figure("views_used"), leftOutNote(document)],
    ["Corners", figure("corners_used"), "that count"],
    ["Corners weighed down", figure("corners_weighed_down"), "3 to 6 σ off"],
    ["Corners left out", figure("corners_left_out"), "outliers, 6 σ off and more"],
    ["Difference of two halves", figure("cross_validation.ratio"), ratioNote(document, figure)],
    ["Cells of the image with corners", figure("coverage.share")],
    ["Largest tilt of the board", figure("coverage.largest_tilt_rad")],
  ];
  return entries.filter(([, value]) => value !== MISSING);
}

function uncertaintyFigures(data, figure) {
  const found = uncertaintyAtBoard(data);
  if (!found) return [];
  const where = `σ of a pixel, ${distanceText(found.distance_m)}${isNumber(found.distance_m) ? " away" : ""}`;
  return [
    ["Uncertainty over the image", figure(`uncertainty.${found.index}.rms_px`), `root mean square; ${where}`],
    ["Uncertainty at its worst", figure(`uncertainty.${found.index}.worst_px`), where],
  ];
}

const focalLength = (camera) => plusMinus(camera?.fx, camera?.sigma?.fx, "px");

const leftOutNote = ({ views_left_out: leftOut }) =>
  leftOut && (leftOut.length ? `${leftOut.length} more left out` : "none left out");

const ratioNote = (document, figure) =>
  isNumber(document.cross_validation?.ratio_limit)
    ? ["times what noise explains; a model that fits: up to ", figure("cross_validation.ratio_limit")]
    : null;
