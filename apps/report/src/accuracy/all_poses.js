// All poses in one table, and what two of them have in common.
import { copyable } from "../shared/copy_table.js";
import { append, html, table } from "../shared/dom.js";
import { barred, number } from "../shared/numbers.js";
import { statusOf } from "./status.js";
import { SIZES, unitsOf } from "./units.js";

export function renderAllPoses(section, { data, choose }) {
  const poses = data.document?.poses ?? [];
  const units = unitsOf(data.document);
  const columns = [
    { label: "Pose", text: true, cell: (pose) => chooseButton(pose, poses.indexOf(pose), choose) },
    { label: "Status", text: true, cell: (pose) => statusCell(pose) },
    ...SIZES.map(({ key, label, kind }) => sizeColumn(poses, key, `${label} error`, units[kind])),
    {
      label: "Condition number, 2-norm, normalized",
      cell: (pose) =>
        number(
          pose.condition?.two_normalized,
          `document.poses.${poses.indexOf(pose)}.condition.two_normalized`,
        ),
    },
  ];
  append(section, copyable(table("Largest errors of all poses", columns, [{ rows: poses }])));
}

const chooseButton = (pose, index, choose) =>
  html(
    "button",
    { type: "button", class: "link", onclick: () => choose(index) },
    pose.name ?? `${index + 1}`,
  );

function statusCell(pose) {
  const { label, level } = statusOf(pose);
  return html("span", { class: "status" }, html("span", { class: `light ${level}` }), ` ${label}`);
}

function sizeColumn(poses, key, label, unit) {
  const full = Math.max(0, ...poses.map((pose) => pose.max_error?.[key] ?? 0));
  const cell = (pose) =>
    barred(pose.max_error?.[key], full, `document.poses.${poses.indexOf(pose)}.max_error.${key}`);
  return { label, unit, cell };
}
