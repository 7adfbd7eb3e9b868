// Which legs to watch and what to expect, and the key figures.
import { append, definitions } from "../shared/dom.js";
import { MISSING } from "../shared/format.js";
import { verdictBox } from "../shared/verdict_box.js";
import { figureOf } from "./figures.js";
import { judge } from "./judgement.js";
import { otherModes } from "./wording.js";

export function renderVerdict(section, { data }) {
  const document = data.document ?? {};
  append(section, verdictBox(judge(document)), definitions(keyFigures(document), "figures"));
}

function keyFigures(document) {
  const figure = (path) => figureOf(document, path);
  const best = document.choice ? document.sets[0] : null;
  const ofBest = best && [
    ["Position error at the goal", figure("sets.0.largest_error_at_goal.position_m"), "at most"],
    ["Rotation error at the goal", figure("sets.0.largest_error_at_goal.rotation_rad"), "at most"],
    ["Other poses", otherModes(best.assembly_modes).text, "at which these legs point alike"],
    ["Time to the goal", figure("sets.0.simulation.time_s"), "simulated"],
  ];
  const entries = [
    ...(ofBest ?? []),
    ["Directions may be off by", figure("noise_rad"), "each, in the worst way"],
    ["Sets judged", String(document.sets?.length ?? MISSING)],
  ];
  return entries.filter(([, value]) => value !== MISSING);
}
