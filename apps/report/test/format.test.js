import assert from "node:assert/strict";
import { test } from "node:test";
import {
  MISSING,
  decimalsFor,
  fixed,
  percent,
  sentence,
  signed,
  significant,
  withUnit,
} from "../src/shared/format.js";

test("whatever is not a finite number becomes a dash", () => {
  for (const value of [null, undefined, NaN, Infinity, "1", {}]) {
    assert.equal(fixed(value, 2), MISSING);
    assert.equal(signed(value, 2), MISSING);
    assert.equal(significant(value), MISSING);
    assert.equal(percent(value), MISSING);
  }
  assert.equal(withUnit(MISSING, "px"), MISSING);
});

test("sigma decides the digits: two significant ones", () => {
  assert.equal(decimalsFor(0.62), 2);
  assert.equal(decimalsFor(8.2), 1);
  assert.equal(decimalsFor(120), 0);
  assert.equal(decimalsFor(2.1e-5), 6);
  for (const unknown of [null, undefined, NaN, 0]) assert.equal(decimalsFor(unknown, 3), 3);
});

test("zero carries no sign, other differences do", () => {
  assert.equal(fixed(-0.001, 2), "0.00");
  assert.equal(signed(0.001, 2), "0.00");
  assert.equal(signed(1.5, 1), "+1.5");
  assert.equal(signed(-1.5, 1), "−1.5");
});

test("significant digits use powers of ten only where plain digits are unreadable", () => {
  assert.equal(significant(0.0623), "0.0623");
  assert.equal(significant(1234.5, 3), "1235");
  assert.equal(significant(-3.456e-7), "−3.46·10⁻⁷");
  assert.equal(significant(0), "0");
});

test("a sentence begins with a capital and ends with one full stop", () => {
  assert.equal(sentence("give a radius"), "Give a radius.");
  assert.equal(sentence("Done!"), "Done!");
  assert.equal(sentence(null), "");
});
