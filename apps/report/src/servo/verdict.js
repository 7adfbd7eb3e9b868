// The verdict in plain words, and the key figures.
import { append, definitions } from "../shared/dom.js";
import { MISSING, isNumber } from "../shared/format.js";
import { verdictBox } from "../shared/verdict_box.js";
import { judge } from "./judgement.js";
import { figureOf } from "./quantities.js";

export function renderVerdict(section, { data }) {
  const { warnings, advice, ...judgement } = judge(data);
  const lists = [
    ["Look at", warnings],
    ["What to do", advice],
  ];
  append(
    section,
    verdictBox({ ...judgement, lists }),
    definitions(keyFigures(data.document ?? {}), "figures"),
  );
}

function keyFigures(document) {
  const figure = (path) => figureOf(document, path);
  const entries = [
    ["Error at the end", figure("final_error"), toleranceNote(document)],
    ["Edges", figure("final_edge_error_px"), "at the end, from where they should be"],
    ["Directions of the legs", figure("final_direction_error_rad"), "at the end"],
    ["Position of the platform", figure("final_pose_error.position_m"), "at the end, true error"],
    ["Rotation of the platform", figure("final_pose_error.rotation_rad"), "at the end, true error"],
    ["Time", figure("time_s"), isNumber(document.iterations) && [figure("iterations"), " cycles"]],
    ["Path of the platform", figure("path.length_m"), "length, of its centre"],
    ["Deviation of the path", figure("path.deviation_m"), "largest, from the straight line"],
    ["Fastest leg", figure("max_joint_speed_m_per_s"), "largest speed commanded"],
    ["Conditioning of what is seen", figure("min_conditioning"), "smallest; 1 is best"],
    ["σ of the motion told worst", figure("max_motion_sigma_m"), "by one image, at its largest"],
    ["Conditioning of the robot", figure("min_robot_conditioning"), "smallest; 1 is best"],
    ["Edges to command", figure("compute_time_s.p99"), "99 % of the cycles took no longer"],
    ["Image to edges", figure("look_time_s.p99"), "99 % of the cycles took no longer"],
  ];
  return entries.filter(([, value]) => value !== MISSING);
}

const toleranceNote = (document) =>
  isNumber(document.tolerance) ? ["tolerance ", figureOf(document, "tolerance")] : null;
