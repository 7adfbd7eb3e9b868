// Units of the document's numbers: as people write them, and in SI for the drawings.
import { superscript } from "../shared/format.js";

const METRES = { m: 1, cm: 1e-2, mm: 1e-3, um: 1e-6, µm: 1e-6, μm: 1e-6, in: 0.0254 };
const DEGREE = Math.PI / 180;
const RADIANS = { rad: 1, mrad: 1e-3, deg: DEGREE, "°": DEGREE, arcmin: DEGREE / 60, arcsec: DEGREE / 3600 };

// "mm^3" -> "mm³"
export const pretty = (unit) => String(unit ?? "").replace(/\^(-?\d+)/g, (_, power) => superscript(power));

// {length, angle, of(key)}: units of a document's numbers; of() is for what the document names by itself.
export function unitsOf(document) {
  const units = document?.units ?? {};
  const length = pretty(units.length ?? "mm");
  const angle = pretty(units.angle ?? "deg");
  return { length, angle, of: (key, otherwise = "") => pretty(units[key] ?? otherwise) };
}

export const metresPer = (unit) => METRES[unit] ?? METRES.mm;
export const radiansPer = (unit) => RADIANS[unit] ?? DEGREE;

// The members of max_error and of all that has its shape.
export const ERRORS = [
  { key: "x", label: "x", kind: "length" },
  { key: "y", label: "y", kind: "length" },
  { key: "z", label: "z", kind: "length" },
  { key: "rx", label: "rx", kind: "angle" },
  { key: "ry", label: "ry", kind: "angle" },
  { key: "rz", label: "rz", kind: "angle" },
  { key: "position", label: "position, any direction", kind: "length" },
  { key: "rotation", label: "rotation, any axis", kind: "angle" },
];

// The two that sum an error up.
export const SIZES = [
  { key: "position", label: "Position", kind: "length" },
  { key: "rotation", label: "Rotation", kind: "angle" },
];
