import assert from "node:assert/strict";
import { test } from "node:test";
import { ellipseOf, isFront, magnification, principalSection } from "../src/accuracy/error_geometry.js";
import { movedBy, robotAt, twistOf } from "../src/shared/robot_geometry.js";
import { roundBelow, scaleBar } from "../src/shared/scale_bars.js";
import { START, enclosing, projection, screenAxes, turned, zoomed } from "../src/shared/turntable.js";

const close = (found, wanted, tolerance = 1e-9) => {
  assert.equal(found.length, wanted.length);
  found.forEach((value, index) =>
    assert.ok(Math.abs(value - wanted[index]) < tolerance, `${found} is not ${wanted}`),
  );
};
const dot = (a, b) => a.reduce((sum, value, index) => sum + value * b[index], 0);
const FROM_FRONT = { azimuth: -Math.PI / 2, elevation: 0, zoom: 1 };
const QUARTER_TURN_Z = [0, 0, Math.SQRT1_2, Math.SQRT1_2];

test("the screen's axes are orthonormal and right-handed from every side", () => {
  for (const [azimuth, elevation] of [
    [0, 0],
    [1, 0.4],
    [-2.5, -1.2],
    [0.3, Math.PI / 2],
  ]) {
    const { right, up, toward } = screenAxes({ azimuth, elevation });
    close([dot(right, right), dot(up, up), dot(toward, toward)], [1, 1, 1]);
    close([dot(right, up), dot(up, toward), dot(toward, right)], [0, 0, 0]);
    const [[a, b, c], [d, e, f]] = [right, up];
    close([b * f - c * e, c * d - a * f, a * e - b * d], toward);
  }
});

test("from the front x goes to the right, z goes up, and what has less y is nearer", () => {
  const scene = { center: [0, 0, 0], radius: 1 };
  const { at, scale } = projection(FROM_FRONT, scene, { width: 400, height: 200 });
  assert.equal(scale, 100);
  const center = at([0, 0, 0]);
  const moved = at([0.5, -0.2, 0.25]);
  close([moved.x - center.x, moved.y - center.y, moved.depth], [50, -25, 0.2]);
});

test("turning stops above and below, zooming at sensible ends", () => {
  assert.equal(turned(START, 0, 99).elevation, Math.PI / 2);
  assert.equal(turned(START, 0, -99).elevation, -Math.PI / 2);
  assert.ok(zoomed(START, 1e9).zoom < 100);
  assert.ok(zoomed(START, 1e-9).zoom > 0.01);
});

test("the enclosing sphere holds all points, and has a radius even for a single one", () => {
  close(
    enclosing([
      [0, 0, 0],
      [2, 0, 0],
    ]).center,
    [1, 0, 0],
  );
  assert.equal(
    enclosing([
      [0, 0, 0],
      [2, 0, 0],
    ]).radius,
    1,
  );
  assert.ok(enclosing([[3, 3, 3]]).radius > 0);
});

test("platform joints are where the pose takes them", () => {
  const robot = { legs: [{ base_joint_m: [1, 0, 0], platform_joint_m: [0.5, 0, 0], radius_m: 0.01 }] };
  const placed = robotAt(robot, { rotation_xyzw: QUARTER_TURN_Z, translation_m: [0, 0, 2] });
  close(placed.legs[0].platform, [0, 0.5, 2], 1e-6);
  close(placed.up.platform, [0, 0, 1], 1e-6);
  assert.equal(robotAt(robot, null), null);
  assert.equal(robotAt(null, {}), null);
});

test("a free motion moves the farthest joint by the reach, and turns about the platform's origin", () => {
  const twist = twistOf([0, 0, 0, 0, 0, 90], 1e-3, Math.PI / 180);
  const moved = movedBy(
    [
      [1, 0, 1],
      [0.5, 0, 1],
      [0, 0, 1],
    ],
    [0, 0, 1],
    twist,
    0.1,
  );
  close(moved.flat(), [1, 0.1, 1, 0.5, 0.05, 1, 0, 0, 1]);
  close(movedBy([[1, 0, 0]], [0, 0, 0], [0, 0, 0, 0, 0, 0], 0.1)[0], [1, 0, 0]);
});

test("round numbers are 1, 2 or 5 times a power of ten, and do not exceed what they stand for", () => {
  const cases = [
    [1, 1],
    [1.99, 1],
    [2, 2],
    [4.9, 2],
    [7, 5],
    [0.1, 0.1],
    [0.0499, 0.02],
    [1000, 1000],
    [987654, 500000],
  ];
  for (const [value, round] of cases) assert.equal(roundBelow(value), round);
  for (const nothing of [0, -1, NaN, Infinity]) assert.equal(roundBelow(nothing), 1);
});

test("errors that are comparable are magnified alike, others each for itself", () => {
  const room = 0.1;
  assert.equal(magnification(1e-4, [1e-4, 1.5e-4, 0], room), magnification(1.5e-4, [1e-4, 1.5e-4, 0], room));
  assert.equal(magnification(1e-4, [1e-4, 1], room), 1000);
  assert.equal(magnification(1, [1e-4, 1], room), 0.1);
});

test("a scale bar is as long as its round value and never longer than its room", () => {
  for (const pixelsPerUnit of [0.3, 1, 47, 12345]) {
    const { value, length } = scaleBar(pixelsPerUnit, 150);
    assert.ok(length <= 150 && length > 55);
    close([length], [value * pixelsPerUnit]);
  }
});

test("an ellipsoid seen along one of its axes shows the other two", () => {
  const ellipsoid = {
    semi_axes: [3, 2, 1],
    directions: [
      [0, 0, 1],
      [1, 0, 0],
      [0, 1, 0],
    ],
  };
  const { major, minor, angle } = ellipseOf(ellipsoid, screenAxes(FROM_FRONT));
  close([major, minor, Math.abs(angle)], [3, 2, Math.PI / 2]);
});

test("the outline of an ellipsoid touches each of its principal sections and leaves none out", () => {
  const c = Math.SQRT1_2;
  const ellipsoid = {
    semi_axes: [3, 2, 1],
    directions: [
      [c, c, 0],
      [-c, c, 0],
      [0, 0, 1],
    ],
  };
  const axes = screenAxes({ azimuth: 0.7, elevation: 0.5 });
  const { major, minor, angle } = ellipseOf(ellipsoid, axes);
  const reach = (point) => {
    const [x, y] = [dot(point, axes.right), dot(point, axes.up)];
    const along = (x * Math.cos(angle) + y * Math.sin(angle)) / major;
    const across = (y * Math.cos(angle) - x * Math.sin(angle)) / minor;
    return Math.hypot(along, across);
  };
  for (const [first, second] of [
    [0, 1],
    [1, 2],
    [2, 0],
  ]) {
    const most = Math.max(...principalSection(ellipsoid, first, second, 720).map(reach));
    assert.ok(most <= 1 + 1e-9 && most > 0.999, `${most}`);
  }
});

test("a facet that is counterclockwise for the eye is a front", () => {
  const vertices = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 0, 1],
  ];
  assert.equal(isFront(vertices, [0, 1, 2], screenAxes(FROM_FRONT).toward), true);
  assert.equal(isFront(vertices, [2, 1, 0], screenAxes(FROM_FRONT).toward), false);
});
