import assert from "node:assert/strict";
import { test } from "node:test";
import { describeParameter, inWords } from "../src/shared/parameter_names.js";

test("parameters are shown in the units that people use", () => {
  assert.deepEqual(describeParameter("legs[3].radius_m"), {
    group: "Leg 3",
    label: "radius R",
    unit: "µm",
    scale: 1e6,
  });
  assert.equal(describeParameter("legs[1].platform_joint_m.y").label, "platform joint B y");
  assert.equal(describeParameter("camera.fx_px").unit, "px");
  assert.equal(describeParameter("camera.k1").unit, "");
  const tag = describeParameter("tags.board.translation_m.x");
  assert.deepEqual([tag.group, tag.label, tag.unit], ["Other", "tags.board.translation_m.x", "mm"]);
});

test("parameter names inside a text are put into words", () => {
  assert.equal(
    inWords("a combination of camera.fx_px (+), legs[1].base_joint_in_camera_m.z (-) is open"),
    "a combination of camera focal length fx (+), leg 1 base joint A in camera z (−) is open",
  );
  assert.equal(inWords("legs[4].edge_1_tilt_px (+)"), "leg 4 shading tilt of edge 1 (+)");
});

test("file names inside a text are left alone", () => {
  assert.equal(inWords("the guess in camera.yaml"), "the guess in camera.yaml");
});
