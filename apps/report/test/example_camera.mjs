// A camera with OpenCV's five coefficients as [fx, fy, cx, cy, k1, k2, p1, p2, k3], and the matrices that tell of it.
import { crossed, fromRotationVector, normalMatrix, plus, solved, times } from "./example_geometry.mjs";

const range = (count) => Array.from({ length: count }, (_, index) => index);

export function projected([fx, fy, cx, cy, k1, k2, p1, p2, k3], [X, Y, Z]) {
  const [x, y] = [X / Z, Y / Z];
  const r2 = x * x + y * y;
  const radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return [
    fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx,
    fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + cy,
  ];
}

// The direction whose image is at a pixel, as a point at depth 1.
export function direction(camera, pixel) {
  const [fx, fy] = camera;
  let [x, y] = [0, 0];
  for (let step = 0; step < 30; ++step) {
    const [u, v] = projected(camera, [x, y, 1]);
    [x, y] = [x + (0.7 * (pixel[0] - u)) / fx, y + (0.7 * (pixel[1] - v)) / fy];
  }
  return [x, y, 1];
}

// The board tilted by an angle, where the side of it that lies in the direction (0: right; clockwise in the image) is
// the far one.
export const tiltedBy = (tilt, towards) =>
  fromRotationVector([tilt * Math.sin(towards), -tilt * Math.cos(towards), 0]);

// d f / d camera by central differences, a row for each number of f.
export function byCamera(f, camera) {
  const columns = camera.map((value, index) => {
    const step = 1e-6 * (index < 4 ? 1000 : 1);
    const at = (sign) => f(camera.map((each, other) => (other === index ? value + sign * step : each)));
    return times(plus(at(1), at(-1), -1), 1 / (2 * step));
  });
  return columns[0].map((_, row) => columns.map((column) => column[row]));
}

export const scaled = (rows, scale) => rows.map((row) => times(row, scale));
export const sumOf = (matrices) => matrices.reduce((sum, each) => sum.map((row, i) => plus(row, each[i])));
export const identity = (size) => range(size).map((i) => range(size).map((j) => Number(i === j)));

// a^T a after the best combination of the motion's columns is taken out of each column of a.
export function withoutMotion(a, motion) {
  const both = crossed(a, motion);
  const best = solved(normalMatrix(motion), crossed(motion, a));
  return normalMatrix(a).map((row, i) =>
    row.map((value, j) => value - both[i].reduce((sum, each, k) => sum + each * best[k][j], 0)),
  );
}

export function choleskyOf(matrix) {
  const root = matrix.map((row) => row.map(() => 0));
  matrix.forEach((row, i) => {
    for (let j = 0; j <= i; ++j) {
      const rest = row[j] - range(j).reduce((sum, k) => sum + root[i][k] * root[j][k], 0);
      root[i][j] = i === j ? Math.sqrt(rest) : rest / root[j][j];
    }
  });
  return root;
}

export const multiplied = (row, matrix) =>
  matrix[0].map((_, j) => row.reduce((sum, value, k) => sum + value * matrix[k][j], 0));
