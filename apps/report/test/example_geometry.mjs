// What the makers of example data need of geometry and algebra, without packages. Quaternions are x, y, z, w.

export const dot = (a, b) => a.reduce((sum, value, index) => sum + value * b[index], 0);
export const plus = (a, b, scale = 1) => a.map((value, index) => value + scale * b[index]);
export const times = (a, scale) => a.map((value) => scale * value);
export const norm = (a) => Math.hypot(...a);
export const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];

export function product([x, y, z, w], [a, b, c, d]) {
  return [
    w * a + x * d + y * c - z * b,
    w * b - x * c + y * d + z * a,
    w * c + x * b - y * a + z * d,
    w * d - x * a - y * b - z * c,
  ];
}
export const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

export function turned(rotation, point) {
  const [x, y, z] = product(product(rotation, [...point, 0]), inverse(rotation));
  return [x, y, z];
}

export function fromRotationVector(vector) {
  const angle = norm(vector);
  return angle < 1e-12
    ? [...times(vector, 0.5), 1]
    : [...times(vector, Math.sin(angle / 2) / angle), Math.cos(angle / 2)];
}

export const rotationAngle = (a, b) => {
  const [x, y, z, w] = product(a, inverse(b));
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
};

// A pose {rotation_xyzw, translation_m} after a twist (v, w) in base.
export const moved = (pose, twist) => ({
  rotation_xyzw: product(fromRotationVector(twist.slice(3)), pose.rotation_xyzw),
  translation_m: plus(pose.translation_m, twist.slice(0, 3)),
});
export const placed = (pose, point) => plus(turned(pose.rotation_xyzw, point), pose.translation_m);

// d f / d twist at a pose, by central differences: rows of six numbers.
export function jacobian(f, pose, step = 1e-6) {
  const columns = [0, 1, 2, 3, 4, 5].map((axis) => {
    const twist = [0, 0, 0, 0, 0, 0];
    twist[axis] = step;
    const ahead = f(moved(pose, twist));
    twist[axis] = -step;
    return times(plus(ahead, f(moved(pose, twist)), -1), 1 / (2 * step));
  });
  return columns[0].map((_, row) => columns.map((column) => column[row]));
}

// The transpose of a times b, of matrices with as many rows.
export const crossed = (a, b) =>
  a[0].map((_, i) => b[0].map((__, j) => a.reduce((sum, row, k) => sum + row[i] * b[k][j], 0)));
export const normalMatrix = (rows) => crossed(rows, rows);

// The matrix after which `matrix` times it is `right`, by Gauss and Jordan.
export function solved(matrix, right) {
  const size = matrix.length;
  const system = matrix.map((row, i) => [...row, ...right[i]]);
  for (let column = 0; column < size; ++column) {
    const rest = system.slice(column);
    const pivot =
      column +
      rest.findIndex(
        (row) => Math.abs(row[column]) === Math.max(...rest.map((each) => Math.abs(each[column]))),
      );
    [system[column], system[pivot]] = [system[pivot], system[column]];
    for (let row = 0; row < size; ++row)
      if (row !== column)
        system[row] = plus(system[row], system[column], -system[row][column] / system[column][column]);
  }
  return system.map((row, i) => row.slice(size).map((value) => value / row[i]));
}

// The x that minimises |rows x - wanted|, by the normal equations.
export function leastSquares(rows, wanted) {
  const right = rows[0].map((_, i) => [rows.reduce((sum, row, k) => sum + row[i] * wanted[k], 0)]);
  return solved(normalMatrix(rows), right).map(([value]) => value);
}

// Singular values, the largest first: roots of the eigenvalues of the normal matrix by Jacobi rotations.
export function singularValues(rows) {
  const matrix = normalMatrix(rows);
  const size = matrix.length;
  for (let sweep = 0; sweep < 12; ++sweep)
    for (let p = 0; p < size; ++p) for (let q = p + 1; q < size; ++q) rotate(matrix, p, q);
  return matrix.map((row, i) => Math.sqrt(Math.max(0, row[i]))).sort((a, b) => b - a);
}

function rotate(matrix, p, q) {
  if (Math.abs(matrix[p][q]) < 1e-300) return;
  const angle = 0.5 * Math.atan2(2 * matrix[p][q], matrix[q][q] - matrix[p][p]);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  for (const row of matrix) [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
  [matrix[p], matrix[q]] = [
    plus(times(matrix[p], c), matrix[q], -s),
    plus(times(matrix[p], s), matrix[q], c),
  ];
}
