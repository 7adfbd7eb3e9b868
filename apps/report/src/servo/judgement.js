// What a run amounts to in words: a level, a headline, sentences, and what to do. No page elements here.
import { isNumber, percent, plural, sentence, significant } from "../shared/format.js";
import { inWords } from "../shared/parameter_names.js";
import { limitSpans } from "./spans.js";

const ENDS = {
  converged: { headline: "Converged: the robot is at its goal" },
  "bad-readings": {
    headline: "Stopped: joint readings were not numbers",
    advice: "Look at the encoders of the legs that the sentence above names, and at the link to the drives.",
  },
  "stale-readings": {
    headline: "Stopped: no fresh joint readings came",
    advice: "Look at the link to the drives, and at what else the computer had to do.",
  },
  "frozen-readings": {
    headline: "Stopped: joint readings stood still though the joints should have moved",
    advice: "Look at the encoders, and whether the drives are switched on.",
  },
  "stale-images": {
    headline: "Stopped: no fresh images came",
    advice: "Look at the camera, its cable, and its rate.",
  },
  "frozen-images": {
    headline: "Stopped: the images stood still though the robot should have moved",
    advice: "Look at the camera and its driver: it sends one image again and again.",
  },
  "drives-do-not-move": {
    headline: "Stopped: the drives did not move the robot",
    advice: "Look whether the drives are switched on and an emergency stop is released.",
  },
  "too-few-edges": {
    headline: "Stopped: too few edges were seen",
    advice:
      "Look at the pictures below: what hides the legs, or is the light too weak? Three legs have to be in sight.",
  },
  "ill-conditioned-edges": {
    headline: "Stopped: what was seen leaves a motion of the platform open",
    advice: "Bring more legs into sight, or move the camera to where the legs are seen from different sides.",
  },
  "robot-singular": {
    headline: "Stopped: the robot came too close to a singularity",
    advice: "Choose a start or an intermediate goal from which the way to the goal keeps clear of it.",
  },
  "no-pose": {
    headline: "Stopped: the joint readings belong to no pose of the platform",
    advice: "Check the model and the joint offsets: does each leg carry its own number?",
  },
  "error-grows": {
    headline: "Stopped: the error grew",
    advice:
      "Check the model, above all the place of the camera, and that the goal was made with the same model; then a lower gain.",
  },
  stalled: {
    headline: "Stopped short of the goal: the error no longer fell",
    advice: "The sentence above names what held the robot; the limits below say when.",
  },
  timeout: {
    headline: "Stopped: the goal was not reached in time",
    advice: "If the errors below were still falling, allow more time or a higher gain.",
  },
  "link-lost": {
    headline: "Stopped: the link to the robot was lost",
    advice: "Look at the cable and the controller.",
  },
  "stopped-by-user": { headline: "Stopped by the user", level: "care" },
};
const UNKNOWN_END = { headline: "The run ended without having converged" };

const CONTROLLED = {
  edges: "by the edges of its legs",
  directions: "by the directions of its legs",
  pose: "by the pose of its platform",
  joints: "by its joint readings",
};

// {level: "good" | "care" | "bad", headline, sentences, warnings, advice}
export function judge(data) {
  const document = data.document ?? {};
  const end = ENDS[document.status] ?? UNKNOWN_END;
  const warnings = (document.warnings ?? []).map((text) => sentence(inWords(text)));
  const converged = document.status === "converged";
  return {
    level: converged ? (warnings.length ? "care" : "good") : (end.level ?? "bad"),
    headline: end.headline,
    sentences: [sentence(document.reason), whatWasDone(data), path(document), limits(data)].filter(Boolean),
    warnings,
    advice: end.advice ? [end.advice] : [],
  };
}

function whatWasDone({ title, document = {} }) {
  if (!isNumber(document.time_s)) return null;
  const how = CONTROLLED[document.mode] ?? "";
  const legs = document.legs?.length ? `, ${legList(document.legs)}` : "";
  const cycles = isNumber(document.iterations) ? ` and ${plural(document.iterations, "cycle")}` : "";
  return `${title ?? "The robot"} was driven ${how}${legs}, for ${significant(document.time_s)} s${cycles}.`;
}

function legList(legs) {
  if (legs.length === 1) return `leg ${legs[0]}`;
  if (legs.length === 6) return "all six";
  return `legs ${legs.slice(0, -1).join(", ")} and ${legs[legs.length - 1]}`;
}

function path({ path: found }) {
  const { length_m: length, deviation_m: deviation } = found ?? {};
  if (!isNumber(length)) return null;
  const way = `The centre of the platform went ${significant(1e3 * length)} mm`;
  if (!isNumber(deviation) || !(length > 0)) return `${way}.`;
  return `${way}, at most ${significant(1e3 * deviation)} mm (${percent(deviation / length)}) off the straight line.`;
}

function limits({ cycles }) {
  const texts = cycles?.limits ?? [];
  if (texts.length === 0) return null;
  const limited = texts.filter(Boolean).length;
  if (limited === 0) return "No limit was in force at any time.";
  const [longest] = limitSpans(cycles.time_s, texts);
  return `Limits were in force in ${limited} of ${plural(texts.length, "cycle")}, longest: ${longest.words}.`;
}
