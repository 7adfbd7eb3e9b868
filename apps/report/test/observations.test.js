import assert from "node:assert/strict";
import { test } from "node:test";
import {
  leftOutEdges,
  meanAlong,
  residualLimit,
  usedEdges,
  usedSamples,
} from "../src/calibration/observations.js";
import { outwardNormal } from "../src/calibration/overlay.js";
import { orderedParameters } from "../src/shared/correlations.js";
import { groupedByReason } from "../src/shared/reasons.js";
import { thinned } from "../src/shared/statistics.js";

const DATA = {
  images: [
    {
      name: "a",
      edges: [
        {
          leg: 1,
          edge: 1,
          samples: [
            [10, 20, 0.5, 1, 0.1],
            [11, 21, null, 1, 0.2],
          ],
        },
        { leg: 1, edge: 2, left_out: "hidden" },
      ],
    },
    { name: "b", left_out: "too dark", edges: [{ leg: 2, edge: 1, samples: [[0, 0, 9, 1, 0.5]] }] },
    { name: "c" },
  ],
};

test("residuals come only from edges and images that took part", () => {
  assert.deepEqual(usedSamples(usedEdges(DATA)), [
    { image: "a", leg: 1, edge: 1, x: 10, y: 20, residual: 0.5, weight: 1, place: 0.1 },
  ]);
  assert.deepEqual(leftOutEdges(DATA), [{ image: "a", leg: 1, edge: 2, reason: "hidden" }]);
});

test("the mean along a leg is weighted and skips empty bins", () => {
  const samples = [
    { place: 0.1, residual: 1, weight: 1 },
    { place: 0.2, residual: 4, weight: 0.5 },
    { place: 1, residual: -1, weight: 1 },
    { place: null, residual: 7, weight: 1 },
  ];
  const means = meanAlong(samples, 2);
  assert.deepEqual(
    means.map(({ place, mean }) => [place, mean]),
    [
      [0.25, 2],
      [0.75, -1],
    ],
  );
  assert.deepEqual(meanAlong([], 4), []);
});

test("outliers do not stretch the axis", () => {
  const samples = Array.from({ length: 100 }, () => ({ residual: 0.1, weight: 1 }));
  assert.equal(residualLimit([...samples, { residual: 50, weight: 0 }]), residualLimit(samples));
});

test("thinning keeps at most the limit", () => {
  assert.deepEqual(thinned([1, 2, 3], 3), [1, 2, 3]);
  assert.ok(thinned(Array(1001).fill(0), 100).length <= 100);
});

test("reasons that differ only in numbers form one group, the largest first", () => {
  const edges = [
    { reason: "hidden" },
    { reason: "contrast 8 is below 20" },
    { reason: "contrast 9.5 is below 20" },
  ];
  assert.deepEqual(
    groupedByReason(edges).map(({ reason, members }) => [reason, members.length]),
    [
      ["contrast … is below …", 2],
      ["hidden", 1],
    ],
  );
});

test("the outward normal of an edge points away from the other edge, whichever way the polyline runs", () => {
  const left = [
    [0, 0],
    [0, 10],
  ];
  const right = [
    [4, 0],
    [4, 10],
  ];
  for (const polyline of [left, [...left].reverse()]) {
    const { x, y } = outwardNormal(polyline, right, { x: 0.1, y: 5 });
    assert.deepEqual([x, Math.abs(y)], [-1, 0]);
  }
  assert.equal(outwardNormal(left, undefined, { x: 0, y: 5 }), null);
  assert.equal(outwardNormal(undefined, right, { x: 0, y: 5 }), null);
});

test("correlations are grouped by camera and leg, and parameters that were held fixed are left out", () => {
  const names = ["legs[2].radius_m", "camera.k3", "legs[1].radius_m", "camera.fx_px"];
  const matrix = [
    [1, null, 0.2, 0.3],
    [null, 1, null, null],
    [0.2, null, 1, 0.1],
    [0.3, null, 0.1, 1],
  ];
  assert.deepEqual(
    orderedParameters({ names, matrix }).map(({ name }) => name),
    ["camera.fx_px", "legs[1].radius_m", "legs[2].radius_m"],
  );
});
