// What a calibration amounts to in words: a level, a headline, and what to look at. No page elements here.
import { isNumber, percent, plural, sentence, significant } from "../shared/format.js";
import { inWords } from "../shared/parameter_names.js";

const FAILURES = {
  unobservable: {
    headline: "Not usable: the data leave parameters open",
    advice: [
      "Supply one of the things that the sentences above ask for, then calibrate again. Joint readings go " +
        "into joints.csv; radii and other dimensions known by measurement go under “known” in session.yaml, with " +
        "their σ.",
      "Parameters that the data cannot determine are shown as “—” below. The rest is for information " +
        "only.",
    ],
  },
  not_converged: {
    headline: "Not usable: the estimate did not converge",
    advice: [
      "Look at the pictures below: do the found points lie on the legs, and does each leg carry its own " +
        "number? If not, the camera guess in camera.yaml or the order of the legs in robot.yaml or joints.csv is wrong.",
      "Check the units: all lengths are in metres, and joint readings are in the order of the legs.",
    ],
  },
  too_few_observations: {
    headline: "Not usable: too few observations",
    advice: [
      "Add images in clearly different poses; forty are a good number, and all six legs should be in sight.",
      "The section “What was left out” says why images and edges could not be used.",
    ],
  },
};
const UNKNOWN_FAILURE = { headline: "Not usable: the calibration ended without a result", advice: [] };

// {level: "good" | "care" | "bad", headline, sentences, warnings, open, advice}
export function judge(data) {
  const calibration = data.calibration ?? {};
  if (calibration.status !== "converged") return failure(calibration);
  const warnings = warningsOf(calibration);
  return {
    level: warnings.length ? "care" : "good",
    headline: warnings.length ? "Converged, with something to look at" : "Converged",
    sentences: [whatWasCalibrated(data), fitQuality(calibration), weakestPoint(data)].filter(Boolean),
    warnings,
    open: [],
    advice: [],
  };
}

const warningsOf = ({ warnings }) => (warnings ?? []).map((text) => sentence(inWords(text)));

function failure(calibration) {
  const { headline, advice } = FAILURES[calibration.status] ?? UNKNOWN_FAILURE;
  return {
    level: "bad",
    headline,
    sentences: calibration.message ? [sentence(inWords(calibration.message))] : [],
    warnings: warningsOf(calibration),
    open: (calibration.unobservable ?? []).map((text) => sentence(inWords(text))),
    advice,
  };
}

function whatWasCalibrated(data) {
  const { images_used: images, edges_used: edges, images_left_out: leftOut } = data.calibration;
  const without = leftOut?.length ? ` (${plural(leftOut.length, "image")} left out)` : "";
  return (
    `The camera, its place and the geometry of ${data.title ?? "the robot"} were calibrated from ` +
    `${plural(edges, "leg edge")} in ${plural(images, "image")}${without}.`
  );
}

function fitQuality({ rms_px: fit, held_out: heldOut }) {
  const text =
    `The calibrated model reproduces the edges found in the images to ${significant(fit)} px ` +
    "(root mean square)";
  return isNumber(heldOut?.rms_px)
    ? `${text}; in images that took no part in the fit, to ${significant(heldOut.rms_px)} px.`
    : `${text}. No images were held out, so this says nothing yet about new poses.`;
}

function weakestPoint(data) {
  const [weakest] = [...(data.weak ?? [])].sort((a, b) => (b.relative_sigma ?? 0) - (a.relative_sigma ?? 0));
  if (!weakest) return null;
  const size = isNumber(weakest.relative_sigma) ? ` (σ ${percent(weakest.relative_sigma)} of its size)` : "";
  return `What the images tell least about${size}: ${inWords(weakest.description)}.`;
}
