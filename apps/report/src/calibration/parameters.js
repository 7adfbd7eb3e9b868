// Parameters found against the drawing: the camera, the legs, and plots of what differs.
import * as Plot from "@observablehq/plot";
import { median } from "d3";
import { append, figure, html, muted, table } from "../shared/dom.js";
import { MISSING, decimalsFor, fixed, isNumber, signed, significant } from "../shared/format.js";
import { coefficientNames } from "../shared/parameter_names.js";
import { COLOR, TIP, key, plot, responsive } from "../shared/plots.js";

const AXES = ["x", "y", "z"];
const AXIS_COLOR = { x: COLOR.first, y: COLOR.second, z: COLOR.third };
const CLEARLY_OFF_SIGMA = 3;

const LEG_QUANTITIES = [
  { field: "base_joint_m", label: "Base joint A", short: "A", unit: "mm", scale: 1e3, axes: AXES },
  { field: "platform_joint_m", label: "Platform joint B", short: "B", unit: "mm", scale: 1e3, axes: AXES },
  { field: "radius_m", label: "Radius R", short: "R", unit: "µm", scale: 1e6 },
  { field: "joint_offset_m", label: "Joint offset", short: "offset", unit: "mm", scale: 1e3 },
];

export function renderParameters(section, data) {
  const camera = cameraRows(data);
  const legs = legRows(data);
  append(
    section,
    muted(
      "σ is one standard deviation. “Off by” is how far the drawing, or the first guess of the camera, lies " +
        `from what was found, in units of σ; it is bold from ${CLEARLY_OFF_SIGMA} on.`,
    ),
    html("h3", null, "Camera"),
    html(
      "div",
      { class: "beside" },
      table("Intrinsics and lens", parameterColumns("First guess"), camera),
      table("Pose: camera from base", parameterColumns("").slice(0, 3), [
        { rows: poseRows(data.calibration) },
      ]),
    ),
    html("h3", null, "Legs"),
    legs.length === 0 && muted("Not known."),
    legs.length > 0 &&
      muted(
        "A is the base joint in the base frame, B the platform joint in the platform frame, R the radius; " +
          "leg length = joint reading + offset. Both frames are laid so that the found joints fit the drawn ones best.",
      ),
    differencePlots(legs),
    html("div", { class: "columns" }, legTables(legs)),
    cameraFrameDetails(data.calibration?.legs ?? []),
  );
}

// A row: {name, unit, scale, decimals, found, sigma, drawn}; the last three in the units of the file.
function parameterColumns(drawnLabel) {
  return [
    { label: "Parameter", text: true, cell: ({ name }) => name },
    { label: "Unit", text: true, cell: ({ unit }) => unit },
    { label: "Found", cell: (row) => inUnit(row, row.found) },
    { label: "σ", cell: sigmaCell },
    { label: drawnLabel, cell: (row) => inUnit(row, row.drawn) },
    { label: "Difference", cell: (row) => signed(differenceOf(row), row.decimals) },
    { label: "Off by", unit: "σ", cell: offByCell },
  ];
}

const inUnit = ({ scale, decimals }, value) => (isNumber(value) ? fixed(value * scale, decimals) : MISSING);
const differenceOf = ({ found, drawn, scale }) =>
  isNumber(found) && isNumber(drawn) ? (found - drawn) * scale : null;

function sigmaCell(row) {
  if (row.sigma === 0) return html("span", { class: "muted" }, "held");
  return inUnit(row, row.sigma);
}

function offByCell(row) {
  if (!isNumber(row.sigma) || row.sigma <= 0 || differenceOf(row) === null) return MISSING;
  const off = Math.abs(row.found - row.drawn) / row.sigma;
  const text = off >= 100 ? significant(off, 2) : fixed(off, 1);
  return off >= CLEARLY_OFF_SIGMA ? html("strong", null, text) : text;
}

function cameraRows({ calibration, nominal }) {
  const found = calibration?.camera ?? {};
  const guess = nominal?.camera ?? {};
  const row = (name, unit, decimals, pick) => ({
    name,
    unit,
    scale: 1,
    decimals: decimalsFor(pick(found.sigma), decimals),
    found: pick(found),
    sigma: pick(found.sigma),
    drawn: pick(guess),
  });
  const intrinsics = [
    ["Focal length fx", "fx"],
    ["Focal length fy", "fy"],
    ["Principal point cx", "cx"],
    ["Principal point cy", "cy"],
  ].map(([name, field]) => row(name, "px", 2, (camera) => camera?.[field]));
  const coefficients = coefficientNames(found).map((name, index) =>
    row(`Distortion ${name}`, "", 5, (camera) => camera?.distortion?.[index]),
  );
  return [{ rows: [...intrinsics, ...coefficients] }];
}

function poseRows(calibration) {
  const pose = calibration?.camera_from_base;
  const row = (name, unit, scale, decimals, found) => ({ name, unit, scale, decimals, found });
  return [
    ...AXES.map((axis, i) => row(`Translation ${axis}`, "mm", 1e3, 2, pose?.translation_m?.[i])),
    ...[...AXES, "w"].map((axis, i) => row(`Quaternion ${axis}`, "", 1, 6, pose?.rotation_xyzw?.[i])),
  ];
}

function legRows({ calibration, nominal }) {
  const rows = (calibration?.legs ?? []).flatMap((found, index) =>
    LEG_QUANTITIES.flatMap((quantity) => quantityRows(quantity, index, found, nominal?.legs?.[index])),
  );
  return withCommonDecimals(rows);
}

function quantityRows(quantity, index, found, drawn) {
  const { field, short, unit, scale, axes } = quantity;
  const row = (axis, pick) => ({
    leg: index + 1,
    field,
    axis,
    unit,
    scale,
    decimals: 2,
    name: axis ? `${short} ${axis}` : short,
    found: pick(found?.[field]),
    sigma: pick(found?.sigma?.[field]),
    drawn: pick(drawn?.[field]),
  });
  return axes ? axes.map((axis, i) => row(axis, (vector) => vector?.[i])) : [row(null, (value) => value)];
}

// Equal quantities get equal digits, those of their median sigma, so that columns line up.
function withCommonDecimals(rows) {
  return rows.map((row) => {
    const sigmas = rows
      .filter(({ field, sigma }) => field === row.field && sigma > 0)
      .map(({ sigma }) => sigma);
    return { ...row, decimals: decimalsFor(median(sigmas) * row.scale, row.decimals) };
  });
}

function legTables(rows) {
  const groups = [...new Set(rows.map(({ leg }) => leg))].map((leg) => ({
    label: `Leg ${leg}`,
    rows: rows.filter((row) => row.leg === leg),
  }));
  return [
    [0, 3],
    [3, 6],
  ]
    .filter(([first]) => first < groups.length)
    .map(([first, end]) =>
      table(`Legs ${first + 1} to ${end}`, parameterColumns("Drawing"), groups.slice(first, end)),
    );
}

function differencePlots(rows) {
  if (!rows.some((row) => differenceOf(row) !== null)) return null;
  return figure(
    "Found minus drawn; whiskers are ± 2 σ. A point whose whisker crosses zero agrees with the drawing.",
    key(AXES.map((axis) => ["dot", AXIS_COLOR[axis], axis])),
    html(
      "div",
      { class: "plots" },
      LEG_QUANTITIES.map((quantity) =>
        responsive((width) =>
          differencePlot(
            quantity,
            rows.filter(({ field }) => field === quantity.field),
            width,
          ),
        ),
      ),
    ),
  );
}

function differencePlot({ label, unit, axes }, rows, width) {
  const points = rows
    .filter((row) => differenceOf(row) !== null)
    .map((row) => ({
      leg: row.leg,
      axis: row.axis,
      difference: differenceOf(row),
      spread: 2 * (row.sigma ?? 0) * row.scale,
      at: row.leg + (axes ? (axes.indexOf(row.axis) - 1) * 0.22 : 0),
      title: tipText(row),
    }));
  const color = ({ axis }) => (axis ? AXIS_COLOR[axis] : COLOR.text);
  return plot(`${label}: difference from the drawing by leg`, {
    width,
    height: 216,
    marginLeft: 52,
    marginTop: 28,
    marginBottom: 46,
    x: {
      label: "leg",
      domain: [0.5, 6.5],
      ticks: [1, 2, 3, 4, 5, 6],
      tickFormat: "d",
      labelAnchor: "center",
      labelArrow: false,
    },
    y: { label: `${label}, ${unit}`, grid: true, nice: true, labelArrow: false },
    color: { type: "identity" },
    marks: [
      Plot.ruleY([0], { stroke: COLOR.muted }),
      Plot.ruleX(points, {
        x: "at",
        y1: (d) => d.difference - d.spread,
        y2: (d) => d.difference + d.spread,
        stroke: color,
        strokeWidth: 1.5,
      }),
      Plot.dot(points, { x: "at", y: "difference", fill: color, r: 3 }),
      Plot.tip(points, Plot.pointer({ x: "at", y: "difference", title: "title", ...TIP })),
    ],
  });
}

function tipText(row) {
  return (
    `Leg ${row.leg}, ${row.name}\nfound ${inUnit(row, row.found)} ± ${inUnit(row, row.sigma)} ${row.unit}\n` +
    `drawn ${inUnit(row, row.drawn)} ${row.unit}\n` +
    `difference ${signed(differenceOf(row), row.decimals)} ${row.unit}`
  );
}

function cameraFrameDetails(legs) {
  if (legs.length === 0) return null;
  const quantity = { field: "base_joint_in_camera_m", short: "A", unit: "mm", scale: 1e3, axes: AXES };
  const rows = withCommonDecimals(legs.flatMap((leg, index) => quantityRows(quantity, index, leg, null))).map(
    (row) => ({ ...row, name: `Leg ${row.leg}, ${row.name}` }),
  );
  return html(
    "details",
    null,
    html("summary", null, "Base joints in the camera frame"),
    table(
      "Base joints A in the camera frame (x right, y down, z forward), free of any choice of a base frame.",
      parameterColumns("Drawing").slice(0, 4),
      [{ rows }],
    ),
  );
}
