// Numbers and parameter names as people write them. Whatever is not a finite number becomes an em dash.

export const MISSING = "—";
const MINUS = "−";

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

// Digits after the point that show `sigma` with two significant digits.
export function decimalsFor(sigma, fallback = 3) {
  if (!isNumber(sigma) || sigma <= 0) return fallback;
  return Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(sigma))));
}

export function fixed(value, decimals) {
  if (!isNumber(value)) return MISSING;
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

export function signed(value, decimals) {
  const text = fixed(value, decimals);
  return isNumber(value) && value > 0 && Number(text) !== 0 ? `+${text}` : text;
}

// Three significant digits by default; powers of ten where plain digits would be unreadable.
export function significant(value, digits = 3) {
  if (!isNumber(value)) return MISSING;
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent >= -4 && exponent < 7) return fixed(value, Math.max(0, digits - 1 - exponent));
  const mantissa = fixed(value / 10 ** exponent, digits - 1);
  return `${mantissa}·10${superscript(exponent)}`;
}

const superscript = (exponent) =>
  [...String(exponent)].map((character) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[character] ?? "⁻").join("");

export const withUnit = (text, unit) => (text === MISSING || !unit ? text : `${text} ${unit}`);

export const percent = (fraction) =>
  isNumber(fraction) ? withUnit(significant(100 * fraction, 2), "%") : MISSING;

export function plural(count, noun, many = `${noun}s`) {
  return `${count ?? MISSING} ${count === 1 ? noun : many}`;
}

// A sentence as a sentence: capital first, full stop last.
export function sentence(text) {
  const trimmed = String(text ?? "").trim();
  if (!trimmed) return "";
  return trimmed[0].toUpperCase() + trimmed.slice(1) + (/[.!?…]$/.test(trimmed) ? "" : ".");
}

const LENGTH = { unit: "mm", scale: 1e3 };
const PIXELS = { unit: "px", scale: 1 };
const PURE = { unit: "", scale: 1 };
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
