// All indices of the selected pose, with what each of them is.
import { copyable } from "../shared/copy_table.js";
import { append, html, muted, table } from "../shared/dom.js";
import { MISSING, isNumber, percent, sentence } from "../shared/format.js";
import { number, withUnit } from "../shared/numbers.js";
import { unitsOf } from "./units.js";

// threePoint: that of the matrices that take three points of the platform to the legs, which have a row of their own.
const NORMS = [
  { key: "two", label: "2-norm", threePoint: "two_three_point", length: "two" },
  {
    key: "frobenius",
    label: "Frobenius norm",
    threePoint: "frobenius_three_point_plain",
    length: "frobenius",
  },
  {
    key: "frobenius_of_gram",
    label: "Frobenius norm of M Mᵀ",
    threePoint: "frobenius_three_point",
    length: "frobenius",
  },
  { key: "infinity", label: "infinity norm", threePoint: null, length: "infinity" },
];

export function renderIndices(section, { data, pose }) {
  const { document } = data;
  append(
    section,
    muted("Point at a name to read what it is; all definitions stand at the end of the page."),
    html("div", { class: "tables" }, conditionTable(document, pose), sizeTable(document, pose)),
    nonlinear(document, pose.nonlinear),
    matrixDetails("Inverse Jacobian", pose.inverse_jacobian, document, "joint"),
    matrixDetails(regionTitle(pose.region_95), pose.region_95?.covariance, document, "error"),
    freeMotions(document, pose.free_motions),
  );
}

const at = (pose, path) => path.split(".").reduce((part, name) => part?.[name], pose);

// What the document says about an index, however it spells the key: "condition.two", "condition_two" or "two".
export function definitionOf(document, path) {
  const definitions = document?.definitions ?? {};
  const parts = path.split(".");
  const keys = [path, parts.join("_"), parts.slice(0, -1).join("."), parts.at(-1)];
  return keys.map((key) => definitions[key]).find(Boolean) ?? null;
}

function named(document, path, label) {
  const definition = definitionOf(document, path);
  return definition ? html("abbr", { title: sentence(definition) }, label) : label;
}

function conditionTable(document, pose) {
  const { length } = unitsOf(document);
  const lengthLabel = pose.condition?.natural_length ? "Natural length" : "Characteristic length";
  const rows = [
    { label: "Plain", path: (norm) => `condition.${norm.key}` },
    { label: "Normalized by the length below", path: (norm) => `condition.${norm.key}_normalized` },
    { label: "Of three points, least to largest", path: (norm) => `condition.${norm.threePoint}` },
    { label: lengthLabel, path: (norm) => `condition.characteristic_length.${norm.length}`, unit: length },
  ];
  const columns = [
    { label: "Condition number", text: true, cell: (row) => named(document, row.path(NORMS[0]), row.label) },
    ...NORMS.map((norm) => ({
      label: norm.label,
      cell: (row) => withUnit(range(at(pose, row.path(norm)), row.path(norm)), row.unit),
    })),
  ];
  return copyable(table("Condition numbers: the smaller the better", columns, [{ rows }]));
}

// A number, or the least and the largest.
function range(value, path) {
  if (!Array.isArray(value)) return number(value, path);
  return html("span", null, number(value[0], `${path}.0`), " to ", number(value[1], `${path}.1`));
}

function sizeTable(document, pose) {
  const { length, angle, of } = unitsOf(document);
  const row = (label, path, unit) => ({ label, path, unit });
  const axes = (kind, unit) =>
    ["longest", "middle", "shortest"].map((name, index) =>
      row(`Ellipsoid, ${kind}: ${name} semi-axis`, `ellipsoid.${kind}.semi_axes.${index}`, unit),
    );
  const rows = [
    row("Determinant of the inverse Jacobian", "determinant", of("determinant")),
    row("Manipulability", "manipulability", of("manipulability")),
    row("Polyhedron, position: volume", "polyhedron.position.volume", `${length}³`),
    row("Polyhedron, rotation: volume", "polyhedron.rotation.volume", `${angle}³`),
    row(
      "Polyhedron in 6 dimensions: volume",
      "polyhedron.volume_6d",
      of("volume_6d", `${length}³ ${angle}³`),
    ),
    ...axes("position", length),
    ...axes("rotation", angle),
  ];
  const columns = [
    { label: "Index", text: true, cell: ({ label, path }) => named(document, path, label) },
    { label: "Value", cell: ({ path }) => number(at(pose, path), path) },
    { label: "Unit", text: true, cell: ({ unit }) => unit || "1" },
  ];
  return copyable(table("Determinants, volumes, semi-axes", columns, [{ rows }]));
}

function nonlinear(document, found) {
  if (!found) return null;
  if (found.status !== "converged")
    return muted(`Check by solving the kinematics with the joint errors: ${found.status ?? MISSING}.`);
  const { length, angle } = unitsOf(document);
  return html(
    "p",
    null,
    "Check by solving the kinematics with the joint errors: the linear answer differs by ",
    withUnit(number(found.position_difference, "nonlinear.position_difference"), length),
    " and ",
    withUnit(number(found.rotation_difference, "nonlinear.rotation_difference"), angle),
    `, ${percent(found.relative)} of the error.`,
  );
}

const regionTitle = (region) =>
  isNumber(region?.chi_squared)
    ? `Covariance of the error (95 % region: χ² = ${region.chi_squared.toFixed(2)})`
    : "Covariance of the error";

function matrixDetails(title, matrix, document, rowName) {
  if (!matrix?.length) return null;
  const names = ["x", "y", "z", "rx", "ry", "rz"];
  const columns = [
    { label: "", text: true, cell: ({ name }) => name },
    ...names
      .slice(0, matrix[0].length)
      .map((label, column) => ({ label, cell: ({ row }) => number(row[column]) })),
  ];
  const rows = matrix.map((row, index) => ({
    row,
    name: rowName === "joint" ? `joint ${index + 1}` : names[index],
  }));
  const { length, angle } = unitsOf(document);
  return html(
    "details",
    null,
    html("summary", null, title),
    copyable(table(`${title}, in ${length} and ${angle}`, columns, [{ rows }])),
  );
}

function freeMotions(document, motions) {
  if (!motions?.length) return null;
  const { length, angle } = unitsOf(document);
  const columns = ["x", "y", "z", "rx", "ry", "rz"].map((label, index) => ({
    label,
    unit: index < 3 ? length : angle,
    cell: (motion) => number(motion[index]),
  }));
  return copyable(table("Motions that the locked joints leave free", columns, [{ rows: motions }]));
}
