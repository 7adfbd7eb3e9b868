import assert from "node:assert/strict";
import { test } from "node:test";
import { coverageCells } from "../src/intrinsics/coverage.js";
import { histogram } from "../src/intrinsics/distribution.js";
import { pointsOf } from "../src/intrinsics/halves.js";
import { factorFor } from "../src/intrinsics/image_plot.js";
import { judge, uncertaintyAtBoard } from "../src/intrinsics/judgement.js";
import { leftOutParts, leftOutViews } from "../src/intrinsics/left_out.js";
import {
  FATE,
  boardDistance,
  cellMiddles,
  cornersOf,
  countOf,
  imageSize,
  nearestToBoard,
  usedCorners,
} from "../src/intrinsics/observations.js";
import { cameraRows } from "../src/intrinsics/parameters.js";
import { unitOf } from "../src/intrinsics/quantities.js";
import { meansOver } from "../src/intrinsics/residual_field.js";
import { tiltPoint } from "../src/intrinsics/tilts.js";
import { logTicks } from "../src/shared/color_map.js";
import { leavesOf } from "../src/shared/document.js";
import { coefficientNames } from "../src/shared/parameter_names.js";

const near = (found, wanted, tolerance = 1e-9) =>
  assert.ok(Math.abs(found - wanted) <= tolerance, `${found} is not ${wanted}`);

const view = (name, corners, changes = {}) => ({ name, width: 640, height: 480, corners, ...changes });
const DATA = {
  intrinsics: { status: "converged", views_left_out: [{ name: "c", why: "blurred" }] },
  views: [
    view("a", [
      [10, 20, 0.3, -0.4, 1],
      [11, 21, 0.9, 0, 0.5],
      [12, 22, 9, 9, 0],
      [13, 23, null, null, null],
    ]),
    view("b", [[10, 20, 0, 0, 1]], {
      distance_m: 0.5,
      left_out_corners: [{ x: 1, y: 2, what: "corner 1 of tag 3", why: "not straight: 0.4 px" }],
      unused: ["tag 7: not on the board"],
    }),
    view("c", [[1, 1, null, null, null]], { left_out: "blurred" }),
    view("d", [], { left_out: "no corners" }),
  ],
};

test("every corner has one fate, by its weight; without a residual it took no part", () => {
  const fates = cornersOf(DATA.views[0]).map(({ fate }) => fate);
  assert.deepEqual(fates, [FATE.whole, FATE.weighedDown, FATE.outlier, FATE.unused]);
  const used = usedCorners(DATA);
  assert.equal(used.length, 4);
  assert.equal(countOf(used, FATE.whole), 2);
  assert.equal(used[3].view, "b");
});

test("views left out are named once, whether the document or the view says so", () => {
  assert.deepEqual(leftOutViews(DATA), [
    { name: "c", why: "blurred" },
    { name: "d", why: "no corners" },
  ]);
  const reasons = leftOutParts(DATA);
  assert.equal(reasons.length, 3);
  assert.match(reasons[0].reason, /outlier/);
  assert.deepEqual(reasons[1], { reason: "not straight: 0.4 px", view: "b" });
  assert.deepEqual(reasons[2], { reason: "tag 7: not on the board", view: "b" });
});

test("the board's distance is the middle one, and the nearest map by ratio belongs to it", () => {
  const at = (...distances) => ({ views: distances.map((distance_m) => ({ distance_m })) });
  assert.equal(boardDistance(at(0.4, 0.5, 3)), 0.5);
  assert.equal(boardDistance(at(null, undefined)), null);
  assert.equal(nearestToBoard([0.2, 1, null], 0.5), 1);
  assert.equal(nearestToBoard([0.2, 1, null], 0.4), 0);
  assert.equal(nearestToBoard([null, 1], null), 0);
  assert.equal(nearestToBoard([null, 1], 1000), 1);
  const data = {
    ...at(0.9),
    intrinsics: { uncertainty: [{ distance_m: null }, { distance_m: 1, rms_px: 0.1 }] },
  };
  assert.equal(uncertaintyAtBoard(data).index, 1);
});

test("the image has the camera's size, else a view's, else room for all corners", () => {
  assert.deepEqual(imageSize({ intrinsics: { camera: { width_px: 100, height_px: 50 } } }), {
    width: 100,
    height: 50,
  });
  assert.deepEqual(imageSize(DATA), { width: 640, height: 480 });
  assert.deepEqual(imageSize({ views: [{ corners: [[999.5, 20]] }] }), { width: 1001, height: 480 });
});

test("cells tile the image from half a pixel before its first pixel", () => {
  const grid = { columns: 4, rows: 2, corners: [1, 0, 0, 0, 0, 0, 0, 5] };
  const cells = coverageCells(grid, { width: 40, height: 20 });
  assert.equal(cells[0].x1, -0.5);
  assert.equal(cells[7].x2, 39.5);
  assert.equal(cells[7].y2, 19.5);
  assert.deepEqual([cells[0].count, cells[1].count, cells[7].count], [1, 0, 5]);
  const middles = cellMiddles(grid, { width: 40, height: 20 });
  middles.forEach(({ x, y }, index) => {
    near(x, cells[index].x);
    near(y, cells[index].y);
  });
});

// Corners all over an image of 2400 x 1200 px, the same residual everywhere but for noise that cancels.
function field(dx, dy, noise) {
  const corners = [];
  for (let x = 10; x < 2400; x += 25)
    for (let y = 10; y < 1200; y += 25) {
      const sign = (x + y) % 50 === 20 ? 1 : -1;
      corners.push({ x, y, dx: dx + sign * noise, dy: dy - sign * noise, weight: 1, fate: FATE.whole });
    }
  return corners;
}

test("means over cells keep what is common and drop what cancels", () => {
  const size = { width: 2400, height: 1200 };
  const noise = 0.5;
  const means = meansOver(size, field(0.03, -0.04, noise), noise);
  assert.equal(means.length, 24 * 12);
  for (const { dx, dy, count, radius, isBeyond } of means) {
    near(dx, 0.03, 1e-9);
    near(dy, -0.04, 1e-9);
    assert.equal(count, 16);
    near(radius, (2 * Math.SQRT2 * noise) / Math.sqrt(count));
    assert.equal(isBeyond, false);
  }
});

test("outliers take no part in the means, and cells with few corners have none", () => {
  const size = { width: 2400, height: 1200 };
  const four = [0, 1, 2, 3].map((x) => ({ x, y: 0, dx: 1, dy: 0, weight: 1 }));
  const [mean, ...others] = meansOver(size, [...four, { x: 4, y: 0, dx: 99, dy: 99, weight: 0 }], 0.1);
  assert.equal(others.length, 0);
  assert.equal(mean.count, 4);
  near(mean.dx, 1);
  assert.equal(mean.isBeyond, true);
  assert.equal(meansOver(size, four.slice(1), 0.1).length, 0);
});

test("a difference is beyond noise where it exceeds twice what is expected there", () => {
  const halves = {
    columns: 3,
    rows: 1,
    difference_px: [[0.3, 0.4], null, [0.3, 0.4]],
    expected_px: [0.3, null, 0.2],
  };
  const intrinsics = {
    camera: { width_px: 300, height_px: 100 },
    cross_validation: { expected_rms_px: 0.1 },
  };
  const points = pointsOf({ halves, intrinsics });
  assert.deepEqual(
    points.map(({ isBeyond }) => isBeyond),
    [false, true],
  );
  assert.equal(points[1].x, 249.5);
  const uniform = pointsOf({ halves: { ...halves, expected_px: null }, intrinsics });
  assert.deepEqual(
    uniform.map(({ expected, isBeyond }) => [expected, isBeyond]),
    [
      [0.1, true],
      [0.1, true],
    ],
  );
  assert.deepEqual(pointsOf({ intrinsics }), []);
});

test("a histogram counts each value once, within or outside", () => {
  const values = [-1, -0.999, -0.5, 0, 0.5, 0.999, 1, 7, -7];
  const { bins, outside } = histogram(values, 1, 4);
  assert.deepEqual(
    bins.map(({ count }) => count),
    [2, 1, 1, 2],
  );
  assert.equal(outside, 3);
  assert.equal(bins[3].to, 1);
});

test("a tilt stands where the board's far side is: right, then clockwise", () => {
  const at = (tilt, direction) => tiltPoint({ tilt_rad: tilt, tilt_direction_rad: direction });
  near(at(Math.PI / 6, 0).x, 30);
  near(at(Math.PI / 6, Math.PI / 2).y, 30);
  near(at(Math.PI / 6, Math.PI).x, -30);
});

test("coefficients bear OpenCV's names, those of the fisheye lens their own", () => {
  const five = [0, 0, 0, 0, 0];
  assert.deepEqual(coefficientNames({ lens: "brown-conrady", distortion: five }), [
    "k1",
    "k2",
    "p1",
    "p2",
    "k3",
  ]);
  assert.deepEqual(coefficientNames({ lens: "fisheye", distortion: [0, 0, 0, 0] }), ["k1", "k2", "k3", "k4"]);
  assert.deepEqual(coefficientNames({ lens: "pinhole", distortion: [] }), []);
  const rows = cameraRows({
    camera: {
      lens: "rational",
      fx: 1000.5,
      fy: 1,
      cx: 2,
      cy: 3,
      distortion: [0.1],
      sigma: { fx: 0.012, distortion: [0.5] },
    },
  });
  assert.equal(rows.length, 5);
  assert.equal(rows[0].decimals, 3);
  assert.equal(rows[4].path, "camera.distortion.0");
  assert.equal(rows[4].sigma, 0.5);
});

test("numbers of the document have the unit of their names", () => {
  for (const [path, unit] of [
    ["camera.fx", "px"],
    ["camera.sigma.cy", "px"],
    ["camera.distortion.0", ""],
    ["board_warp_m.1", "mm"],
    ["uncertainty.0.distance_m", "m"],
    ["next_view.centre_px.0", "px"],
    ["coverage.largest_tilt_rad", "°"],
    ["coverage.share", "%"],
    ["time_s.total", "s"],
    ["time_s", "s"],
    ["cross_validation.ratio", ""],
  ])
    assert.equal(unitOf(path).unit, unit, path);
});

test("lengths are enlarged by the round factor that lets none become too long", () => {
  assert.equal(factorFor([0.1, 35]), 200);
  assert.equal(factorFor([0.1, 35], [1, 35]), 20);
  assert.equal(factorFor([0, 35]), 1);
});

test("a logarithmic scale has few round ticks within it", () => {
  assert.deepEqual(
    logTicks([0.012, 0.09]).map((value) => Number(value.toPrecision(3))),
    [0.02, 0.03, 0.05],
  );
  assert.deepEqual(
    logTicks([0.001, 100]).map((value) => Number(value.toPrecision(3))),
    [0.001, 0.01, 0.1, 1, 10, 100],
  );
});

test("lists of a document are taken apart where that is asked for", () => {
  assert.deepEqual(leavesOf({ a: [1, { b: 2 }] }, { intoLists: true }), [
    ["a.0", 1],
    ["a.1.b", 2],
  ]);
});

const converged = (changes = {}) => ({
  title: "Lab camera",
  views: [{ distance_m: 0.5 }],
  intrinsics: {
    status: "converged",
    camera: { lens: "brown-conrady", width_px: 640, height_px: 480 },
    rms_px: 0.09,
    noise_px: 0.06,
    neighbour_noise_px: 0.059,
    views_used: 20,
    views_left_out: [],
    corners_used: 2000,
    uncertainty: [{ distance_m: 0.5, rms_px: 0.031, worst_px: 0.27 }],
    cross_validation: { misfit: false, sentence: "the lens model fits" },
    ...changes,
  },
});

test("a good camera's verdict says fit, noise, uncertainty at the board and the cross-validation", () => {
  const { level, headline, sentences } = judge(converged());
  assert.equal(level, "good");
  assert.equal(headline, "Camera found");
  const text = sentences.join(" ");
  for (const part of [
    /2000 corners in 20 views\./,
    /0\.0900 px/,
    /σ = 0\.0600 px/,
    /0\.5 m away.*0\.0310 px.*0\.270 px/,
    /The lens model fits\./,
  ])
    assert.match(text, part);
  assert.doesNotMatch(text, /neighbours/);
});

test("a lens model that does not fit is the headline, said once", () => {
  const misfit = { misfit: true, sentence: "the lens model does not fit" };
  const { level, headline, sentences, warnings } = judge(
    converged({
      cross_validation: misfit,
      warnings: ["the lens model does not fit"],
      neighbour_noise_px: 0.02,
    }),
  );
  assert.equal(level, "care");
  assert.match(headline, /does not fit/);
  assert.deepEqual(warnings, []);
  assert.match(sentences.join(" "), /Against their neighbours alone.*0\.0200 px/);
});

test("a warning, and a missing cross-validation, are said", () => {
  assert.equal(judge(converged({ warnings: ["few views"] })).level, "care");
  const { sentences } = judge(converged({ cross_validation: { why_not: "three views are too few" } }));
  assert.match(sentences.join(" "), /no cross-validation.*Three views are too few\./);
});

test("no camera is never good, and every status says what to do", () => {
  for (const status of ["too_few_views", "not_flat", "undetermined", "hopeless_guess", "not_converged"]) {
    const { level, headline, advice, sentences } = judge({
      intrinsics: { status, message: "because of this" },
    });
    assert.equal(level, "bad");
    assert.match(headline, /^No camera/);
    assert.ok(advice.length > 0, status);
    assert.deepEqual(sentences, ["Because of this."]);
  }
  assert.equal(judge({}).level, "bad");
});
