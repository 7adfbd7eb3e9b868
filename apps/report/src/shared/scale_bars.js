// Bars of a round length that say how large a drawing is.
import { svg } from "./dom.js";
import { significant } from "./format.js";

const LONGEST_BAR = 150;
const STEPS = [1, 2, 5];

// The largest 1, 2 or 5 times a power of ten that does not exceed value.
export function roundBelow(value) {
  if (!(value > 0) || !Number.isFinite(value)) return 1;
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  const step = [...STEPS].reverse().find((each) => each * power <= value * (1 + 1e-12)) ?? 1;
  return Number((step * power).toPrecision(1));
}

// {value, length}: a round value whose bar is at most `longest` px.
export function scaleBar(pixelsPerUnit, longest) {
  const value = roundBelow(longest / pixelsPerUnit);
  return { value, length: value * pixelsPerUnit };
}

// bars: [{pixelsPerUnit, unit, text(value with unit)}], from the lower left upward.
export function paintScaleBars(bars, { height }) {
  return bars.map(({ pixelsPerUnit, unit, text, className }, index) => {
    const { value, length } = scaleBar(pixelsPerUnit, LONGEST_BAR);
    const y = height - 14 - 34 * index;
    return svg(
      "g",
      { class: `scale-bar ${className}` },
      svg("path", { d: `M14,${y - 5}v5h${length.toFixed(1)}v-5` }),
      svg("text", { x: 14, y: y - 10 }, text(`${significant(value, 1)} ${unit}`)),
    );
  });
}
