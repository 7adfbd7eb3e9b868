// What a calibration of a camera amounts to in words: a level, a headline, sentences, and what to do. No page elements
// here.
import { isNumber, plural, sentence, significant } from "../shared/format.js";
import { boardDistance, nearestToBoard } from "./observations.js";
import { distanceText } from "./quantities.js";

const FAILURES = {
  too_few_views: {
    headline: "No camera: too few views",
    advice: [
      "Photograph the board from more places: twenty views are a good number, tilted to all sides, the board in every " +
        "corner of the image in turn.",
      "The section “What was left out” says why views could not be used.",
    ],
  },
  not_flat: {
    headline: "No camera: the corners are not where the board has them",
    advice: [
      "Compare the board file with the board: the number of rows and columns, the size of a tag, the spacing, which tag " +
        "is the first.",
      "Look at the pictures below: is it the same board in all of them, and is it flat?",
    ],
  },
  undetermined: {
    headline: "No camera: the views leave it open",
    advice: [
      "Tilt the board: by 30° and more, to the left, to the right, up and down, and let it reach into the corners of " +
        "the image. Views in which the board is parallel to the image tell nothing of the focal length.",
    ],
  },
  hopeless_guess: {
    headline: "No camera: the guess leads to another camera than the views do",
    advice: [
      "Leave the guess out: none is needed. Or check that it belongs to this lens, in pixels, and to images of this size.",
    ],
  },
  not_converged: {
    headline: "No camera: the estimate did not converge",
    advice: [
      "Look at the pictures below: are the corners on the board? Check that all images are from one camera with one " +
        "zoom and one focus.",
      "A lens model with fewer coefficients, or the fisheye model for a fisheye lens, may lead to a camera.",
    ],
  },
};
const UNKNOWN_FAILURE = { headline: "No camera: the calibration ended without a result", advice: [] };

const LENSES = {
  pinhole: "pinhole without distortion",
  "brown-conrady": "Brown-Conrady lens",
  rational: "rational lens",
  fisheye: "fisheye lens",
};
export const lensText = (lens) => LENSES[lens] ?? lens ?? "lens";

// By this factor residuals have to exceed what neighbouring corners show before the sentence says so.
const CLEARLY_LARGER = 1.25;

// {level: "good" | "care" | "bad", headline, sentences, warnings, advice}
export function judge(data) {
  const document = data.intrinsics ?? {};
  return document.status === "converged" ? success(data, document) : failure(document);
}

function success(data, document) {
  const validation = document.cross_validation ?? {};
  const misfit = validation.misfit === true;
  // What the cross-validation says has a sentence of its own.
  const said = sentence(validation.sentence);
  const warnings = warningsOf(document).filter((text) => text !== said);
  const good = !misfit && warnings.length === 0;
  return {
    level: good ? "good" : "care",
    headline: misfit
      ? "Camera found, but the lens model does not fit"
      : good
        ? "Camera found"
        : "Camera found, with something to look at",
    sentences: [whatWasFound(data), fit(document), uncertainty(data), crossValidation(validation)].filter(
      Boolean,
    ),
    warnings,
    advice: document.next_view?.sentence ? [sentence(document.next_view.sentence)] : [],
  };
}

function failure(document) {
  const { headline, advice } = FAILURES[document.status] ?? UNKNOWN_FAILURE;
  const next = document.next_view?.sentence ? [sentence(document.next_view.sentence)] : [];
  return {
    level: "bad",
    headline,
    sentences: [document.message].filter(Boolean).map(sentence),
    warnings: warningsOf(document),
    advice: [...advice, ...next],
  };
}

const warningsOf = ({ warnings }) => (warnings ?? []).map(sentence);

function whatWasFound({ title, intrinsics }) {
  const { camera, views_used: views, views_left_out: leftOut, corners_used: corners } = intrinsics;
  const without = leftOut?.length ? ` (${plural(leftOut.length, "view")} left out)` : "";
  const size =
    isNumber(camera?.width_px) && isNumber(camera?.height_px)
      ? `, ${camera.width_px} × ${camera.height_px} px`
      : "";
  return (
    `${title ?? "The camera"}: a ${lensText(camera?.lens)}${size}, from ${plural(corners, "corner")} in ` +
    `${plural(views, "view")}${without}.`
  );
}

function fit({ rms_px: rms, noise_px: noise, neighbour_noise_px: neighbours }) {
  if (!isNumber(rms)) return null;
  const spread = isNumber(noise)
    ? `; one coordinate of one corner scatters by σ = ${significant(noise)} px`
    : "";
  const text = `The camera reproduces the corners to ${significant(rms)} px (root mean square)${spread}.`;
  if (!isNumber(noise) || !(noise > CLEARLY_LARGER * neighbours)) return text;
  return (
    `${text} Against their neighbours alone they scatter by only ${significant(neighbours)} px: the rest is the lens ` +
    "model's or the board's."
  );
}

// The entry of the document's uncertainty that is nearest to where the board was: {index, distance_m, rms_px, worst_px}.
export function uncertaintyAtBoard(data) {
  const all = data.intrinsics?.uncertainty ?? [];
  if (all.length === 0) return null;
  const index = nearestToBoard(
    all.map(({ distance_m: distance }) => distance),
    boardDistance(data),
  );
  return { index, ...all[index] };
}

function uncertainty(data) {
  const found = uncertaintyAtBoard(data);
  if (!isNumber(found?.rms_px)) return null;
  const where = isNumber(boardDistance(data)) ? `, about as far away as the board was,` : "";
  const at = isNumber(found.distance_m) ? `${distanceText(found.distance_m)} away` : "infinitely far away";
  return (
    `The pixel of a point ${at}${where} is uncertain by σ = ${significant(found.rms_px)} px over the image (root mean ` +
    `square), by ${significant(found.worst_px)} px where it is worst.`
  );
}

function crossValidation({ sentence: text, why_not: whyNot }) {
  if (text) return sentence(text);
  return whyNot
    ? `There is no cross-validation, so nothing says whether the lens model fits: ${sentence(whyNot)}`
    : null;
}
