// The verdict in plain words, and the key figures.
import { append, definitions } from "../shared/dom.js";
import { MISSING, fixed, isNumber, plusMinus, significant, withUnit } from "../shared/format.js";
import { verdictBox } from "../shared/verdict_box.js";
import { judge } from "./judgement.js";

export function renderVerdict(section, data) {
  const { open, warnings, advice, ...judgement } = judge(data);
  const lists = [
    ["What cannot be determined", open],
    ["Look at", warnings],
    ["What to do", advice],
  ];
  append(
    section,
    verdictBox({ ...judgement, lists }),
    definitions(keyFigures(data.calibration ?? {}), "figures"),
  );
}

function keyFigures(calibration) {
  const { rms_px: fit, held_out: heldOut, edge_sigma_px: noise, camera, legs, time_s: time } = calibration;
  return [
    ["Residual of the fit", pixels(fit), "root mean square, distance from the predicted edge"],
    ["Held-out images", pixels(heldOut?.rms_px), "the same, in images that took no part in the fit"],
    ["Noise of one edge point", pixels(noise), "standard deviation, from the residuals"],
    ["Images used", usedOf(calibration.images_used, calibration.images_left_out?.length)],
    ["Edges used", calibration.edges_used ?? MISSING],
    ["Focal length fx", plusMinus(camera?.fx, camera?.sigma?.fx, "px")],
    ["Base joints", largestSigma(legs, "base_joint_m", "mm", 1e3), "largest σ of a coordinate, base frame"],
    ["Platform joints", largestSigma(legs, "platform_joint_m", "mm", 1e3), "largest σ of a coordinate"],
    ["Radii", largestSigma(legs, "radius_m", "µm", 1e6), "largest σ"],
    ["Joint offsets", largestSigma(legs, "joint_offset_m", "µm", 1e6), "largest σ"],
    ["Time", withUnit(fixed(time?.total, 1), "s"), "files to result"],
  ];
}

const pixels = (value) => withUnit(significant(value), "px");
const usedOf = (used, leftOut) => (isNumber(used) ? `${used} of ${used + (leftOut ?? 0)}` : MISSING);

function largestSigma(legs, field, unit, scale) {
  const sigmas = (legs ?? []).flatMap((leg) => leg?.sigma?.[field] ?? []).filter(isNumber);
  return sigmas.length ? withUnit(significant(Math.max(...sigmas) * scale, 2), unit) : MISSING;
}
