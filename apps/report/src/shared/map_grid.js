// A slice of the workspace as a grid of cells. No page elements here.
import { colorScaleOf } from "./color_map.js";
import { isNumber } from "./format.js";

export const STATE = { fine: 0, outsideJointRanges: 1, singular: 2, outOfReach: 3 };
const SHARE_FOR_ITSELF = 0.05;

// Edges of the cells around equally spaced values: [first edge, last edge].
export function edgesOf(values) {
  const step = values.length > 1 ? (values.at(-1) - values[0]) / (values.length - 1) : 1;
  return [values[0] - step / 2, values.at(-1) + step / 2];
}

// [{x, y, value, state, column, row}] of all cells, row after row.
export function cellsOf(maps, quantity) {
  return maps.y.values.flatMap((y, row) =>
    maps.x.values.map((x, column) => ({
      x,
      y,
      column,
      row,
      value: quantity.values?.[row]?.[column] ?? null,
      state: maps.states?.[row]?.[column] ?? STATE.fine,
    })),
  );
}

// {type, domain, clamped}: the scale of the colours; null where no cell has a value. What lies within the joint ranges
// has all the colours, unless that is nearly nothing.
export function colorScale(cells) {
  const known = cells.filter(({ value }) => isNumber(value));
  if (known.length === 0) return null;
  const fine = known.filter(({ state }) => state === STATE.fine);
  const values = (fine.length >= SHARE_FOR_ITSELF * known.length ? fine : known).map(({ value }) => value);
  return colorScaleOf(values, { all: known.map(({ value }) => value) });
}

// Rows of equal state joined into strips: [{x1, x2, y1, y2}], so that a hatch has no seams from cell to cell.
export function stripsOf(maps, wanted) {
  const [left, right] = edgesOf(maps.x.values);
  const [bottom, top] = edgesOf(maps.y.values);
  const width = (right - left) / maps.x.values.length;
  const height = (top - bottom) / maps.y.values.length;
  return (maps.states ?? []).flatMap((states, row) => {
    const strips = [];
    states.forEach((state, column) => {
      if (!wanted(state)) return;
      const last = strips.at(-1);
      if (last?.end === column) last.end = column + 1;
      else strips.push({ start: column, end: column + 1 });
    });
    return strips.map(({ start, end }) => ({
      x1: left + start * width,
      x2: left + end * width,
      y1: bottom + row * height,
      y2: bottom + (row + 1) * height,
    }));
  });
}
