// The selected pose in numbers: where the platform is, and what the joints read.
import { copyable } from "../shared/copy_table.js";
import { html, table } from "../shared/dom.js";
import { capitalized, fixed } from "../shared/format.js";
import { number } from "../shared/numbers.js";
import { ERRORS, unitsOf } from "./units.js";

const DECIMALS = 3;

export function poseTable(document, pose) {
  const units = unitsOf(document);
  const coordinates = ERRORS.slice(0, 6).map(({ label, kind }, index) => ({
    name: label,
    value: pose?.pose?.[index],
    unit: units[kind],
  }));
  const joints = (pose?.joint_readings ?? []).map((value, index) => ({
    name: `joint ${index + 1}`,
    value,
    unit: units.of("joint", units.length),
  }));
  const columns = [
    { label: "", text: true, cell: ({ name }) => name },
    { label: "Value", cell: ({ value }) => number(value, null, fixed(value, DECIMALS)) },
    { label: "Unit", text: true, cell: ({ unit }) => unit },
  ];
  const groups = [
    { label: "Pose of the platform", rows: coordinates },
    { label: "Joint readings", rows: joints },
  ].filter(({ rows }) => rows.length);
  return html("div", null, copyable(table(capitalized(pose?.name ?? "pose"), columns, groups)));
}
