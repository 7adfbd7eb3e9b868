import assert from "node:assert/strict";
import { test } from "node:test";
import { judge } from "../src/calibration/judgement.js";

const converged = (changes = {}, calibration = {}) => ({
  title: "Hexapod",
  images: [{ name: "a", edges: [{}, {}] }],
  calibration: {
    status: "converged",
    rms_px: 0.05,
    held_out: { rms_px: 0.06 },
    images_used: 40,
    images_left_out: [],
    edges_used: 466,
    unobservable: [],
    ...calibration,
  },
  ...changes,
});

test("a converged calibration without findings is good, and says fit and held-out error", () => {
  const { level, sentences, warnings } = judge(converged());
  assert.equal(level, "good");
  assert.deepEqual(warnings, []);
  assert.match(sentences.join(" "), /466 leg edges in 40 images\..*0\.0500 px.*0\.0600 px/);
});

test("without held-out images the verdict claims nothing about new poses", () => {
  const { sentences } = judge(converged({}, { held_out: null }));
  assert.match(sentences.join(" "), /No images were held out/);
});

test("a warning turns the verdict into one to look at, and names its parameters in words", () => {
  const { level, headline, warnings } = judge(converged({}, { warnings: ["check legs[1].radius_m"] }));
  assert.equal(level, "care");
  assert.match(headline, /something to look at/);
  assert.deepEqual(warnings, ["Check leg 1 radius R."]);
});

test("every other status is bad and leads with its message, what is open, and what to do", () => {
  for (const status of ["unobservable", "not_converged", "too_few_observations"]) {
    const judgement = judge({
      calibration: {
        status,
        message: "why it failed",
        warnings: ["001.png: left out: dark"],
        unobservable: ["legs[1].radius_m is free: measure it"],
      },
    });
    assert.equal(judgement.level, "bad");
    assert.deepEqual(judgement.sentences, ["Why it failed."]);
    assert.deepEqual(judgement.warnings, ["001.png: left out: dark."]);
    assert.deepEqual(judgement.open, ["Leg 1 radius R is free: measure it."]);
    assert.ok(judgement.advice.length > 0);
  }
});

test("a page without any data is judged unusable", () => {
  assert.equal(judge({}).level, "bad");
});
