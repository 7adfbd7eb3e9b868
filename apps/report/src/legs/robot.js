// The legs as they are and as they are in the hidden robot, and what holds of the robot itself.
import { copyable } from "../shared/copy_table.js";
import { append, html, paragraph, table } from "../shared/dom.js";
import { MISSING, sentence } from "../shared/format.js";
import { bareFigureOf, figureOf, poseColumns } from "./figures.js";
import { modesTable, ofAtMost } from "./modes.js";
import { modesSentence, motionOf, pathVerdict } from "./wording.js";

export function renderRobot(section, { data }) {
  const { document } = data;
  append(
    section,
    paragraph(`The platform moves in ${motionOf(document)}. An underscore stands before what is actuated.`),
    copyable(legsTable(document.legs ?? [])),
    html("h3", null, "The robot itself, all its joints held"),
    document.robot_path && ownWay(document),
    document.robot_modes && ownModes(document),
  );
}

function legsTable(legs) {
  const columns = [
    { label: "Leg", text: true, cell: ({ leg }) => String(leg) },
    { label: "Its chain", text: true, cell: ({ chain }) => chain },
    { label: "In the hidden robot", text: true, cell: ({ hidden_chain: hidden }) => hidden ?? MISSING },
    {
      label: "By its direction",
      text: true,
      cell: ({ why_not_controllable: why }) =>
        why ? `not controllable: ${why}` : "controllable with others",
    },
  ];
  return table("Legs", columns, [{ rows: legs }]);
}

function ownWay(document) {
  const way = document.robot_path;
  const columns = [
    { label: "Pose", text: true, cell: () => "up to which the robot’s own way is proved free" },
    ...poseColumns(document, () => "robot_path.pose_there"),
  ];
  return [
    paragraph(
      `Its straight way from start to goal is ${pathVerdict(way)}, up to `,
      figureOf(document, "robot_path.free_up_to"),
      " of it, on ",
      figureOf(document, "robot_path.pieces"),
      " pieces.",
      way.why && ` ${sentence(way.why)}`,
    ),
    copyable(table("On the robot’s own way", columns, [{ rows: [way] }])),
  ];
}

function ownModes(document) {
  const modes = document.robot_modes;
  const last = [
    {
      label: "Lengths differ by",
      unit: "mm",
      cell: (row) => bareFigureOf(document, `${row.path}.largest_length_error_m`),
    },
  ];
  return [
    paragraph(
      `Poses with the joint readings of the goal: ${modesSentence(modes)} `,
      ofAtMost(document, modes, "robot_modes"),
    ),
    modes.modes.length > 0 &&
      modesTable("The robot’s own assembly modes at the goal", document, "robot_modes.modes", last),
  ];
}
