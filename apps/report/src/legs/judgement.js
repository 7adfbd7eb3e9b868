// The verdict over all sets in plain words. No page elements here.
import { capitalized, plural, sentence, significant, tick, withUnit } from "../shared/format.js";
import { DEGREES, MM, SECONDS } from "../shared/quantities.js";
import { edgesSentence, endOf, legsOf, otherModes, pathVerdict, verdictOf } from "./wording.js";

const shown = (value, { unit, scale }) => withUnit(significant(scale * value), unit);
const sizes = ({ position_m: position, rotation_rad: rotation }) =>
  `${shown(position, MM)} and ${shown(rotation, DEGREES)}`;

// {level, headline, sentences, lists}
export function judge(document) {
  const { choice, sets = [], warnings = [] } = document;
  const lists = [["Look at", warnings.map(sentence)]];
  if (!choice) return { ...none(document), lists };
  const best = sets[0];
  const isProved = best.verdict === "possible" && warnings.length === 0;
  return {
    level: isProved ? "good" : "care",
    headline: `Watch ${choice.length === 1 ? "leg" : "legs"} ${inList(choice)}`,
    sentences: [
      whyItLeads(best),
      ...ofSimulation(best.simulation),
      ...ofErrors(document, best),
      ofModes(best),
    ],
    lists,
  };
}

export const inList = (items) =>
  items.length < 2 ? items.join("") : `${items.slice(0, -1).join(", ")} and ${items.at(-1)}`;

function whyItLeads(set) {
  if (set.verdict !== "possible") return `${verdictOf(set).text} ${sentence(set.why)}`;
  const way = set.path?.is_the_simulated_way ? "the way that the servo takes" : "the straight way";
  return `Start and goal are in one aspect of the hidden robot: ${way} between them is ${pathVerdict(set.path ?? {})}.`;
}

function ofSimulation(simulation) {
  if (!simulation) return [];
  const { position_from_goal_m: position, rotation_from_goal_rad: rotation, time_s: time } = simulation;
  const off = sizes({ position_m: position, rotation_rad: rotation });
  return [
    `Simulated, the servo ends ${off} from the goal after ${shown(time, SECONDS)}: ${endOf(simulation)}.`,
  ];
}

function ofErrors({ noise_rad: noise }, { largest_error_at_goal: goal, largest_error_on_path: way }) {
  if (!goal) return [];
  const angle = withUnit(tick(DEGREES.scale * noise), DEGREES.unit);
  const onWay = way ? `, by up to ${sizes(way)} on the way` : "";
  return [
    `With every seen direction off by up to ${angle} the platform is off by up to ${sizes(goal)} at the goal${onWay}.`,
  ];
}

function ofModes({ assembly_modes: modes }) {
  const { text, count } = otherModes(modes);
  if (count === 0 && modes.status === "complete")
    return "At no other pose do all these legs point as they do at the goal.";
  return (
    `Other poses at which all these legs point as they do at the goal: ${text}. A servo from another start can end there, ` +
    "even from the goal’s own aspect."
  );
}

function none({ sets = [], robot_path: way, why_no_choice: why }) {
  const counts = new Map();
  for (const set of sets) counts.set(verdictOf(set).label, (counts.get(verdictOf(set).label) ?? 0) + 1);
  const verdicts = [...counts].map(([label, count]) => `${label.toLowerCase()}: ${plural(count, "set")}`);
  const ofRobot = way && way.verdict !== "free" && sentence(`the robot’s own straight way: ${way.why}`);
  return {
    level: "bad",
    headline: capitalized(why ?? "no set of legs leads to the goal"),
    sentences: [
      verdicts.length > 0 && sentence(verdicts.join("; ")),
      ofRobot,
      sets.length === 1 && sets[0].why && sentence(`Legs ${legsOf(sets[0])}: ${sets[0].why}`),
      edgesSentence(sets),
    ].filter(Boolean),
  };
}
