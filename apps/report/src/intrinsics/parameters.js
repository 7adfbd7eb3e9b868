// The camera's parameters with their uncertainties, the board's warp, and how all go together.
import { copyable } from "../shared/copy_table.js";
import { renderCorrelations } from "../shared/correlations.js";
import { valueAt } from "../shared/document.js";
import { append, html, muted, table } from "../shared/dom.js";
import { MISSING, decimalsFor, fixed, isNumber, percent } from "../shared/format.js";
import { measuredNumber } from "../shared/numbers.js";
import { coefficientNames } from "../shared/parameter_names.js";
import { lensText } from "./judgement.js";
import { unitOf } from "./quantities.js";

const PINHOLE = [
  ["fx", "Focal length fx"],
  ["fy", "Focal length fy"],
  ["cx", "Principal point cx"],
  ["cy", "Principal point cy"],
];

export const hasParameters = ({ intrinsics }) => Boolean(intrinsics?.camera);

export function renderParameters(section, data) {
  const document = data.intrinsics;
  append(
    section,
    muted(introduction(document.camera)),
    copyable(table("Camera", COLUMNS, [{ rows: cameraRows(document) }, ...warpGroup(document)])),
    document.board_warp_m &&
      muted(
        "Warp: by how much the board's middle stands out towards the camera, along its width and its height.",
      ),
  );
  if (!data.correlations) return;
  append(section, html("h3", null, "Correlations"));
  renderCorrelations(section, data);
}

const introduction = ({ lens }) =>
  `The model: ${lensText(lens)}${lens === "pinhole" ? "" : ", coefficients as OpenCV has them"}; pixel (0, 0) is the ` +
  "centre of the top-left pixel. σ is one standard deviation, from the scatter that the residuals show.";

const COLUMNS = [
  { label: "Parameter", text: true, cell: ({ name }) => name },
  { label: "Unit", text: true, cell: ({ unit }) => unit.unit },
  { label: "Value", cell: ({ value, unit, path, decimals }) => cellOf(value, unit, path, decimals) },
  { label: "σ", cell: ({ sigma, unit, sigmaPath, decimals }) => sigmaCell(sigma, unit, sigmaPath, decimals) },
  { label: "σ relative", cell: relative },
];

const cellOf = (value, unit, path, decimals) =>
  measuredNumber(value, unit, path, isNumber(value) ? fixed(unit.scale * value, decimals) : MISSING);

const sigmaCell = (sigma, unit, path, decimals) =>
  sigma === 0
    ? html("span", { class: "muted" }, measuredNumber(sigma, unit, path, "held"))
    : cellOf(sigma, unit, path, decimals);

function relative({ value, sigma }) {
  if (!isNumber(value) || !isNumber(sigma) || value === 0 || sigma === 0) return MISSING;
  return percent(sigma / Math.abs(value));
}

function rowOf(document, name, path, sigmaPath) {
  const [value, sigma] = [valueAt(document, path), valueAt(document, sigmaPath)];
  const unit = unitOf(path);
  const decimals = decimalsFor(isNumber(sigma) ? sigma * unit.scale : null, unit.unit ? 3 : 5);
  return { name, value, sigma, unit, path, sigmaPath, decimals };
}

export function cameraRows(document) {
  return [
    ...PINHOLE.map(([field, name]) => rowOf(document, name, `camera.${field}`, `camera.sigma.${field}`)),
    ...coefficientNames(document.camera).map((name, index) =>
      rowOf(document, `Distortion ${name}`, `camera.distortion.${index}`, `camera.sigma.distortion.${index}`),
    ),
  ];
}

const warpGroup = (document) =>
  document.board_warp_m
    ? [
        {
          label: "Warp of the board",
          rows: document.board_warp_m.map((_, index) =>
            rowOf(document, `Along ${"xy"[index]}`, `board_warp_m.${index}`, ""),
          ),
        },
      ]
    : [];
