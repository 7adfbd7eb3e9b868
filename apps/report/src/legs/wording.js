// What the document's verdicts and statuses mean to people.
import { MISSING, capitalized } from "../shared/format.js";

const VERDICTS = {
  possible: {
    label: "Arrives, proved",
    level: "good",
    text: "The simulated servo ends at the goal, and its way is proved free of singularities of the hidden robot.",
  },
  arrives: {
    label: "Arrives, not proved",
    level: "care",
    text: "The simulated servo ends at the goal, but its way is not proved free of singularities: with other steps it may end elsewhere.",
  },
  undecided: {
    label: "Ends elsewhere, not proved",
    level: "bad",
    text: "It is not proved that no singularity lies between, and the simulated servo ends elsewhere.",
  },
  misled: {
    label: "Misled",
    level: "bad",
    text: "Start and goal are in one aspect of the hidden robot, but the simulated servo ends elsewhere.",
  },
  "other-aspect": {
    label: "In another aspect",
    level: "bad",
    text: "It is proved that every way to the goal passes a singularity of the hidden robot.",
  },
  "singular-goal": {
    label: "Singular at the goal",
    level: "bad",
    text: "At the goal, though not elsewhere, the directions do not hold the platform.",
  },
  uncontrollable: {
    label: "Not controllable",
    level: "bad",
    text: "The directions of these legs do not hold the platform anywhere.",
  },
  invisible: {
    label: "Not in sight",
    level: "bad",
    text: "A leg does not show at the start, at the goal or along the simulated way.",
  },
  "out-of-reach": {
    label: "Out of reach",
    level: "bad",
    text: "A leg does not reach the start, the goal or the simulated way, or would leave its joint range there.",
  },
};

const inWords = (name) => capitalized(String(name ?? "unknown").replaceAll("-", " "));

export const verdictOf = ({ verdict }) =>
  VERDICTS[verdict] ?? { label: inWords(verdict), level: "care", text: "" };

export const legsOf = ({ legs }) => (legs ?? []).join(", ");

// How many poses other than the goal: {text, count (for sorting)}.
export function otherModes(modes) {
  const listed = modes?.modes?.length ?? 0;
  if (modes?.status === "infinite") return { text: "infinitely many", count: Infinity };
  if (modes?.status === "unreachable" || listed === 0) return { text: MISSING, count: Infinity };
  const count = listed - 1;
  return { text: `${count}${modes.status === "complete" ? "" : " or more"}`, count };
}

const NOT_COMPLETE = {
  infinite: "There are infinitely many",
  unreachable: "Nothing is known of others",
};

export function modesSentence({ status, why }) {
  if (status === "complete") return "It is proved that there are no others.";
  return `${NOT_COMPLETE[status] ?? "There may be others"}: ${why}.`;
}

const PATHS = {
  free: "proved free of singularities",
  singular: "proved to be impossible without a singularity",
  "out-of-reach": "proved to leave what the legs reach",
  undecided: "not proved free of singularities",
};
export const pathVerdict = ({ verdict }) => PATHS[verdict] ?? verdict;

const HOLD = {
  controllable: "hold the platform",
  "singular-pose": "do not hold the platform at the goal",
  uncontrollable: "do not hold the platform",
  unreachable: "do not reach the goal",
};
export const holding = ({ status }) => HOLD[status] ?? status;

const ENDS = {
  converged: "all seen legs point as at the goal",
  "local-minimum": "it stands still though the legs do not point as at the goal",
  "at-boundary": "a leg is stretched or folded, and it cannot go on",
  "time-up": "the time is up",
};
export const endOf = ({ end }) => ENDS[end] ?? end;

const MOTIONS = {
  "planar-point": "x and y",
  planar: "x, y and a rotation about z",
  translation: "x, y and z",
  schoenflies: "x, y, z and a rotation about z",
  spatial: "all six freedoms, as far as the legs allow",
};
export const motionOf = ({ platform }) => MOTIONS[platform] ?? platform ?? MISSING;

const isGained = ({ by_lines: lines, controllability }) =>
  lines?.status === "controllable" && controllability?.status !== "controllable";

// What edges would change, per set and over all.
export function edgesOf(set) {
  if (isGained(set)) return { text: "hold the platform, directions do not", gained: true };
  const text = holding(set.by_lines ?? {}) ?? MISSING;
  return { text, gained: false };
}

export function edgesSentence(sets) {
  const gained = sets.filter(isGained);
  const what = "Edges show where a leg’s line is as well as its direction.";
  if (gained.length === 0)
    return `${what} Seen by them, no set holds the platform that does not hold it by directions.`;
  const names = gained.map(legsOf).join("; ");
  const [noun, hold] = gained.length === 1 ? ["set holds", "does"] : ["sets hold", "do"];
  return `${what} Seen by them, ${gained.length} ${noun} the platform that ${hold} not hold it by directions: ${names}.`;
}
