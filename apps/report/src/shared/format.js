// Numbers and sentences as people write them. Whatever is not a finite number becomes an em dash.

export const MISSING = "—";
export const MINUS = "−";

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

// A number on an axis: no more digits than it needs.
export function tick(value) {
  const [number, power] = significant(value, 4).split("·");
  const short = number.includes(".") ? number.replace(/\.?0+$/, "") : number;
  return power ? `${short}·${power}` : short;
}

export const superscript = (exponent) =>
  [...String(exponent)].map((character) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[character] ?? "⁻").join("");

// What stands between a number and its unit, with the unit.
export const afterNumber = (unit) => (unit === "°" ? unit : ` ${unit}`);
export const withUnit = (text, unit) => (text === MISSING || !unit ? text : text + afterNumber(unit));

// "650.12 ± 0.04 px", the digits decided by sigma.
export function plusMinus(value, sigma, unit) {
  if (!isNumber(value)) return MISSING;
  const decimals = decimalsFor(sigma, 1);
  const spread = isNumber(sigma) && sigma > 0 ? ` ± ${fixed(sigma, decimals)}` : "";
  return withUnit(fixed(value, decimals) + spread, unit);
}

export const percent = (fraction) =>
  isNumber(fraction) ? withUnit(significant(100 * fraction, 2), "%") : MISSING;

export function plural(count, noun, many = `${noun}s`) {
  return `${count ?? MISSING} ${count === 1 ? noun : many}`;
}

export const capitalized = (text) => text.charAt(0).toUpperCase() + text.slice(1);

// A sentence as a sentence: capital first, full stop last.
export function sentence(text) {
  const trimmed = String(text ?? "").trim();
  if (!trimmed) return "";
  return capitalized(trimmed) + (/[.!?…]$/.test(trimmed) ? "" : ".");
}
