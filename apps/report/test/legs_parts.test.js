import assert from "node:assert/strict";
import { test } from "node:test";
import { unitOf } from "../src/legs/figures.js";
import { inList, judge } from "../src/legs/judgement.js";
import { placesIn, statesOf } from "../src/legs/maps.js";
import { byVerdict, ordered } from "../src/legs/sets.js";
import { edgesOf, edgesSentence, otherModes } from "../src/legs/wording.js";
import { zeroLines } from "../src/legs/zero_lines.js";
import { STATE } from "../src/shared/map_grid.js";
import { robotAlong, rotationVector } from "../src/shared/robot_geometry.js";
import { fromRotationVector } from "./example_geometry.mjs";

const grid = (xs, ys, of) => ys.map((y) => xs.map((x) => of(x, y)));
const range = (count, step = 1) => Array.from({ length: count }, (_, index) => step * index);
const held = (directions, lines) => ({
  controllability: { status: directions },
  by_lines: { status: lines },
});

test("a line of zeros is found where it is, and is whole", () => {
  const [xs, ys] = [range(12, 0.5), range(9, 0.25)];
  const line = (x, y) => x - 2 * y - 0.3;
  const pieces = zeroLines(xs, ys, grid(xs, ys, line));
  let length = 0;
  for (const { x1, y1, x2, y2 } of pieces) {
    for (const [x, y] of [
      [x1, y1],
      [x2, y2],
    ])
      assert.ok(Math.abs(line(x, y)) < 1e-12, `${x}, ${y}`);
    length += Math.hypot(x2 - x1, y2 - y1);
  }
  assert.ok(Math.abs(length - Math.hypot(2 * 2, 2)) < 1e-12, `${length}`);
});

test("zeros of a circle close around it, to the order of the grid's step squared", () => {
  const xs = range(41, 0.1).map((x) => x - 2);
  const pieces = zeroLines(
    xs,
    xs,
    grid(xs, xs, (x, y) => x * x + y * y - 1.7),
  );
  const radius = Math.sqrt(1.7);
  const length = pieces.reduce((sum, { x1, y1, x2, y2 }) => sum + Math.hypot(x2 - x1, y2 - y1), 0);
  assert.ok(Math.abs(length - 2 * Math.PI * radius) < 0.02, `${length}`);
  for (const { x1, y1 } of pieces) assert.ok(Math.abs(Math.hypot(x1, y1) - radius) < 0.003);
});

test("no line of zeros is drawn along the border of what is not known, nor where nothing changes its sign", () => {
  const xs = range(5);
  assert.deepEqual(
    zeroLines(
      xs,
      xs,
      grid(xs, xs, (x) => (x < 2 ? null : 1)),
    ),
    [],
  );
  assert.deepEqual(
    zeroLines(
      xs,
      xs,
      grid(xs, xs, () => null),
    ),
    [],
  );
  assert.deepEqual(zeroLines(xs, xs, []), []);
});

test("at a saddle the lines go around the corners that the middle is not with", () => {
  const pieces = zeroLines(
    [0, 1],
    [0, 1],
    [
      [3, -1],
      [-1, 3],
    ],
  );
  assert.equal(pieces.length, 2);
  // The middle is positive, so the negative corners (1, 0) and (0, 1) are each cut off.
  for (const { x1, y1, x2, y2 } of pieces) {
    const middle = [(x1 + x2) / 2, (y1 + y2) / 2];
    assert.ok(Math.abs(middle[0] - middle[1]) > 0.5, `${middle}`);
  }
});

test("a rotation vector is that of the shorter way, whatever the quaternion's sign", () => {
  for (const vector of [
    [0.1, -0.2, 0.3],
    [0, 0, 3.1],
    [1e-9, 0, 0],
    [0, 0, 0],
  ]) {
    const quaternion = fromRotationVector(vector);
    for (const sign of [1, -1]) {
      const found = rotationVector(quaternion.map((value) => sign * value));
      found.forEach((value, axis) => assert.ok(Math.abs(value - vector[axis]) < 1e-12, `${found}`));
    }
  }
});

test("a leg is drawn along its joints, without a segment of no length, and not at all out of reach", () => {
  const robot = { legs: [0, 1, 2].map((x) => ({ base_joint_m: [x, 0, 0], radius_m: 0.01 })) };
  const places = [
    { start_m: [0, 0, 0], platform_joint_m: [0, 0, 1] },
    { start_m: [1, 1, 0], platform_joint_m: [1, 1, 1] },
    { start_m: null, platform_joint_m: [2, 0, 1] },
  ];
  const { legs } = robotAlong(robot, places, { rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 1] });
  assert.deepEqual(
    legs.map(({ segments }) => segments?.length ?? null),
    [1, 2, null],
  );
  assert.deepEqual(legs[1].segments[1], { from: [1, 1, 0], to: [1, 1, 1], radius: 0.01 });
});

test("other modes are those besides the goal, and say whether they are all", () => {
  const modes = [{}, {}, {}];
  assert.equal(otherModes({ status: "complete", modes }).text, "2");
  assert.equal(otherModes({ status: "incomplete", modes }).text, "2 or more");
  assert.equal(otherModes({ status: "infinite", modes: [] }).text, "infinitely many");
  assert.equal(otherModes({ status: "unreachable", modes: [] }).text, "—");
  assert.equal(otherModes(null).text, "—");
});

test("sets that edges hold and directions do not are named, those that both hold are not", () => {
  const sets = [
    { legs: [1, 2], ...held("uncontrollable", "controllable") },
    { legs: [3], ...held("uncontrollable", "uncontrollable") },
    { legs: [1, 2, 3], ...held("controllable", "controllable") },
  ];
  assert.deepEqual(
    sets.map((set) => edgesOf(set).gained),
    [true, false, false],
  );
  assert.match(edgesSentence(sets), /1 set holds .*: 1, 2\.$/);
  assert.match(edgesSentence(sets.slice(1)), /no set/);
});

test("sets that have no number come last, and what is alike stays in order", () => {
  const sets = [
    { n: Infinity, k: 1 },
    { n: 2, k: 2 },
    { n: 1, k: 3 },
    { n: 2, k: 4 },
    { n: Infinity, k: 5 },
  ];
  assert.deepEqual(
    ordered(sets, ({ n }) => n).map(({ k }) => k),
    [3, 2, 4, 1, 5],
  );
});

test("neighbours of one verdict form a group with their number", () => {
  const sets = ["possible", "possible", "misled"].map((verdict) => ({ verdict }));
  assert.deepEqual(
    byVerdict(sets).map(({ label, rows }) => [label, rows.length]),
    [
      ["Arrives, proved: 2 sets", 2],
      ["Misled: 1 set", 1],
    ],
  );
});

test("what is within reach and has no value is singular, what is out of reach stays so", () => {
  const states = [["fine", "outside-joint-ranges", "out-of-reach", "fine"]];
  assert.deepEqual(statesOf(states, [[1, 2, null, null]]), [
    [STATE.fine, STATE.outsideJointRanges, STATE.outOfReach, STATE.singular],
  ]);
});

test("the start is marked if what the slice holds is the same there, in the slice's units", () => {
  const pose = (translation_m, turn = [0, 0, 0]) => ({
    translation_m,
    rotation_xyzw: fromRotationVector(turn),
  });
  const maps = {
    x: { coordinate: "x" },
    y: { coordinate: "rz" },
    held: { x: 0.1, y: 0.2, z: 0.3, rx: 0, ry: 0, rz: 0 },
  };
  const to = pose([0.1, 0.2, 0.3]);
  const names = (from) => placesIn({ maps, from, to }).map(({ name }) => name);
  assert.deepEqual(names(pose([-0.1, 0.2, 0.3], [0, 0, 0.5])), ["goal", "start"]);
  assert.deepEqual(names(pose([-0.1, 0.25, 0.3])), ["goal"]);
  const [, start] = placesIn({ maps, from: pose([-0.1, 0.2, 0.3], [0, 0, Math.PI / 6]), to });
  assert.ok(Math.abs(start.x + 100) < 1e-9 && Math.abs(start.y - 30) < 1e-9, JSON.stringify(start));
});

test("a proved choice is green, one with a warning or without proof is not, none is red", () => {
  const set = {
    legs: [2, 3],
    verdict: "possible",
    why: "",
    path: { verdict: "free" },
    assembly_modes: { status: "complete", modes: [{}] },
    ...held("controllable", "controllable"),
  };
  const level = (document) => judge({ noise_rad: 1e-3, ...document }).level;
  assert.equal(level({ choice: [2, 3], sets: [set] }), "good");
  assert.equal(level({ choice: [2, 3], sets: [set], warnings: ["the robot itself is singular"] }), "care");
  assert.equal(level({ choice: [2, 3], sets: [{ ...set, verdict: "arrives", why: "no proof" }] }), "care");
  assert.equal(
    level({ choice: null, sets: [{ ...set, verdict: "misled", why: "it ends elsewhere" }] }),
    "bad",
  );
  assert.match(judge({ choice: [2, 3], sets: [set], noise_rad: 1e-3 }).headline, /^Watch legs 2 and 3$/);
  assert.equal(inList([1, 2, 3]), "1, 2 and 3");
});

test("members of the document have the units that their names say", () => {
  const units = {
    "sets.0.largest_error_at_goal.position_m": "mm",
    "from.translation_m.2": "mm",
    "sets.0.simulation.rotation_from_goal_rad": "°",
    "sets.0.simulation.largest_direction_error_rad": "mrad",
    "sets.0.simulation.time_s": "s",
    "robot_path.free_up_to": "%",
    "sets.0.assembly_modes.modes.1.largest_direction_error": "",
  };
  for (const [path, unit] of Object.entries(units)) assert.equal(unitOf(path).unit, unit, path);
});
