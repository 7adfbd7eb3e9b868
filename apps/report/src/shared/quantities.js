// The units that people read; `scale` takes SI to the unit.

export const METRES = { unit: "m", scale: 1 };
export const MM = { unit: "mm", scale: 1e3 };
export const MRAD = { unit: "mrad", scale: 1e3 };
export const DEGREES = { unit: "°", scale: 180 / Math.PI };
export const PX = { unit: "px", scale: 1 };
export const SECONDS = { unit: "s", scale: 1 };
export const PERCENT = { unit: "%", scale: 100 };
export const PURE = { unit: "", scale: 1 };
