import assert from "node:assert/strict";
import { test } from "node:test";
import { angle, errorSeries, exponentialRate } from "../src/servo/error_series.js";
import { judge } from "../src/servo/judgement.js";
import { nearestEnd } from "../src/servo/legs.js";
import { deviations, straightWay } from "../src/servo/path_geometry.js";
import { viewOf } from "../src/servo/path_view.js";
import { shortTime, unitOf } from "../src/servo/quantities.js";
import { limitSpans, mergedSpans, periodOf } from "../src/servo/spans.js";
import { sparse, thinnedCurve } from "../src/shared/thinning.js";
import { logDomain, logTicks } from "../src/shared/time_plot.js";
import { barsOf, quantile } from "../src/servo/times.js";
import { leavesOf } from "../src/shared/document.js";
import { START, screenAxes } from "../src/shared/turntable.js";

const range = (count) => Array.from({ length: count }, (_, index) => index);
const dot = (a, b) => a.reduce((sum, value, index) => sum + value * b[index], 0);
const near = (found, wanted, tolerance = 1e-9) =>
  assert.ok(Math.abs(found - wanted) <= tolerance, `${found} is not ${wanted}`);

test("a thinned curve has few points, keeps every column's extremes and stays in order", () => {
  const count = 5000;
  const values = range(count).map((index) => Math.sin(index / 50));
  values[1234] = 7;
  values[4321] = -5;
  const points = thinnedCurve(range(count), values, 100);
  assert.ok(points.length <= 500);
  assert.deepEqual(points[0], { time: 0, value: values[0] });
  assert.deepEqual(points[points.length - 1], { time: count - 1, value: values[count - 1] });
  assert.ok(points.some(({ time, value }) => time === 1234 && value === 7));
  assert.ok(points.some(({ time, value }) => time === 4321 && value === -5));
  assert.ok(points.every(({ time }, index) => index === 0 || time > points[index - 1].time));
  for (const column of range(100)) {
    const all = values.slice(50 * column, 50 * column + 50);
    const kept = points.filter(({ time }) => time >= 50 * column && time < 50 * column + 50);
    assert.equal(Math.max(...kept.map(({ value }) => value)), Math.max(...all));
    assert.equal(Math.min(...kept.map(({ value }) => value)), Math.min(...all));
  }
});

test("a gap stays a gap when a curve is thinned, and short curves stay as they are", () => {
  const values = range(1000).map((index) => (index >= 400 && index < 420 ? null : index));
  const points = thinnedCurve(range(1000), values, 50);
  assert.ok(points.some(({ time, value }) => value === null && time >= 400 && time < 420));
  assert.ok(points.filter(({ value }) => value === null).every(({ time }) => time >= 400 && time < 420));
  assert.deepEqual(thinnedCurve([0, 1], [1, undefined], 50), [
    { time: 0, value: 1 },
    { time: 1, value: null },
  ]);
});

test("of a path no point is dropped that is far from the one kept before", () => {
  const points = range(1001).map((index) => [index / 1000, 0, 0]);
  points[500] = null;
  const kept = sparse(points, 0.1);
  assert.ok(kept.length <= 12);
  assert.equal(kept[0], 0);
  assert.equal(kept[kept.length - 1], 1000);
  assert.deepEqual(sparse([null, null], 1), []);
  assert.deepEqual(
    sparse(
      [
        [0, 0, 0],
        [5, 0, 0],
        [0, 0, 0],
      ],
      1,
    ),
    [0, 1, 2],
  );
});

test("clauses of limits become spans whose percentages are a range", () => {
  const times = [0, 1, 2, 3, 4, 5];
  const limits = [
    "all at 40 % so that leg 2 keeps its speed limit",
    "all at 55 % so that leg 2 keeps its speed limit; leg 3 held back at the longest",
    "",
    null,
    "leg 3 held back at the longest",
    "leg 3 held back at the longest",
  ];
  assert.deepEqual(limitSpans(times, limits), [
    {
      words: "leg 3 held back at the longest",
      cycles: 3,
      seconds: 3,
      spans: [
        { from: 1, to: 2 },
        { from: 4, to: 6 },
      ],
    },
    {
      words: "all at 40 to 55 % so that leg 2 keeps its speed limit",
      cycles: 2,
      seconds: 2,
      spans: [{ from: 0, to: 2 }],
    },
  ]);
  assert.deepEqual(limitSpans([0, 1], []), []);
  assert.equal(periodOf([0, 0.02, 0.04, 0.2]), 0.02);
  assert.equal(periodOf([3]), 0);
});

test("spans that overlap or are nearly joined are drawn as one", () => {
  const spans = [
    { from: 5, to: 6 },
    { from: 0, to: 2 },
    { from: 1, to: 1.5 },
    { from: 2.1, to: 3 },
  ];
  assert.deepEqual(mergedSpans(spans, 0.2), [
    { from: 0, to: 3 },
    { from: 5, to: 6 },
  ]);
  assert.equal(spans[1].to, 2);
});

test("the rate of an exponential fall is found above its floor and without the cycles under a limit", () => {
  const times = range(200).map((index) => index / 50);
  const limits = times.map((time) => (time < 0.5 ? "slow" : ""));
  const values = times.map((time) => (time < 0.5 ? 40 : 40 * Math.exp(-3 * (time - 0.5)) + 0.001));
  const { rate_per_s: rate, from_s: from } = exponentialRate(times, values, limits);
  near(rate, 3, 0.05);
  near(from, 0.5, 1e-12);
  assert.equal(
    exponentialRate(
      times,
      values.map(() => 1),
      limits,
    ),
    null,
  );
  assert.equal(exponentialRate([], [], []), null);
  assert.equal(exponentialRate([0, 1], [5, null], ["", ""]), null);
});

const POSE = { rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0.3] };
const run = (mode, error) => ({
  document: { mode, unit: mode === "edges" ? "px" : mode === "directions" ? "rad" : "m" },
  goal: { base_from_platform: POSE, joint_readings_m: [0.4, 0.4] },
  cycles: {
    error,
    edge_error_px: [4, 2],
    direction_error_rad: [0.01, 0.005],
    edge_errors_px: [
      [-4, null],
      [2, 1],
    ],
    poses: [
      { rotation_xyzw: [0, 0, Math.sin(0.05), Math.cos(0.05)], translation_m: [0.003, 0, 0.304] },
      POSE,
    ],
    true_poses: null,
    joint_readings_m: [
      [0.41, 0.38],
      [0.4, null],
    ],
  },
});

test("the controlled error comes first, in its unit, and is not repeated under another name", () => {
  const edges = errorSeries(run("edges", [4, 2]));
  assert.deepEqual(
    edges.map(({ key, unit }) => [key, unit]),
    [
      ["controlled", "px"],
      ["direction_error_rad", "mrad"],
      ["position by the readings", "mm"],
      ["rotation by the readings", "mrad"],
      ["joints", "mm"],
    ],
  );
  assert.deepEqual(
    edges[0].single.map(({ values }) => values),
    [
      [4, 2],
      [null, 1],
    ],
  );
  assert.ok(errorSeries(run("edges", [5, 2])).some(({ key }) => key === "edge_error_px"));
  const joints = errorSeries(run("joints", [0.02, 0.001]));
  assert.deepEqual(joints[0].values, [20, 1]);
});

test("errors of the pose and the joints are measured from the goal", () => {
  const of = (key) => errorSeries(run("edges", [4, 2])).find((series) => series.key === key).values;
  near(of("position by the readings")[0], 5, 1e-9);
  near(of("rotation by the readings")[0], 100, 1e-9);
  assert.equal(of("rotation by the readings")[1], 0);
  near(of("joints")[0], 20, 1e-9);
  assert.equal(of("joints")[1], null);
});

test("an angle of rotation does not depend on the signs of the quaternions, and is exact when small", () => {
  const small = { rotation_xyzw: [5e-9, 0, 0, 1] };
  near(angle(small, POSE), 1e-8, 1e-16);
  near(angle({ rotation_xyzw: [-5e-9, 0, 0, -1] }, POSE), 1e-8, 1e-16);
});

test("deviations are distances from the line, and from the start where there is none", () => {
  const way = { from: [0, 0, 0], to: [2, 0, 0] };
  assert.deepEqual(deviations([[1, 3, 4], [-1, 0, 0], null], way), [5, 0, null]);
  assert.deepEqual(deviations([[0, 3, 4]], { from: [0, 0, 0], to: [0, 0, 0] }), [5]);
  const data = { cycles: { poses: [null, POSE, { ...POSE, translation_m: [1, 0, 0] }] }, goal: null };
  assert.deepEqual(straightWay(data), { from: [0, 0, 0.3], to: [1, 0, 0], toGoal: false });
  assert.equal(straightWay({ cycles: { poses: [null] } }), null);
});

test("the first view sees the path's bend and is from above", () => {
  const way = { from: [0, 0, 0.3], to: [0.1, 0, 0.3] };
  const inPlane = [
    [0, 0, 0.3],
    [0.05, 0.02, 0.28],
    [0.1, 0, 0.3],
  ];
  const view = viewOf(way, inPlane);
  assert.ok(view.elevation >= 0.3 && view.elevation < 1.2);
  const { right, up } = screenAxes(view);
  const bend = [0, 0.02, -0.02];
  assert.ok(Math.hypot(dot(bend, right), dot(bend, up)) > 0.95 * Math.hypot(...bend));
  assert.ok(dot([1, 0, 0], right) ** 2 > 0.9);
  assert.deepEqual(viewOf({ from: [0, 0, 0], to: [0, 0, 1] }, [[0, 0, 0]]), START);
  assert.deepEqual(viewOf(null, []), START);
});

test("the verdict is green only for a run that converged without warnings", () => {
  const level = (document) => judge({ document }).level;
  assert.equal(level({ status: "converged", warnings: [] }), "good");
  assert.equal(level({ status: "converged", warnings: ["x"] }), "care");
  assert.equal(level({ status: "stopped-by-user" }), "care");
  assert.equal(level({ status: "stale-images" }), "bad");
  assert.equal(level({ status: "something new" }), "bad");
  assert.equal(judge({}).level, "bad");
  const { sentences } = judge({
    document: { status: "timeout", reason: "not converged within 60.0 s: 3.00 px left" },
  });
  assert.equal(sentences[0], "Not converged within 60.0 s: 3.00 px left.");
});

test("every way in which a servo can end has words of its own", () => {
  const ends = [
    "converged",
    "bad-readings",
    "stale-readings",
    "frozen-readings",
    "stale-images",
    "frozen-images",
    "drives-do-not-move",
    "too-few-edges",
    "ill-conditioned-edges",
    "robot-singular",
    "no-pose",
    "error-grows",
    "stalled",
    "timeout",
    "link-lost",
    "stopped-by-user",
  ];
  const headlines = ends.map((status) => judge({ document: { status } }).headline);
  assert.equal(new Set([...headlines, judge({}).headline]).size, ends.length + 1);
});

test("units follow from the names, that of the error from the document, short times from their size", () => {
  const unit = (path, document) => unitOf(path, 1, document).unit;
  assert.equal(unit("final_error", { unit: "rad" }), "mrad");
  assert.equal(unit("tolerance", { unit: "px" }), "px");
  assert.equal(unit("max_joint_speed_m_per_s"), "mm/s");
  assert.equal(unit("final_pose_error.rotation_rad"), "mrad");
  assert.equal(unit("time_s"), "s");
  assert.equal(unit("min_singular_value"), "");
  assert.equal(unitOf("compute_time_s.p99", 2e-5).unit, "µs");
  assert.equal(shortTime(0.004).unit, "ms");
});

test("a logarithmic axis holds its values and is no longer than six decades", () => {
  for (const values of [[0.08, 60], [3, 3.1], [1e-3, 1], [7]]) {
    const [least, most] = logDomain(values);
    assert.ok(least <= Math.min(...values) && most >= Math.max(...values), `${values}: ${least} to ${most}`);
    assert.ok(logTicks(least, most).length >= 2, `${values}`);
  }
  assert.ok(logDomain([1e-15, 1])[0] >= 1e-6 / 2);
  assert.equal(logDomain([]).length, 2);
  assert.deepEqual(logTicks(0.05, 100), [0.1, 1, 10, 100]);
  assert.deepEqual(logTicks(1, 10), [1, 2, 5, 10]);
});

test("a histogram counts every time once, and times that spread far get bins of equal ratios", () => {
  const narrow = range(100).map((index) => 1 + index / 100);
  const wide = range(100).map((index) => 1.07 ** index);
  const total = ({ bars }) => bars.reduce((sum, { count }) => sum + count, 0);
  assert.equal(barsOf(narrow).log, false);
  assert.equal(total(barsOf(narrow)), 100);
  assert.equal(barsOf(wide).log, true);
  assert.equal(total(barsOf(wide)), 100);
  assert.equal(total(barsOf([2, 2, 2])), 3);
});

test("a quantile is a time that occurred and that enough cycles did not exceed", () => {
  assert.equal(quantile([1, 2, 3, 4], 0.5), 2);
  assert.equal(quantile(range(100), 0.99), 98);
  assert.equal(quantile([5], 0.99), 5);
  assert.equal(quantile([1, 2], 1), 2);
});

test("a leg's nearness to the ends of its range is its least distance from either", () => {
  assert.equal(nearestEnd([3, null, 8], [0, 10]), 2);
  assert.equal(nearestEnd([3], []), null);
  assert.equal(nearestEnd([null], [0, 10]), null);
});

test("a document's leaves are all its numbers, texts and lists by their paths", () => {
  assert.deepEqual(leavesOf({ a: 1, b: { c: "x", d: null }, e: [1, 2] }), [
    ["a", 1],
    ["b.c", "x"],
    ["b.d", null],
    ["e", [1, 2]],
  ]);
});
