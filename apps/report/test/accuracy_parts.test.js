import assert from "node:assert/strict";
import { test } from "node:test";
import { pointsOf, scaleType } from "../src/accuracy/comparison.js";
import { definitionOf } from "../src/accuracy/indices.js";
import { STATE, cellsOf, colorScale, edgesOf, stripsOf } from "../src/shared/map_grid.js";
import { largestContributions } from "../src/accuracy/sources.js";
import { metresPer, pretty, radiansPer, unitsOf } from "../src/accuracy/units.js";
import { tabSeparated } from "../src/shared/copy_table.js";
import { tick } from "../src/shared/format.js";

const MAPS = {
  x: { label: "x", unit: "mm", values: [0, 10, 20] },
  y: { label: "y", unit: "mm", values: [-5, 5] },
  quantities: [
    {
      values: [
        [1, 2, null],
        [3, 4, 500],
      ],
    },
  ],
  states: [
    [0, 0, 2],
    [0, 1, 1],
  ],
};

test("units are written with real powers, and missing ones do not harm", () => {
  assert.equal(pretty("mm^3"), "mm³");
  assert.equal(pretty("rad^-2"), "rad⁻²");
  assert.equal(pretty(null), "");
  assert.deepEqual(
    [unitsOf({ units: { length: "um", angle: "mrad" } })].map(({ length, angle }) => [length, angle]),
    [["um", "mrad"]],
  );
  assert.equal(unitsOf(null).of("determinant"), "");
  assert.equal(metresPer("m"), 1);
  assert.equal(radiansPer("deg"), Math.PI / 180);
});

test("numbers on an axis have no idle digits", () => {
  assert.deepEqual([0.05, 160, 0, -0.25, 2e-9, 1000, 1.5].map(tick), [
    "0.05",
    "160",
    "0",
    "−0.25",
    "2·10⁻⁹",
    "1000",
    "1.5",
  ]);
});

test("a copied table has tabs, plain minus signs, and nothing for a dash", () => {
  assert.equal(
    tabSeparated([
      ["Pose", " x  mm "],
      ["P1", "−1.5"],
      ["P2", "—"],
    ]),
    "Pose\tx mm\nP1\t-1.5\nP2\t",
  );
});

test("a column of bars leaves no empty column in a copy", () => {
  assert.equal(tabSeparated([["A", "", "B"], ["group"], ["1", "", "2"]]), "A\tB\ngroup\n1\t2");
});

test("cells of a map come row after row with value and state", () => {
  const cells = cellsOf(MAPS, MAPS.quantities[0]);
  assert.equal(cells.length, 6);
  assert.deepEqual(cells[5], { x: 20, y: 5, column: 2, row: 1, value: 500, state: STATE.outsideJointRanges });
  assert.equal(cells[2].value, null);
  assert.deepEqual(edgesOf(MAPS.x.values), [-5, 25]);
  assert.deepEqual(edgesOf([7]), [6.5, 7.5]);
});

test("what lies outside the joint ranges takes no colours from the rest", () => {
  const scale = colorScale(cellsOf(MAPS, MAPS.quantities[0]));
  assert.equal(scale.domain[0], 1);
  assert.ok(scale.domain[1] <= 3);
  assert.equal(scale.clamped, true);
  assert.equal(colorScale([{ value: null, state: 2 }]), null);
  assert.equal(colorScale([{ value: 2, state: 0 }]).domain[0], 2);
  const wide = [1, 5, 1000].map((value) => ({ value, state: 0 }));
  assert.equal(colorScale(wide).type, "log");
});

test("neighbours of one state form one strip", () => {
  assert.deepEqual(
    stripsOf(MAPS, (state) => state === STATE.outsideJointRanges),
    [{ x1: 5, x2: 25, y1: 0, y2: 10 }],
  );
});

test("the contributions of all sources are ranked together, and what has no number is left out", () => {
  const sources = [
    { path: "sources.0", contributions: [{ name: "a", position: 1 }] },
    { path: "sources.1", contributions: [{ name: "b", position: 3 }, { name: "c" }] },
    { path: "sources.2" },
  ];
  const ranked = largestContributions(sources, "position", 5);
  assert.deepEqual(
    ranked.map(({ name, path }) => [name, path]),
    [
      ["b", "sources.1.contributions.0"],
      ["a", "sources.0.contributions.0"],
    ],
  );
});

test("a definition is found however its key is spelled", () => {
  const document = { definitions: { condition_two: "long", manipulability: "plain" } };
  assert.equal(definitionOf(document, "condition.two"), "long");
  assert.equal(definitionOf(document, "manipulability"), "plain");
  assert.equal(definitionOf(document, "determinant"), null);
  assert.equal(definitionOf(null, "determinant"), null);
});

test("only poses with both numbers are points, and wide ranges get a logarithmic axis", () => {
  const points = pointsOf(["P1"], { values: [1, null, 3] }, { values: [4, 5] });
  assert.deepEqual(points, [{ name: "P1", index: 1, error: 4 }]);
  assert.equal(scaleType([1, 100]), "log");
  assert.equal(scaleType([1, 2]), "linear");
  assert.equal(scaleType([0, 100]), "linear");
  assert.equal(scaleType([-1, 100]), "linear");
});
