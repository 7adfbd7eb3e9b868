// Writes the data of a servo page as the program would: node make_servo_data.mjs [CYCLES | stopped] > DATA.json
// servo_data.json is what it writes for 60 cycles. The run is simulated here, simply: an edge-based law (all edges of a
// hexapod that one camera sees, derivatives by differences) with a speed limit, a leg that hides for a while, and noise.
// "stopped" is a run that ends in its second cycle, of which little is known.
import {
  cross,
  dot,
  jacobian,
  leastSquares,
  moved,
  norm,
  placed,
  plus,
  rotationAngle,
  singularValues,
  times,
} from "./example_geometry.mjs";
import { png } from "./example_pictures.mjs";
import { Random } from "./example_random.mjs";

const IS_STOPPED = process.argv[2] === "stopped";
const CYCLES = IS_STOPPED ? 2 : Number(process.argv[2] ?? 60);
const DURATION_S = 2.4; // in which the error falls to its noise
const PERIOD_S = CYCLES > 120 ? 0.02 : DURATION_S / 60;
const GAIN_PER_S = 7.2 / (CYCLES * PERIOD_S);
const SPEED_LIMIT_M_PER_S = 0.6 * GAIN_PER_S * 0.045;
const NOISE_PX = 0.03;
const TOLERANCE_PX = 0.25;
const LEAST_CONDITIONING = 0.005; // of what is seen; below three times this the robot slows down
const HIDDEN = { leg: 3, from: 0.2, to: 0.27 }; // 0-based; shares of the run
const RADIUS_M = 0.01;
const ARM_M = 0.2; // that makes rotations comparable with translations

const CAMERA = { width: 1280, height: 960, focal: 1250, cx: 639.5, cy: 479.5 };
const CAMERA_FROM_BASE = {
  rotation_xyzw: [0.518849851, 0.550845912, -0.489188099, 0.433657257],
  translation_m: [0.021, 0.156, 0.975],
};
const RANGE_M = [0.345, 0.485];
const JOINTS = [
  [
    [0.26925755, 0.020009292, 0],
    [0.19397229, -0.019993764, 0],
  ],
  [
    [0.26925755, -0.020009292, 0],
    [-0.079671038, -0.177981813, 0],
  ],
  [
    [-0.15195733, 0.223179232, 0],
    [-0.079671038, 0.177981813, 0],
  ],
  [
    [-0.117300219, 0.243188525, 0],
    [0.19397229, 0.019993764, 0],
  ],
  [
    [-0.117300219, -0.243188525, 0],
    [-0.114301252, -0.157988049, 0],
  ],
  [
    [-0.15195733, -0.223179232, 0],
    [-0.114301252, 0.157988049, 0],
  ],
];
const HOME = { rotation_xyzw: [0, 0, 0.5, 0.866025404], translation_m: [0, 0, 0.312370627] };
const START = moved(HOME, [-0.028, 0.03, 0.012, 0.06, -0.07, 0.12]);
const GOAL = moved(HOME, [0.025, -0.02, 0.045, -0.05, 0.06, -0.1]);
// Of the true robot from where its readings say that it is, at the goal and growing with the distance from it.
const MODEL_ERROR = [0.0004, -0.0003, 0.0002, 0.0006, 0.0004, -0.0008];

const random = new Random(1);

const legEnds = (pose) => JOINTS.map(([base, platform]) => [base, placed(pose, platform)]);
const legLengths = (pose) => legEnds(pose).map(([a, b]) => norm(plus(b, a, -1)));
const inCamera = (point) => placed(CAMERA_FROM_BASE, point);
const pixel = ([x, y, z]) => [CAMERA.focal * (x / z) + CAMERA.cx, CAMERA.focal * (y / z) + CAMERA.cy];

// Each edge of each leg: normal of its plane in the camera, and the points that its ends have in the image.
function edgesAt(pose) {
  return legEnds(pose).flatMap((ends, index) => {
    const [a, b] = ends.map(inCamera);
    const u = times(plus(b, a, -1), 1 / norm(plus(b, a, -1)));
    const moment = cross(a, u);
    const h = norm(moment);
    const [sine, side] = [RADIUS_M / h, times(moment, 1 / h)];
    const inward = times(cross(u, side), -sine);
    return [-1, 1].map((sign, edge) => {
      const outward = plus(inward, side, sign * Math.sqrt(1 - sine * sine));
      const points = [a, b].map((end) => pixel(plus(end, outward, RADIUS_M)));
      return { leg: index + 1, edge: edge + 1, direction: u, normal: outward, points };
    });
  });
}

// Distance (px) of a point of the image from an edge, positive outside the leg.
function distance({ normal: [nx, ny, nz] }, [x, y]) {
  const [a, b] = [nx / CAMERA.focal, ny / CAMERA.focal];
  return (a * (x - CAMERA.cx) + b * (y - CAMERA.cy) + nz) / Math.hypot(a, b);
}

const DESIRED = edgesAt(GOAL);
// Of the desired edges' ends from the current edges, two numbers an edge.
const residuals = (pose) =>
  edgesAt(pose).flatMap((edge, index) => DESIRED[index].points.map((point) => distance(edge, point)));
const comparable = (rows) => rows.map((row) => row.map((value, axis) => (axis < 3 ? value * ARM_M : value)));
const rms = (values) => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
const isSeen = (edge, cycle) =>
  edge.leg - 1 !== HIDDEN.leg || cycle / CYCLES < HIDDEN.from || cycle / CYCLES > HIDDEN.to;

function trueOf(pose) {
  const far = 1 + norm(plus(pose.translation_m, GOAL.translation_m, -1)) / 0.03;
  return moved(pose, times(MODEL_ERROR, far));
}

function step(pose, cycle) {
  const edges = edgesAt(pose);
  const seen = edges.map((edge) => isSeen(edge, cycle));
  const all = residuals(pose).map((value) => value + NOISE_PX * random.normal());
  const rows = jacobian(residuals, pose);
  const used = all.map((_, index) => index).filter((index) => seen[Math.floor(index / 2)]);
  const toGoal = leastSquares(
    used.map((index) => rows[index]),
    used.map((index) => -all[index]),
  );
  const robot = jacobian(legLengths, pose);
  const asked = robot.map((row) => GAIN_PER_S * dot(row, toGoal));
  const fastest = asked.reduce(
    (best, speed, index) => (Math.abs(speed) > Math.abs(asked[best]) ? index : best),
    0,
  );
  const factor = Math.min(1, SPEED_LIMIT_M_PER_S / Math.abs(asked[fastest]));
  const observed = singularValues(comparable(used.map((index) => rows[index])));
  const singularity = slowing(observed[5] / observed[0]);
  const taken = factor * singularity;
  return {
    pose,
    edges,
    seen,
    all,
    used,
    factor,
    fastest,
    singularity,
    observed,
    own: singularValues(comparable(robot)),
    speeds: times(asked, taken),
    twist: times(toGoal, GAIN_PER_S * taken * PERIOD_S),
  };
}

const slowing = (conditioning) => Math.max(0, Math.min(1, (conditioning / LEAST_CONDITIONING - 1) / 2));

function limitsOf({ factor, fastest, singularity }) {
  const percent = (share) => `${(100 * share).toFixed(0)} %`;
  return [
    factor < 1 && `all at ${percent(factor)} so that leg ${fastest + 1} keeps its speed limit`,
    singularity < 1 && `slowed to ${percent(singularity)} near a singularity of what is seen`,
  ]
    .filter(Boolean)
    .join("; ");
}

const directionErrors = ({ edges, seen }) =>
  [0, 2, 4, 6, 8, 10].map((index) =>
    seen[index] ? Math.acos(Math.min(1, dot(edges[index].direction, DESIRED[index].direction))) : null,
  );
const edgeErrors = ({ all, seen }) =>
  seen.map((is, index) => (is ? rms(all.slice(2 * index, 2 * index + 2)) : null));

function run() {
  const steps = [];
  for (let cycle = 0, pose = START; cycle < CYCLES; ++cycle) {
    steps.push(step(pose, cycle));
    pose = moved(pose, steps[cycle].twist);
  }
  return steps;
}

const numbers = (values) => values.filter((value) => value !== null);

function cyclesOf(steps) {
  const error = steps.map(({ all, used }) => rms(used.map((index) => all[index])));
  return {
    time_s: steps.map((_, index) => index * PERIOD_S),
    error,
    tolerance: steps.map(() => TOLERANCE_PX),
    edge_error_px: error,
    direction_error_rad: steps.map((each) => rms(numbers(directionErrors(each)))),
    gain_per_s: steps.map(() => GAIN_PER_S),
    conditioning: steps.map(({ observed }) => observed[5] / observed[0]),
    smallest_singular_value: steps.map(({ observed }) => observed[5]),
    robot_conditioning: steps.map(({ own }) => own[5] / own[0]),
    speed_factor: steps.map(({ factor }) => factor),
    singularity_factor: steps.map(({ singularity }) => singularity),
    edges: steps.map(({ seen }) => seen.filter(Boolean).length),
    look_s: steps.map(() => 0.0021 * Math.exp(0.12 * random.normal())),
    law_s: steps.map(() => 9e-6 * Math.exp(0.2 * random.normal())),
    limits: steps.map(limitsOf),
    joint_speeds_m_per_s: steps.map(({ speeds }) => speeds),
    joint_readings_m: steps.map(({ pose }) => legLengths(pose)),
    edge_errors_px: steps.map(edgeErrors),
    direction_errors_rad: steps.map(directionErrors),
    poses: steps.map(({ pose }) => pose),
    true_poses: steps.map(({ pose }) => trueOf(pose)),
  };
}

const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.ceil(share * values.length) - 1)];
const timesOf = (values) => ({ median: quantile(values, 0.5), p99: quantile(values, 0.99) });

function pathOf(poses) {
  const points = poses.map(({ translation_m: point }) => point);
  const along = plus(GOAL.translation_m, points[0], -1);
  const away = (point) => norm(cross(plus(point, points[0], -1), along)) / norm(along);
  const length = points.slice(1).reduce((sum, point, index) => sum + norm(plus(point, points[index], -1)), 0);
  return { length_m: length, deviation_m: Math.max(...points.map(away)) };
}

function documentOf(cycles) {
  const last = (name) => cycles[name][CYCLES - 1];
  const end = last("true_poses");
  return {
    status: "converged",
    reason: `${last("error").toFixed(2)} px left, within the tolerance of ${TOLERANCE_PX} px`,
    mode: "edges",
    unit: "px",
    legs: [1, 2, 3, 4, 5, 6],
    iterations: CYCLES,
    time_s: CYCLES * PERIOD_S,
    final_error: last("error"),
    tolerance: TOLERANCE_PX,
    final_edge_error_px: last("edge_error_px"),
    final_direction_error_rad: last("direction_error_rad"),
    final_pose_error: {
      position_m: norm(plus(end.translation_m, GOAL.translation_m, -1)),
      rotation_rad: rotationAngle(end.rotation_xyzw, GOAL.rotation_xyzw),
    },
    path: pathOf(cycles.poses),
    max_joint_speed_m_per_s: Math.max(...cycles.joint_speeds_m_per_s.flat().map(Math.abs)),
    min_singular_value: Math.min(...cycles.smallest_singular_value),
    min_conditioning: Math.min(...cycles.conditioning),
    min_robot_conditioning: Math.min(...cycles.robot_conditioning),
    compute_time_s: timesOf(cycles.law_s),
    look_time_s: timesOf(cycles.look_s),
    warnings: [],
  };
}

const outlines = (edges) => edges.map(({ leg, edge, points }) => ({ leg, edge, points }));

function pictureOf(label, cycle, { pose, edges, seen }, image) {
  return {
    label,
    time_s: cycle * PERIOD_S,
    width_px: CAMERA.width,
    height_px: CAMERA.height,
    image: image && drawing(trueOf(pose)),
    current: outlines(edges.filter((_, index) => seen[index])),
    desired: outlines(DESIRED),
  };
}

// The legs as light bars on a dark ground, an eighth as large as the camera's images.
function drawing(pose) {
  const [width, height] = [CAMERA.width / 8, CAMERA.height / 8];
  const legs = [0, 2, 4, 6, 8, 10].map((index) => edgesAt(pose).slice(index, index + 2));
  return png(width, height, (x, y) => brightness(legs, [8 * x + 3.5, 8 * y + 3.5]));
}

function brightness(legs, point) {
  for (const edges of legs) {
    const [[from, to]] = edges.map(({ points }) => points);
    const along = plus(to, from, -1);
    const share = dot(plus(point, from, -1), along) / dot(along, along);
    const [inside, other] = edges.map((edge) => -distance(edge, point));
    if (inside > 0 && other > 0 && share > 0 && share < 1)
      return Math.round(90 + (110 * inside) / (inside + other));
  }
  return 40;
}

const SETTINGS = {
  mode: "edges",
  gain: `${Number(GAIN_PER_S.toPrecision(4))} 1/s`,
  "speed limit": `${Number((1e3 * SPEED_LIMIT_M_PER_S).toPrecision(4))} mm/s`,
  tolerance: `${TOLERANCE_PX} px`,
  "control period": `${Number((1e3 * PERIOD_S).toPrecision(4))} ms`,
};

function pageData() {
  const steps = run();
  const cycles = cyclesOf(steps);
  const middle = Math.floor(((HIDDEN.from + HIDDEN.to) / 2) * CYCLES);
  return {
    title: "DeltaLab hexapod",
    program_version: "0.1.0",
    model: "result/model.yaml",
    rig: "sim:truth.yaml",
    log: "run1",
    document: documentOf(cycles),
    settings: SETTINGS,
    robot: {
      legs: JOINTS.map(([base, platform]) => ({
        base_joint_m: base,
        platform_joint_m: platform,
        radius_m: RADIUS_M,
        joint_range_m: RANGE_M,
      })),
      speed_limit_m_per_s: SPEED_LIMIT_M_PER_S,
    },
    goal: { base_from_platform: GOAL, joint_readings_m: legLengths(GOAL) },
    cycles,
    pictures: [
      pictureOf("start", 0, steps[0], true),
      pictureOf("leg 4 hidden", middle, steps[middle], false),
      pictureOf("end", CYCLES - 1, steps[CYCLES - 1], true),
    ],
  };
}

// No goal pose, no truth, no pictures, and in the second cycle nothing was seen.
function stoppedData() {
  const { cycles, document, ...data } = pageData();
  const unseen = ["error", "edge_error_px", "direction_error_rad", "conditioning", "smallest_singular_value"];
  const blank = unseen.map((name) => [name, [cycles[name][0], null]]);
  const rows = ["edge_errors_px", "direction_errors_rad"].map((name) => [
    name,
    [cycles[name][0], cycles[name][0].map(() => null)],
  ]);
  return {
    ...data,
    document: {
      ...document,
      status: "stale-images",
      reason: "no fresh image: the newest is 0.12 s old",
      final_error: null,
      final_edge_error_px: null,
      final_direction_error_rad: null,
      final_pose_error: null,
      warnings: ["the run ended before anything was learnt from it"],
    },
    goal: { base_from_platform: null, joint_readings_m: null },
    cycles: { ...cycles, ...Object.fromEntries([...blank, ...rows]), edges: [12, 0], true_poses: null },
    pictures: [],
  };
}

const rounded = (_, value) => (typeof value === "number" ? Number(value.toPrecision(6)) : value);
console.log(JSON.stringify(IS_STOPPED ? stoppedData() : pageData(), rounded));
