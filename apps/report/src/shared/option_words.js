// Options of a run, and what else has a name and a value, as people read them.
import { MISSING } from "./format.js";

export const spaced = (name) => name.replaceAll("_", " ");

export function inText(value) {
  if (value === null || value === undefined || value === "") return MISSING;
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return value.length ? value.map(inText).join(", ") : "none";
  if (typeof value === "object") {
    return (
      Object.entries(value)
        .map(([name, part]) => `${spaced(name)}: ${inText(part)}`)
        .join("; ") || "none"
    );
  }
  return String(value);
}
