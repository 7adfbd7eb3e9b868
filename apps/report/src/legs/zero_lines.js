// Where a signed quantity, known at the points of a grid, is zero. No page elements here.
import { isNumber } from "../shared/format.js";

// values[row][column] belongs to xs[column], ys[row]; null where it is not known. Returns straight pieces [{x1, y1, x2,
// y2}] between neighbouring points, all four of which have to be known, by linear interpolation along the grid's lines
// (marching squares).
export function zeroLines(xs, ys, values) {
  return ys.slice(1).flatMap((_, row) =>
    xs.slice(1).flatMap((__, column) => {
      const corners = CORNERS.map(([right, up]) => ({
        x: xs[column + right],
        y: ys[row + up],
        value: values[row + up]?.[column + right],
      }));
      return corners.every(({ value }) => isNumber(value)) ? piecesIn(corners) : [];
    }),
  );
}

// Around a square.
const CORNERS = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
];

function piecesIn(corners) {
  const crossings = corners.flatMap((a, index) => crossing(a, corners[(index + 1) % 4]));
  if (crossings.length < 4) return crossings.length === 2 ? [piece(...crossings)] : [];
  // A saddle: the middle says which corners belong together.
  const middle = corners.reduce((sum, { value }) => sum + value, 0);
  const [a, b, c, d] = crossings;
  const cutsFirst = middle >= 0 !== corners[0].value >= 0;
  return cutsFirst ? [piece(d, a), piece(b, c)] : [piece(a, b), piece(c, d)];
}

function crossing(a, b) {
  if (a.value >= 0 === b.value >= 0) return [];
  const share = a.value / (a.value - b.value);
  return [{ x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y) }];
}

const piece = (a, b) => ({ x1: a.x, y1: a.y, x2: b.x, y2: b.y });
