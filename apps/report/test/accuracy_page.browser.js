// Opens an accuracy page, any that the program wrote, in a headless Chromium: node accuracy_page.browser.js PAGE.html
// What has to be seen follows from the data in the page. Exits with 1 and says what is wrong.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { significant } from "../src/shared/format.js";

const BROWSER = process.env.CHROMIUM || "/usr/bin/chromium";
const QUIET = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];
const DRAWN_MS = 15000;
const WIDTHS = [1280, 400];

const partOf = (whole, path) => path.split(".").reduce((part, name) => part?.[name], whole);

// What the page shows for a data-value while the pose of this index is chosen.
function expectedText(document, index, path) {
  const inDocument = /^document\.(.+)$/.exec(path);
  const value = inDocument ? partOf(document, inDocument[1]) : partOf(document.poses[index], path);
  return significant(value);
}

// Opens the page; returns it with what went wrong in it so far.
async function open(browser, address, options) {
  const context = await browser.newContext(options);
  const faults = [];
  context.on("request", (request) => {
    if (request.url() !== address) faults.push(`asked for ${request.url()}`);
  });
  const page = await context.newPage();
  page.on("console", (message) => message.type() === "error" && faults.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => faults.push(`page: ${error.stack}`));
  await page.goto(address);
  return { page, context, faults };
}

// Drawings come a frame after their place: waits for them.
async function expectShapes(page, selector, least, what) {
  const enough = ([each, count]) => document.querySelectorAll(each).length >= count;
  await page.waitForFunction(enough, [selector, least], { timeout: DRAWN_MS }).catch(() => {
    assert.fail(`${what}: fewer than ${least} of "${selector}"`);
  });
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
  assert.equal(await page.locator("section .notice", { hasText: "could not be drawn" }).count(), 0);
  const hidden = await page.locator("main > section[hidden]").evaluateAll((all) => all.map(({ id }) => id));
  for (const id of hidden) assert.equal(await page.locator(`nav a[href="#${id}"]`).isVisible(), false, id);
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
  const button = page.locator(`#chooser [data-pose="${index}"]`);
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

async function checkOverflow(page, width) {
  const [content, room] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    window.innerWidth,
  ]);
  assert.ok(content <= room, `at ${width} px the page is ${content} px wide`);
}

// What only a slip can put on the page, unless the data say it.
async function checkText(page, data) {
  const [text, given] = [await page.locator("body").innerText(), JSON.stringify(data)];
  for (const slip of ["NaN", "undefined", "[object", "null"])
    if (!given.replaceAll(":null", "").includes(slip)) assert.ok(!text.includes(slip), `"${slip}" is shown`);
}

async function checkPage(browser, address, width, colorScheme) {
  const { page, context, faults } = await open(browser, address, {
    viewport: { width, height: 900 },
    colorScheme,
  });
  const data = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
  await checkSections(page, data);
  await checkPoses(page, data.document ?? {});
  await checkOverflow(page, width);
  await checkText(page, data);
  assert.deepEqual(faults, [], `at ${width} px, ${colorScheme}`);
  await context.close();
  return data;
}

async function run(path) {
  if (!path) throw new Error("usage: node accuracy_page.browser.js PAGE.html");
  if (!existsSync(BROWSER))
    throw new Error(
      `there is no Chromium at ${BROWSER}: install it (scripts/install_dependencies.sh) or set CHROMIUM`,
    );
  const address = pathToFileURL(resolve(path)).href;
  const browser = await chromium.launch({ executablePath: BROWSER, args: QUIET });
  try {
    for (const colorScheme of ["light", "dark"])
      for (const width of WIDTHS) {
        await checkPage(browser, address, width, colorScheme);
        console.log(`${path}: as it should be at ${width} px, ${colorScheme}`);
      }
  } finally {
    await browser.close();
  }
}

run(process.argv[2]).catch((error) => {
  console.error(
    error instanceof assert.AssertionError ? `${process.argv[2]}: ${error.message}` : error.message,
  );
  process.exitCode = 1;
});
