// Opens an accuracy page, any that the program wrote, in a headless Chromium: node accuracy_page.browser.js PAGE.html
// What has to be seen follows from the data in the page. Exits with 1 and says what is wrong.
import assert from "node:assert/strict";
import { significant } from "../src/shared/format.js";
import { checkInBrowser, checkSectionsDrawn, expectShapes } from "./page_in_browser.js";

const partOf = (whole, path) => path.split(".").reduce((part, name) => part?.[name], whole);

// What the page shows for a data-value while the pose of this index is chosen.
function expectedText(document, index, path) {
  const inDocument = /^document\.(.+)$/.exec(path);
  const value = inDocument ? partOf(document, inDocument[1]) : partOf(document.poses[index], path);
  return significant(value);
}

async function checkSections(page, data) {
  const found = data.document ?? {};
  const drawable = data.robot?.legs?.length && data.poses_si?.some(Boolean);
  if (drawable) {
    await expectShapes(page, "#robot .turnable .leg", data.robot.legs.length, "the robot's legs");
    await expectShapes(page, "#robot .turnable .plate path", 4, "the robot's plates");
    await expectShapes(page, "#robot .turnable .joint-number", data.robot.legs.length, "the joints' numbers");
  }
  if (data.maps?.quantities?.[0]?.values?.flat().some((value) => typeof value === "number")) {
    await expectShapes(page, "#map .plot svg image", 1, "the map");
    await expectShapes(page, "#map .map-legend svg", 1, "the map's legend");
  }
  const scatters = data.scatter?.errors?.length ? (data.scatter.indices?.length ?? 0) : 0;
  if (scatters) await expectShapes(page, "#comparison .scatter svg circle", scatters, "the scatter plots");
  if (found.comparison?.indices?.length) await expectShapes(page, "#comparison table", 1, "the indices' τ");
  const spread = ({ quantiles }) => quantiles?.some(({ value }) => typeof value === "number");
  if (found.workspace?.statistics?.some(spread))
    await expectShapes(page, "#workspace .plot svg", 1, "the workspace");
  if (found.intersection?.position?.vertices?.length)
    await expectShapes(page, "#poses .turnable .polyhedron", 1, "the common errors");
  await checkSectionsDrawn(page);
}

// The numbers of the chosen pose, as a text that differs from pose to pose.
async function checkNumbers(page, found, index) {
  const shown = await page
    .locator("[data-value]")
    .evaluateAll((all) => all.map((each) => [each.dataset.value, each.textContent, each.value]));
  for (const [path, text] of shown)
    assert.equal(text, expectedText(found, index, path), `${path} of pose ${index}`);
  const ofPose = shown.filter(([path]) => path.startsWith("max_error."));
  const components = ["x", "y", "z", "rx", "ry", "rz", "position", "rotation"];
  for (const name of components)
    assert.ok(
      ofPose.some(([path]) => path === `max_error.${name}`),
      `max_error.${name} is not shown`,
    );
  return ofPose.map(([path, text]) => `${path} ${text}`).join("\n");
}

async function choose(page, index) {
  const button = page.locator(`#chooser [data-choice="${index}"]`);
  if (await button.count()) await button.click();
  else await page.locator("#chooser select").selectOption(String(index));
  await page.waitForFunction((wanted) => document.body.dataset.pose === String(wanted), index);
}

const MOST_CHOSEN = 12;

async function checkPoses(page, found) {
  const poses = found.poses ?? [];
  if (poses.length === 0) return;
  const seen = [await checkNumbers(page, found, 0)];
  for (let index = 1; index < Math.min(poses.length, MOST_CHOSEN); ++index) {
    await choose(page, index);
    seen.push(await checkNumbers(page, found, index));
    const differs =
      significant(poses[index].max_error?.position) !== significant(poses[0].max_error?.position);
    if (differs) assert.notEqual(seen[index], seen[0], `pose ${index} shows the numbers of the first`);
  }
  await checkPoseDrawings(page, poses);
}

// At the first pose with errors: their shapes, their bars, and the switches.
async function checkPoseDrawings(page, poses) {
  const index = poses.findIndex(({ polyhedron }) => polyhedron?.position?.vertices?.length > 2);
  if (index < 0) return;
  if (poses.length > 1) await choose(page, index);
  if (poses[index].sources?.length)
    await expectShapes(page, "#sources .source-bar", 2, "the bars of the sources");
  if (!(await page.locator("#robot").isVisible())) return;
  await expectShapes(page, "#robot .polyhedron path", 1, "the polyhedron of errors");
  const robot = page.locator("#robot .turnable");
  assert.match(await robot.textContent(), /errors × \S+; bar = /);
  await page.locator('#robot input[name="polyhedron"]').uncheck();
  await page.waitForFunction(() => !document.querySelector("#robot .polyhedron"));
  await page.locator('#robot input[name="polyhedron"]').check();
  await checkTurning(page, robot);
}

async function checkTurning(page, robot) {
  const before = await robot.innerHTML();
  const changed = (old) =>
    page.waitForFunction((text) => document.querySelector("#robot .turnable").innerHTML !== text, old);
  await robot.scrollIntoViewIfNeeded();
  const box = await robot.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 10, { steps: 4 });
  await page.mouse.up();
  await changed(before);
  const turned = await robot.innerHTML();
  await page.mouse.wheel(0, -200);
  await changed(turned);
}

async function checkPage(page, data) {
  await checkSections(page, data);
  await checkPoses(page, data.document ?? {});
}

checkInBrowser(process.argv[2], checkPage);
