// Writes the data of an intrinsics page as the program would: node make_intrinsics_data.mjs [KIND]
//   tags          36 tags in 24 pictures, some of them with faults
//   corners       186 views of 100 corners from a file, without pictures, by a lens model that does not fit
//   not_flat      the same as tags, but no camera: the corners are known, their residuals are not
//   undetermined  no camera, and nothing else either
// Views, noise, information, maps and halves are made here, simply: the camera found is the true one, moved by what its
// covariance allows.
import {
  choleskyOf,
  byCamera,
  direction,
  identity,
  multiplied,
  projected,
  scaled,
  sumOf,
  tiltedBy,
  withoutMotion,
} from "./example_camera.mjs";
import {
  cross,
  crossed,
  dot,
  jacobian,
  norm,
  normalMatrix,
  placed,
  plus,
  solved,
  times,
} from "./example_geometry.mjs";
import { png } from "./example_pictures.mjs";
import { Random } from "./example_random.mjs";

const KIND = process.argv[2] ?? "tags";
const DEGREE = Math.PI / 180;
const NAMES = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
const OUTLIER_SIGMAS = 6;
const FULL_WEIGHT_SIGMAS = 3;

const TAGS = {
  width: 1280,
  height: 960,
  lens: "brown-conrady",
  truth: [1010, 1011.2, 645.3, 471.8, -0.284, 0.0913, 0.0006, -0.0004, -0.0127],
  noise: 0.06,
  views: 24,
  distance: [0.35, 0.75],
  outliers: 0.006,
  misfit: 0,
  step: 0.006,
  grid: [24, 18],
  distances: [0.4, 0.55, 1, null],
};
const CORNERS = {
  ...TAGS,
  width: 6016,
  height: 4016,
  truth: [2900.5, 2901.4, 3002.1, 2009.7, -0.1, 0.01, 0.0002, -0.0003, 0],
  noise: 0.6,
  views: 186,
  distance: [0.55, 1.3],
  outliers: 0.002,
  misfit: 0.9,
  grid: [30, 20],
  distances: [0.9, 3, null],
};
const CASE = KIND === "corners" ? CORNERS : TAGS;
const random = new Random(KIND === "corners" ? 7 : 3);
const range = (count) => Array.from({ length: count }, (_, index) => index);
const rms = (values) =>
  Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / Math.max(1, values.length));

// The points of the board, m, middle at the origin, x right, y down; those of one tag one after the other.
const TAG_M = 0.03;
const SQUARE_M = 0.077;
const TAG_MIDDLES = range(36).map((tag) => [
  ((tag % 6) - 2.5) * 0.039,
  (Math.floor(tag / 6) - 2.5) * 0.039,
  0,
]);
const AROUND = [
  [-1, 1],
  [1, 1],
  [1, -1],
  [-1, -1],
];
const POINTS =
  KIND === "corners"
    ? range(100).map((i) => [((i % 10) - 4.5) * SQUARE_M, (Math.floor(i / 10) - 4.5) * SQUARE_M, 0])
    : TAG_MIDDLES.flatMap(([x, y]) => AROUND.map(([a, b]) => [x + (a * TAG_M) / 2, y + (b * TAG_M) / 2, 0]));
const HALF_BOARD_M = KIND === "corners" ? 5 * SQUARE_M : 0.125;
const OUTLINE = AROUND.map(([x, y]) => [x * HALF_BOARD_M, y * HALF_BOARD_M, 0]);

const isInside = ([u, v]) => u > 2 && v > 2 && u < CASE.width - 3 && v < CASE.height - 3;

// Lens models that do not fit err smoothly over the image: outward and inward with the distance from its middle.
function misfitAt([u, v]) {
  const away = [(u - CASE.width / 2) / (CASE.width / 2), (v - CASE.height / 2) / (CASE.width / 2)];
  return times(away, CASE.misfit * Math.sin(5 * norm(away)));
}

function robustWeight(sigmas) {
  if (sigmas <= FULL_WEIGHT_SIGMAS) return 1;
  const rest = (OUTLIER_SIGMAS - sigmas) / (OUTLIER_SIGMAS - FULL_WEIGHT_SIGMAS);
  return Math.max(0, rest) ** 2;
}

function cornerAt(camera, pose, point) {
  const pixel = projected(camera, placed(pose, point));
  const chance = random.uniform();
  const size = chance < CASE.outliers ? random.between(12, 60) : chance < 3 * CASE.outliers ? 4.5 : 1;
  const noise = [random.normal(), random.normal()].map((value) => value * CASE.noise * size);
  const residual = plus(times(noise, -1), misfitAt(pixel));
  return {
    point,
    pixel: plus(pixel, noise),
    residual,
    weight: robustWeight(norm(residual) / CASE.noise / 1.6),
  };
}

function viewOf(index) {
  const [tilt, towards] = [random.between(0, 0.72), random.between(0, 2 * Math.PI)];
  const distance = random.between(...CASE.distance);
  const aim = [random.between(0.2, 0.7) * CASE.width, random.between(0.25, 0.8) * CASE.height];
  const pose = {
    rotation_xyzw: tiltedBy(tilt, towards),
    translation_m: times(direction(CASE.truth, aim), distance),
  };
  const corners = visible(pose).map((point) => cornerAt(CASE.truth, pose, point));
  return { index, pose, tilt, towards, distance, corners };
}

// Of tags that are wholly inside the image, or of all points.
function visible(pose) {
  const inside = POINTS.map((point) => isInside(projected(CASE.truth, placed(pose, point))));
  if (KIND === "corners") return POINTS.filter((_, index) => inside[index]);
  return POINTS.filter((_, index) => {
    const tag = 4 * Math.floor(index / 4);
    return inside.slice(tag, tag + 4).every(Boolean);
  });
}

// What the view tells of the camera, its own pose eliminated, in 1 / px^2 of the noise.
function informationOf({ pose, corners }) {
  const counted = corners.filter(({ weight }) => weight > 0).map(({ point }) => point);
  if (counted.length < 4) return null;
  const pixels = (camera, at) => counted.flatMap((point) => projected(camera, placed(at, point)));
  const ofCamera = byCamera((camera) => pixels(camera, pose), CASE.truth);
  return scaled(
    withoutMotion(
      ofCamera,
      jacobian((at) => pixels(CASE.truth, at), pose),
    ),
    1 / CASE.noise ** 2,
  );
}

const CELLS = range(CASE.grid[0] * CASE.grid[1]).map((cell) => {
  const [column, row] = [cell % CASE.grid[0], Math.floor(cell / CASE.grid[0])];
  return [
    ((column + 0.5) * CASE.width) / CASE.grid[0] - 0.5,
    ((row + 0.5) * CASE.height) / CASE.grid[1] - 0.5,
  ];
});

const STILL = { rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0] };
const MIDDLE_DISTANCE_M = (CASE.distance[0] + CASE.distance[1]) / 2;
const FAR_M = 1e6;

// Of each cell the two rows by which its pixel follows the camera, and those by which it follows a motion before it.
function followedAt(distance) {
  const points = CELLS.map((pixel) => {
    const towards = direction(CASE.truth, pixel);
    return times(towards, distance / norm(towards));
  });
  const pixels = (camera, pose) => points.flatMap((point) => projected(camera, placed(pose, point)));
  return {
    rows: byCamera((camera) => pixels(camera, STILL), CASE.truth),
    motion: jacobian((pose) => pixels(CASE.truth, pose), STILL),
  };
}

// Less the motion that the boards make together as the camera changes.
const boards = followedAt(MIDDLE_DISTANCE_M);
const boardsMotion = solved(normalMatrix(boards.motion), crossed(boards.motion, boards.rows));
function mappedAt(distance) {
  const { rows, motion } = followedAt(distance ?? FAR_M);
  return rows.map((row, i) => plus(row, multiplied(motion[i], boardsMotion), -1));
}

const inPairs = (values) => range(values.length / 2).map((i) => [values[2 * i], values[2 * i + 1]]);
// Largest sigma in any direction, and its square over both, of each cell.
function spreadsOf(rows, root) {
  return inPairs(rows).map(([x, y]) => {
    const [a, b] = [multiplied(x, root), multiplied(y, root)];
    const [xx, yy] = [a, b].map((row) => row.reduce((sum, value) => sum + value * value, 0));
    const xy = a.reduce((sum, value, k) => sum + value * b[k], 0);
    return { largest: Math.sqrt((xx + yy) / 2 + Math.hypot((xx - yy) / 2, xy)), both: xx + yy };
  });
}

// Beyond its last two cells the lens model of this camera does not reach.
const isReached = (cell) => KIND === "corners" || (cell !== 0 && cell !== CASE.grid[0] - 1);
const whereReached = (values) => values.map((value, cell) => (isReached(cell) ? value : null));

function halvesOf(root) {
  const rows = mappedAt(CASE.distances[0]);
  const change = root.map((row) => row.map((value) => 2 * value));
  const draw = CASE.truth.map(() => random.normal());
  const moved = change.map((row) => row.reduce((sum, value, k) => sum + value * draw[k], 0));
  const noise = inPairs(rows.map((row) => row.reduce((sum, value, k) => sum + value * moved[k], 0)));
  const difference = noise.map((each, cell) => plus(each, misfitAt(CELLS[cell]), 0.35));
  return { difference, expected: spreadsOf(rows, change).map(({ both }) => Math.sqrt(both)) };
}

function crossValidationOf({ difference, expected }) {
  const [found, noise] = [rms(difference.map(norm)), rms(expected)];
  const ratio = rms(difference.map((each, cell) => norm(each) / expected[cell]));
  const misfit = ratio > 1.9;
  return {
    why_not: null,
    difference_rms_px: found,
    expected_rms_px: noise,
    ratio,
    ratio_limit: 1.9,
    misfit,
    sigma_factor: misfit ? 1.7 : 1,
    sentence: misfit
      ? `The lens model does not fit: cameras from either half of the views differ by ${found.toFixed(2)} px, where noise alone would make ${noise.toFixed(3)} px; try --lens rational`
      : `The lens model fits: cameras from either half of the views differ by ${found.toFixed(3)} px, and noise would make ${noise.toFixed(3)} px`,
  };
}

function coverageOf(views) {
  const [columns, rows] = KIND === "corners" ? [12, 8] : [8, 6];
  const corners = range(columns * rows).map(() => 0);
  for (const { corners: all } of views)
    for (const { pixel, weight } of all) {
      const cell = (at, size, count) =>
        Math.max(0, Math.min(count - 1, Math.floor(((at + 0.5) / size) * count)));
      if (weight > 0)
        corners[cell(pixel[1], CASE.height, rows) * columns + cell(pixel[0], CASE.width, columns)] += 1;
    }
  return { columns, rows, corners };
}

function nextView() {
  const centre = [0.83 * CASE.width, 0.24 * CASE.height];
  const [tilt, towards, distance] = [30 * DEGREE, 135 * DEGREE, CASE.distance[1]];
  const pose = {
    rotation_xyzw: tiltedBy(tilt, towards),
    translation_m: times(direction(CASE.truth, centre), distance),
  };
  return {
    shown: { outline_px: OUTLINE.map((point) => projected(CASE.truth, placed(pose, point))) },
    document: {
      sentence: `Add a view with the board in the upper right of the image, ${distance.toFixed(2)} m away, its lower left side 30° farther: the worst error over the image falls from 0.31 to 0.21 px`,
      centre_px: centre,
      tilt_rad: tilt,
      tilt_direction_rad: towards,
      distance_m: distance,
      now_px: 0.31,
      then_px: 0.21,
    },
  };
}

const PICTURE = { width: CASE.width / 4, height: CASE.height / 4 };
const RAYS =
  KIND !== "corners" &&
  range(PICTURE.width * PICTURE.height).map((i) =>
    direction(CASE.truth, [4 * (i % PICTURE.width) + 1.5, 4 * Math.floor(i / PICTURE.width) + 1.5]),
  );

// The picture of a view, a quarter as large as the camera's: black tags on white on grey.
function pictureOf({ pose }) {
  const { translation_m: origin } = pose;
  const [right, down] = [
    [1, 0, 0],
    [0, 1, 0],
  ].map((axis) => plus(placed(pose, axis), origin, -1));
  const normal = cross(right, down);
  return png(PICTURE.width, PICTURE.height, (x, y) => {
    const ray = RAYS[y * PICTURE.width + x];
    const point = plus(times(ray, dot(normal, origin) / dot(normal, ray)), origin, -1);
    return boardAt(dot(point, right), dot(point, down));
  });
}

function boardAt(u, v) {
  if (Math.max(Math.abs(u), Math.abs(v)) > HALF_BOARD_M) return 90;
  const [column, row] = [Math.floor(u / 0.039 + 3), Math.floor(v / 0.039 + 3)];
  const [a, b] = [(u - (column - 2.5) * 0.039) / TAG_M + 0.5, (v - (row - 2.5) * 0.039) / TAG_M + 0.5];
  if (a < 0 || a > 1 || b < 0 || b > 1) return 215;
  const [i, j] = [Math.floor(8 * a), Math.floor(8 * b)];
  const isBorder = i < 1 || j < 1 || i > 6 || j > 6;
  return !isBorder && (i * 7 + j * 13 + column * 5 + row * 3 + i * j * (column + 2)) % 3 === 0 ? 205 : 25;
}

const cornerRow = ({ pixel, residual, weight }) => [...pixel, ...residual, weight];

function shownView(view) {
  const { index, pose, tilt, towards, distance, corners } = view;
  const counted = corners.filter(({ weight }) => weight > 0);
  const missing = KIND === "corners" ? 0 : 36 - corners.length / 4;
  return {
    name: KIND === "corners" ? `view ${index}` : `board_${String(index).padStart(3, "0")}.png`,
    width: CASE.width,
    height: CASE.height,
    ...(KIND === "corners" ? {} : { picture: pictureOf({ pose }) }),
    left_out: null,
    rms_px: rms(counted.map(({ residual, weight }) => Math.sqrt(weight) * norm(residual))),
    tilt_rad: tilt,
    tilt_direction_rad: towards,
    distance_m: distance,
    corners: corners.map(cornerRow),
    left_out_corners: KIND !== "corners" && index % 6 === 2 ? unsharp(corners, index) : [],
    unused: missing ? [`${missing} tags: outside the image`] : [],
  };
}

const unsharp = (corners, index) =>
  corners.slice(0, 2).map(({ pixel: [x, y] }, corner) => ({
    x: x + 3,
    y: y - 2,
    what: `corner ${corner + 1} of tag ${index}`,
    why: `its edges are not straight: ${(0.4 + 0.1 * corner).toFixed(1)} px off`,
  }));

function leftOutView() {
  const view = shownView({ ...viewOf(CASE.views), corners: [] });
  return {
    ...view,
    left_out: "too few corners: 0 of 144; hold the board wholly in sight, and in focus",
    rms_px: null,
    tilt_rad: null,
    tilt_direction_rad: null,
    distance_m: null,
  };
}

function cameraOf(found, covariance) {
  const sigma = covariance.map((row, index) => Math.sqrt(row[index]));
  const named = ([fx, fy, cx, cy, ...distortion]) => ({ fx, fy, cx, cy, distortion });
  return {
    width_px: CASE.width,
    height_px: CASE.height,
    lens: CASE.lens,
    ...named(found),
    sigma: named(sigma),
  };
}

function uncertaintyOf(root) {
  const maps = CASE.distances.map((distance) => ({
    distance_m: distance,
    sigma_px: whereReached(spreadsOf(mappedAt(distance), root).map(({ largest }) => largest)),
  }));
  const uncertainty = maps.map(({ distance_m, sigma_px: all }) => {
    const known = all.filter((value) => value !== null);
    return { distance_m, rms_px: rms(known), worst_px: Math.max(...known) };
  });
  return { maps, uncertainty };
}

const warningsOf = ({ misfit, sentence }) => (misfit ? [sentence] : []);

function documentOf({ found, covariance, views, counts, uncertainty, validation, coverage, next, leftOut }) {
  return {
    status: "converged",
    message: "",
    warnings: warningsOf(validation),
    camera: cameraOf(found, covariance),
    ...counts,
    views_used: views.length,
    views_left_out: leftOut.map(({ name, left_out: why }) => ({ name, why })),
    board_warp_m: KIND === "corners" ? null : [0.00012, -0.00004],
    uncertainty,
    cross_validation: validation,
    coverage: {
      share: coverage.corners.filter(Boolean).length / coverage.corners.length,
      largest_tilt_rad: Math.max(...views.map(({ tilt }) => tilt)),
      sentence: `Corners in ${coverage.corners.filter(Boolean).length} of ${coverage.corners.length} cells of the image; the upper right is empty`,
    },
    next_view: next,
    time_s: { read: 0.42, detect: 1.31, solve: 0.094, covariance: 0.02, halves: 0.13, total: 1.98 },
    iterations: 11,
    program_version: "0.1.0",
    options: "--board board.yaml --lens brown-conrady",
    content_hash: "3f1c5a09b1de77aa",
  };
}

function countsOf(views) {
  const all = views.flatMap(({ corners }) => corners);
  const inliers = all.filter(({ weight }) => weight > 0);
  const coordinates = inliers.flatMap(({ residual, weight }) => times(residual, Math.sqrt(weight)));
  return {
    rms_px: Math.SQRT2 * rms(coordinates),
    noise_px: 1.02 * rms(coordinates),
    neighbour_noise_px: 1.01 * CASE.noise,
    corners_used: inliers.length,
    corners_left_out: all.length - inliers.length,
    corners_weighed_down: inliers.filter(({ weight }) => weight < 1).length,
  };
}

const correlationsOf = (covariance) => ({
  names: NAMES.slice(0, covariance.length).map((name, i) => `camera.${name}${i < 4 ? "_px" : ""}`),
  matrix: covariance.map((row, i) =>
    row.map((value, j) => value / Math.sqrt(covariance[i][i] * covariance[j][j])),
  ),
});

function pageData() {
  const views = range(CASE.views).map(viewOf);
  const covariance = solved(sumOf(views.map(informationOf).filter(Boolean)), identity(CASE.truth.length));
  const root = choleskyOf(covariance);
  const found = plus(
    CASE.truth,
    root.map((row) => row.reduce((sum, value) => sum + value * random.normal(), 0)),
  );
  const { maps, uncertainty } = uncertaintyOf(root);
  const halves = halvesOf(root);
  const coverage = coverageOf(views);
  const next = nextView();
  const leftOut = KIND === "corners" ? [] : [leftOutView()];
  const [columns, rows] = CASE.grid;
  return {
    title: KIND === "corners" ? "Wide lens" : "Lab camera",
    program_version: "0.1.0",
    board: KIND === "corners" ? "chessboard, 10 × 10 inner corners, 77 mm" : "36 tags tag36h11, 6 × 6, 30 mm",
    intrinsics: documentOf({
      found,
      covariance,
      views,
      counts: countsOf(views),
      uncertainty,
      validation: crossValidationOf(halves),
      coverage,
      next: next.document,
      leftOut,
    }),
    views: [...views.map(shownView), ...leftOut],
    maps: { columns, rows, maps },
    halves: {
      columns,
      rows,
      distance_m: CASE.distances[0],
      difference_px: whereReached(halves.difference),
      expected_px: whereReached(halves.expected),
    },
    coverage,
    next_view: next.shown,
    correlations: correlationsOf(covariance),
    options: { board: "board.yaml", lens: CASE.lens, warp: KIND !== "corners", "trust all": false },
  };
}

const UNDETERMINED = {
  title: "Lab camera",
  program_version: "0.1.0",
  board: "36 tags tag36h11, 6 × 6, 30 mm",
  intrinsics: {
    status: "undetermined",
    message:
      "the views leave the focal length open: the board was parallel to the image in all of them; tilt it",
    warnings: [],
    camera: null,
    rms_px: null,
    views_used: 0,
    views_left_out: null,
    cross_validation: null,
    uncertainty: [],
    next_view: null,
  },
};

const nothing = ["rms_px", "tilt_rad", "tilt_direction_rad", "distance_m"].map((name) => [name, null]);
const withoutFit = (view) => ({
  ...view,
  ...Object.fromEntries(nothing),
  corners: view.corners.map(([x, y]) => [x, y, null, null, null]),
});

function notFlatData() {
  const { views, ...data } = pageData();
  return {
    ...data,
    views: views.map(withoutFit),
    intrinsics: {
      status: "not_flat",
      message:
        "the corners are not where the board has them: half of them are more than 34 px off; check its rows",
      warnings: ["two views have another size"],
      views_left_out: data.intrinsics.views_left_out,
      time_s: 2.1,
    },
    maps: null,
    halves: null,
    coverage: null,
    next_view: null,
    correlations: null,
  };
}

const rounded = (_, value) => (typeof value === "number" ? Number(value.toPrecision(5)) : value);
const precise = (_, value) => (typeof value === "number" ? Number(value.toPrecision(9)) : value);
const MAKERS = { undetermined: () => UNDETERMINED, not_flat: notFlatData };
const data = (MAKERS[KIND] ?? pageData)();
const { intrinsics, ...rest } = data;
console.log(
  `${JSON.stringify(rest, rounded).slice(0, -1)},"intrinsics":${JSON.stringify(intrinsics, precise)}}`,
);
