// Opens a servo page, any that the program wrote, in a headless Chromium: node servo_page.browser.js PAGE.html
// What has to be seen follows from the data in the page. Exits with 1 and says what is wrong.
import assert from "node:assert/strict";
import { significant } from "../src/shared/format.js";
import { checkInBrowser, checkSectionsDrawn, expectShapes } from "./page_in_browser.js";

// How much of SI a unit of the page is, and what the names of quantities in it end in.
const UNITS = {
  mm: [1e3, "m"],
  mrad: [1e3, "rad"],
  px: [1, "px"],
  s: [1, "s"],
  ms: [1e3, "s"],
  µs: [1e6, "s"],
  "mm/s": [1e3, "m_per_s"],
  "1/s": [1, "per_s"],
};
const OF_THE_ERROR = ["final_error", "tolerance"];
// However long the run was, a page that stays quick has no more elements and no more text in its drawings.
const MOST_ELEMENTS = 6000;
const MOST_MARKUP = 3e6;

const isNumber = (value) => typeof value === "number";

// [[path, value]] of all numbers and texts of a document.
function leaves(value, path = "") {
  if (value === null || typeof value !== "object") return [[path, value]];
  return Object.entries(value).flatMap(([name, part]) => leaves(part, path ? `${path}.${name}` : name));
}

async function checkFigures(page, document) {
  const shown = await page
    .locator("[data-value]")
    .evaluateAll((all) =>
      all.map((each) => [each.dataset.value, each.dataset.unit, each.value, each.textContent]),
    );
  for (const [path, unit, value, text] of shown) {
    const given = path.split(".").reduce((part, name) => part[name], document);
    const [scale] = UNITS[unit] ?? [1];
    checkUnit(path, unit, document.unit);
    const wanted = scale * given;
    assert.ok(
      Math.abs(Number(value) - wanted) <= 1e-9 * Math.abs(wanted),
      `${path}: ${value} ${unit}, not ${given}`,
    );
    assert.ok(text === significant(wanted) || text === String(given), `${path} reads ${text}, not ${wanted}`);
  }
  const paths = new Set(shown.map(([path]) => path));
  const numbers = leaves(document).filter(([path, value]) => isNumber(value) && !path.startsWith("legs."));
  for (const [path] of numbers) assert.ok(paths.has(path), `${path} is not shown`);
}

function checkUnit(path, unit, ofError) {
  const quantity = UNITS[unit]?.[1];
  if (OF_THE_ERROR.includes(path)) return assert.equal(quantity, ofError, path);
  const member = path.split(".").find((name) => /_(m|px|rad|s)$/.test(name)) ?? "";
  if (quantity) assert.ok(member.endsWith(`_${quantity}`), `${path} in ${unit}`);
  else assert.equal(member, "", `${path} without a unit`);
}

async function checkWords(page, document, settings) {
  const text = (await page.locator("main").innerText()).toLowerCase();
  const words = leaves(document)
    .filter(([, value]) => typeof value === "string" && value)
    .map(([, value]) => value);
  for (const each of [...words, ...Object.values(settings ?? {}), (document.legs ?? []).join(", ")])
    assert.ok(text.includes(String(each).toLowerCase().trim()), `“${each}” is not on the page`);
  const level = document.status === "converged" ? (document.warnings?.length ? "care" : "good") : null;
  if (level) await expectShapes(page, `#verdict .verdict.${level}`, 1, "the verdict's colour");
  else assert.equal(await page.locator("#verdict .verdict.good").count(), 0, "a green verdict");
}

const hasAny = (values) => values?.flat().some(isNumber);

async function checkCurves(page, { cycles, goal, robot }) {
  const lines = (section) => `#${section} .plot svg [aria-label="line"] path`;
  await expectShapes(page, lines("errors"), 2, "the errors");
  await expectShapes(page, "#errors table tbody tr", 1, "the rates");
  if (hasAny(cycles.joint_speeds_m_per_s)) await expectShapes(page, lines("legs"), 6, "the legs' speeds");
  if (hasAny(cycles.joint_readings_m)) await expectShapes(page, lines("legs"), 12, "the legs' readings");
  if (hasAny(cycles.conditioning)) await expectShapes(page, lines("conditioning"), 1, "conditioning");
  if (hasAny(cycles.gain_per_s)) await expectShapes(page, lines("gain"), 1, "the gain");
  if (hasAny(cycles.look_s))
    await expectShapes(page, '#times .plot svg [aria-label="rect"] rect', 1, "the times");
  if (cycles.limits?.some(Boolean))
    await expectShapes(page, '#legs .plot svg [aria-label="bar"] rect', 1, "the limits");
  if (!robot?.legs?.length || !cycles.poses?.some(Boolean)) return;
  await expectShapes(page, "#path .turnable .leg", 6, "the robot's legs");
  await expectShapes(
    page,
    "#path .turnable .ghost",
    goal?.base_from_platform ? 3 : 2,
    "the platform's places",
  );
  await expectShapes(page, "#path .turnable .way.readings", 1, "the path");
  if (cycles.true_poses?.some(Boolean))
    await expectShapes(page, "#path .turnable .way.true", 1, "the true path");
  await expectShapes(page, lines("path"), 1, "the deviation");
}

// Changes that the page answers by drawing something else.
async function expectChange(page, selector, action, what) {
  const before = await page.locator(selector).first().innerHTML();
  await action();
  await page
    .waitForFunction(([place, old]) => document.querySelector(place).innerHTML !== old, [selector, before])
    .catch(() => assert.fail(`${what} changes nothing`));
}

async function checkSwitches(page, { cycles, robot }) {
  const log = page.locator('#errors input[name="log"]');
  const first = "#errors .plot";
  await expectShapes(page, `${first} svg`, 1, "the first plot");
  await expectChange(page, first, () => log.click(), "the logarithmic axis");
  await expectShapes(page, `${first} svg`, 1, "the first plot");
  await checkSingles(page, "#errors");
  if (!robot?.legs?.length || !cycles.poses?.some(Boolean)) return;
  const slider = page.locator('#path input[name="moment"]');
  await expectChange(
    page,
    "#path .turnable",
    () => slider.fill(String(cycles.time_s.length - 1)),
    "the slider",
  );
  assert.equal(
    await page.locator("#path .view-side data").nth(1).textContent(),
    String(cycles.time_s.length),
  );
  await expectChange(
    page,
    "#path .turnable",
    () => page.locator('#path input[name="close-up"]').check(),
    "coming close",
  );
}

async function checkSingles(page, section) {
  for (const name of ["controlled", "edge_error_px", "direction_error_rad"]) {
    const box = page.locator(`${section} input[name="${name}"]`);
    if (!(await box.count())) continue;
    const drawn = await page.locator(`${section} .plot [aria-label="line"] path`).count();
    await box.check();
    await expectShapes(
      page,
      `${section} .plot [aria-label="line"] path`,
      drawn + 3,
      `the single ones of ${name}`,
    );
  }
}

async function checkPictures(page, pictures) {
  for (const [index, { current, desired, image }] of (pictures ?? []).entries()) {
    await page.locator(`#pictures [data-picture="${index}"]`).click();
    const count = (selector) => page.locator(`#pictures .stage ${selector}`).count();
    assert.equal(await count(".current"), current?.length ?? 0, `current edges of picture ${index}`);
    assert.equal(await count(".desired"), desired?.length ?? 0, `desired edges of picture ${index}`);
    assert.equal(await count("image"), image ? 1 : 0, `image of picture ${index}`);
  }
  const desired = page.locator("#pictures .stage .desired").first();
  if (!(await desired.count())) return;
  await page.locator('#pictures input[name="desired"]').uncheck();
  assert.equal(await desired.isVisible(), false, "desired edges are still there");
}

async function checkSize(page, data) {
  const [elements, markup] = await page.evaluate(() => [
    document.querySelectorAll("*").length,
    document.querySelector("main").innerHTML.length,
  ]);
  const images = (data.pictures ?? []).reduce((sum, { image }) => sum + (image?.length ?? 0), 0);
  assert.ok(elements < MOST_ELEMENTS, `${elements} elements`);
  assert.ok(markup - images < MOST_MARKUP, `${markup} characters of drawings`);
}

async function checkPage(page, data) {
  const document = data.document ?? {};
  await checkSectionsDrawn(page);
  await checkFigures(page, document);
  await checkWords(page, document, data.settings);
  if (data.cycles?.time_s?.length) {
    await checkCurves(page, data);
    await checkSwitches(page, data);
  }
  await checkPictures(page, data.pictures);
  await checkSize(page, data);
}

checkInBrowser(process.argv[2], checkPage);
