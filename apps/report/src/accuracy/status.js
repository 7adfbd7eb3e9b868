// What the status of a pose means to people.
import { capitalized } from "../shared/format.js";

const STATUS = {
  regular: { label: "Regular", level: "good", text: "Far from any singularity." },
  near_singular: {
    label: "Near a singularity",
    level: "care",
    text: "The errors below are computed, but they are so large that the linear answer means little.",
  },
  singular: {
    label: "Singular",
    level: "bad",
    text: "With all joints locked the platform can still move: no errors can be given.",
  },
  out_of_joint_range: {
    label: "Outside the joint ranges",
    level: "care",
    text: "The robot cannot come here: a joint would have to leave its range.",
  },
  out_of_reach: { label: "Out of reach", level: "care", text: "The robot cannot come here." },
  impossible: { label: "Impossible", level: "bad", text: "There is no such pose." },
  invalid: { label: "Not valid", level: "bad", text: "Nothing could be computed here." },
};

const unknown = (status) => capitalized(status?.replaceAll("_", " ") ?? "unknown");

export const statusOf = (pose) =>
  STATUS[pose?.status] ?? { label: unknown(pose?.status), level: "care", text: "" };
