// Names of parameters as people write them.
import { MINUS } from "./format.js";

const LENGTH = { unit: "mm", scale: 1e3 };
const PIXELS = { unit: "px", scale: 1 };
const PURE = { unit: "", scale: 1 };
const OPENCV = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
const FISHEYE = ["k1", "k2", "k3", "k4"];
const FIELDS = {
  fx_px: { label: "focal length fx", ...PIXELS },
  fy_px: { label: "focal length fy", ...PIXELS },
  cx_px: { label: "principal point cx", ...PIXELS },
  cy_px: { label: "principal point cy", ...PIXELS },
  base_joint_m: { label: "base joint A", ...LENGTH },
  base_joint_in_camera_m: { label: "base joint A in camera", ...LENGTH },
  platform_joint_m: { label: "platform joint B", ...LENGTH },
  radius_m: { label: "radius R", unit: "µm", scale: 1e6 },
  joint_offset_m: { label: "joint offset", ...LENGTH },
  edge_1_shift_px: { label: "shading shift of edge 1", ...PIXELS },
  edge_1_tilt_px: { label: "shading tilt of edge 1", ...PIXELS },
  edge_2_shift_px: { label: "shading shift of edge 2", ...PIXELS },
  edge_2_tilt_px: { label: "shading tilt of edge 2", ...PIXELS },
};

function unitBySuffix(name) {
  if (/_m\b/.test(name)) return LENGTH;
  if (/_rad\b/.test(name)) return { unit: "mrad", scale: 1e3 };
  return /_px\b/.test(name) ? PIXELS : PURE;
}

// The names of a camera's distortion coefficients, in order.
export const coefficientNames = ({ lens, distortion }) =>
  (lens === "fisheye" ? FISHEYE : OPENCV).slice(0, distortion?.length ?? 0);

// {group, label, unit, scale} of a parameter such as "legs[1].platform_joint_m.x"; scale takes SI to the unit.
export function describeParameter(name) {
  const [, leg, path] = /^(?:camera|legs\[(\d+)\])\.(.+)$/.exec(name) ?? [];
  if (!path) return { group: "Other", label: name, ...unitBySuffix(name) };
  const [field, component] = path.split(".");
  const known = FIELDS[field] ?? { label: field, ...unitBySuffix(path) };
  return {
    ...known,
    group: leg ? `Leg ${leg}` : "Camera",
    label: component ? `${known.label} ${component}` : known.label,
  };
}

export function parameterTitle(name) {
  const { group, label } = describeParameter(name);
  return group === "Other" ? label : `${group}: ${label}`;
}

const PARAMETER_NAME = /\bcamera\.(?:[fc][xy]_px|[kp]\d)\b|\blegs\[\d+\]\.\w+(?:\.\w+)?/g;

// Replaces parameter names inside a text by words.
export function inWords(text) {
  return String(text ?? "")
    .replace(PARAMETER_NAME, (name) => {
      const { group, label } = describeParameter(name);
      return `${group.toLowerCase()} ${label}`;
    })
    .replaceAll("(-)", `(${MINUS})`);
}
