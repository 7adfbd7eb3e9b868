// The poses other than the goal at which all legs of the set point as they do there: in numbers, and as a picture.
import { copyable } from "../shared/copy_table.js";
import { append, html, muted, paragraph, table } from "../shared/dom.js";
import { bareFigureOf, figureOf, placeOf, poseColumns } from "./figures.js";
import { RobotView, canDrawRobot } from "./robot_view.js";
import { legsOf, modesSentence } from "./wording.js";

export function renderModes(section, { data, set }) {
  const view = canDrawRobot(data) ? new RobotView(data, set) : null;
  append(section, modesOf(data.document, set, view), view?.element);
}

function modesOf(document, set, view) {
  const found = set.assembly_modes;
  if (!found) return muted("Not looked for: the set was ruled out before.");
  const base = `sets.${set.index}.assembly_modes`;
  return [
    paragraph(`${modesSentence(found)} `, ofAtMost(document, found, base)),
    reversed(document, base),
    found.modes.length > 0 &&
      modesTable(
        `Poses at which legs ${legsOf(set)} point as at the goal`,
        document,
        `${base}.modes`,
        hiddenColumns(document),
        view,
      ),
  ];
}

export const ofAtMost = (document, { most_possible: most }, base) =>
  most > 0 && ["Robots of this kind have at most ", figureOf(document, `${base}.most_possible`), " in all."];

const reversed = (document, base) =>
  paragraph(
    "Further poses, at which a leg points exactly the other way and the servo’s error is zero too: ",
    figureOf(document, `${base}.with_a_reversed_leg`),
    ".",
  );

// path: to a list of modes, the first of which is the goal itself; last: the columns after the pose and its distance from
// the goal; view: that shows a mode where it is clicked.
export function modesTable(caption, document, path, last, view = null) {
  const modes = path.split(".").reduce((part, name) => part[name], document);
  const rows = modes.map((mode, index) => ({ ...mode, index, path: `${path}.${index}` }));
  const columns = [
    { label: "Mode", text: true, cell: ({ index }) => modeName(index, view) },
    ...poseColumns(document, (row) => `${row.path}.base_from_platform`),
    {
      label: "From the goal",
      unit: "mm",
      cell: (row) => placeOf(document, `${row.path}.position_from_goal_m`),
    },
    {
      label: "From the goal",
      unit: "°",
      cell: (row) => placeOf(document, `${row.path}.rotation_from_goal_rad`),
    },
    ...last,
  ];
  return copyable(table(caption, columns, [{ rows }]));
}

const hiddenColumns = (document) => [
  { label: "Reached", text: true, cell: workingModes },
  {
    label: "Within joint ranges",
    text: true,
    cell: ({ within_joint_ranges: is }) => ANSWER[is] ?? "not known",
  },
  {
    label: "Directions differ by",
    cell: (row) => bareFigureOf(document, `${row.path}.largest_direction_error`),
  },
];

const ANSWER = { true: "yes", false: "no" };

function modeName(index, view) {
  const name = index === 0 ? "goal" : `mode ${index}`;
  if (!view) return name;
  const show = () => view.show(`mode ${index}`);
  return html("button", { type: "button", class: "link", onclick: show }, name);
}

const workingModes = ({ has_own_working_modes: own }) =>
  own ? "in its own working modes" : "past a stretched or folded leg";
