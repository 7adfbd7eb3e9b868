// What is known of one set of legs: what its directions and edges hold, the way that was judged, where it ends.
import { copyable } from "../shared/copy_table.js";
import { append, definitions, html, muted, paragraph, table } from "../shared/dom.js";
import { MISSING, sentence } from "../shared/format.js";
import { bareFigureOf, figureOf, poseColumns } from "./figures.js";
import { endOf, holding, legsOf, pathVerdict, verdictOf } from "./wording.js";

export function renderChosen(section, { data, set }) {
  const { document } = data;
  const { level, label, text } = verdictOf(set);
  append(
    section,
    html("h3", null, html("span", { class: `light ${level}` }), `Legs ${legsOf(set)}: ${label}`),
    paragraph(text, set.why && ` ${sentence(set.why)}`),
    definitions(entries(document, set), "list"),
    unseenTable(document, set),
    copyable(poseTable(document, set)),
  );
}

function entries(document, set) {
  const figure = (path) => figureOf(document, `sets.${set.index}.${path}`);
  return [
    ["Directions", held(figure, set.controllability, "controllability")],
    ["Edges", held(figure, set.by_lines, "by_lines")],
    ["Way", set.path ? way(figure, set.path) : "not judged: the set was ruled out before"],
    [
      "Largest error at the goal",
      errors(figure, "largest_error_at_goal"),
      "of the platform, by directions that are off",
    ],
    ["Largest error on the way", errors(figure, "largest_error_on_path"), "at the poses of the simulated way"],
    ["Simulated servo", set.simulation ? simulated(figure, set.simulation) : "not simulated"],
  ];
}

function held(figure, found, path) {
  if (!found) return MISSING;
  return html(
    "span",
    null,
    `${holding(found)}: they show `,
    figure(`${path}.seen_freedoms`),
    " of the platform’s ",
    figure(`${path}.freedoms`),
    " motions",
    found.why && `; ${found.why}`,
  );
}

const way = (figure, path) =>
  html(
    "span",
    null,
    `${path.is_the_simulated_way ? "that of the simulated servo" : "straight"}, ${pathVerdict(path)}, up to `,
    figure("path.free_up_to"),
    " of it, on ",
    figure("path.pieces"),
    " pieces",
    path.why && `; ${path.why}`,
  );

const errors = (figure, name) => {
  const position = figure(`${name}.position_m`);
  return position === MISSING
    ? MISSING
    : html("span", null, position, " and ", figure(`${name}.rotation_rad`));
};

const simulated = (figure, simulation) =>
  html(
    "span",
    null,
    `${endOf(simulation)}, after `,
    figure("simulation.time_s"),
    "; ",
    figure("simulation.position_from_goal_m"),
    " and ",
    figure("simulation.rotation_from_goal_rad"),
    " from the goal; largest error of a direction ",
    figure("simulation.largest_direction_error_rad"),
  );

// The motions that the directions, and the edges, do not show.
function unseenTable(document, set) {
  const groups = [
    ["controllability", "By directions"],
    ["by_lines", "By edges"],
  ]
    .map(([name, label]) => ({
      label,
      rows: (set[name]?.unseen_twists ?? []).map((_, index) => ({
        path: `sets.${set.index}.${name}.unseen_twists.${index}`,
        number: index + 1,
      })),
    }))
    .filter(({ rows }) => rows.length > 0);
  if (groups.length === 0) return null;
  const columns = [
    { label: "Motion", text: true, cell: ({ number }) => String(number) },
    ...["vx", "vy", "vz", "ωx", "ωy", "ωz"].map((label, axis) => ({
      label,
      unit: axis < 3 ? "m" : "rad",
      cell: ({ path }) => bareFigureOf(document, `${path}.${axis}`),
    })),
  ];
  return [
    copyable(table("Motions of the platform that are not seen", columns, groups)),
    muted("Of the platform’s origin, in base, for a motion of unit size."),
  ];
}

function poseTable(document, { index, path, simulation }) {
  const rows = [
    { name: "start", path: "from" },
    { name: "goal", path: "to" },
    path && { name: "up to which the way is proved free", path: `sets.${index}.path.pose_there` },
    simulation && {
      name: "where the simulated servo ends",
      path: `sets.${index}.simulation.base_from_platform`,
    },
  ].filter(Boolean);
  const columns = [
    { label: "Pose", text: true, cell: ({ name }) => name },
    ...poseColumns(document, ({ path: of }) => of),
  ];
  return table("Poses on the way", columns, [{ rows }]);
}
