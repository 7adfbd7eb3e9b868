// Opens an intrinsics page, any that the program wrote, in a headless Chromium: node intrinsics_page.browser.js PAGE.html
// What has to be seen follows from the data in the page. Exits with 1 and says what is wrong.
import assert from "node:assert/strict";
import { checkInBrowser, checkLabelsApart, checkSectionsDrawn, expectShapes } from "./page_in_browser.js";

// How much of SI a unit of the page is, and what the names of quantities in it end in.
const UNITS = {
  m: [1, /_m$/],
  mm: [1e3, /_m\.\d$/],
  px: [1, /(_px(\.\d)?|\.[fc][xy])$/],
  s: [1, /^time_s/],
  "°": [180 / Math.PI, /_rad$/],
  "%": [100, /share$/],
  "": [1, /./],
};
// However many corners there are, a page that stays quick has no more elements and no more text in its drawings.
const MOST_ELEMENTS = 6000;
const MOST_MARKUP = 1.5e6;

const isNumber = (value) => typeof value === "number";
const valueAt = (document, path) => path.split(".").reduce((part, name) => part?.[name], document);

// [[path, value]] of all numbers and texts of a document, of lists one by one.
function leaves(value, path = "") {
  if (value === null || typeof value !== "object") return [[path, value]];
  return Object.entries(value).flatMap(([name, part]) => leaves(part, path ? `${path}.${name}` : name));
}

// A number as it reads on the page: {value, rounding (half of its last digit)}.
function readNumber(text) {
  const [, sign, digits, power] = /^(−?)([\d.]+)(?:·10(.+))?$/.exec(text) ?? [];
  assert.ok(digits, `“${text}” is no number`);
  const exponent = Number([...(power ?? "⁰")].map((each) => SUPERSCRIPT[each]).join(""));
  const decimals = digits.split(".")[1]?.length ?? 0;
  return {
    value: (sign ? -1 : 1) * Number(digits) * 10 ** exponent,
    rounding: 0.5 * 10 ** (exponent - decimals),
  };
}
const SUPERSCRIPT = Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].map((each, digit) => [each, String(digit)]));
SUPERSCRIPT["⁻"] = "-";

async function checkFigures(page, document) {
  const shown = await page
    .locator("[data-value]")
    .evaluateAll((all) =>
      all.map((each) => [each.dataset.value, each.dataset.unit, each.value, each.textContent]),
    );
  for (const [path, unit, value, text] of shown) {
    const [scale, names] = UNITS[unit];
    assert.match(path, names, `${path} in ${unit}`);
    const wanted = scale * valueAt(document, path);
    const isClose = Math.abs(Number(value) - wanted) <= 1e-9 * Math.abs(wanted);
    assert.ok(isClose, `${path}: ${value} ${unit}, not ${wanted}`);
    if (text === "held") assert.equal(wanted, 0, path);
    else checkReading(text, wanted, path);
  }
  const paths = new Set(shown.map(([path]) => path));
  for (const [path, value] of leaves(document))
    if (isNumber(value)) assert.ok(paths.has(path), `${path} is not shown`);
}

function checkReading(text, wanted, path) {
  const { value, rounding } = readNumber(text);
  assert.ok(Math.abs(value - wanted) <= 1.001 * rounding, `${path} reads ${text}, not ${wanted}`);
}

async function checkWords(page, data) {
  const details = page.locator("#options details");
  if (await details.count()) await details.evaluate((each) => (each.open = true));
  const text = (await page.locator("body").innerText()).toLowerCase();
  const said = [...leaves(data.intrinsics ?? {}).map(([, value]) => value), data.title, data.board].filter(
    (value) => typeof value === "string" && value,
  );
  for (const each of said)
    assert.ok(text.includes(each.toLowerCase().trim()), `“${each}” is not on the page`);
  const { status, warnings, cross_validation: validation } = data.intrinsics ?? {};
  const level = status !== "converged" ? "bad" : warnings?.length || validation?.misfit ? "care" : "good";
  await expectShapes(page, `#verdict .verdict.${level}`, 1, "the verdict's colour");
}

async function checkMaps(page, data) {
  const has = (values) => values?.some((value) => value !== null);
  if (data.maps?.maps?.some(({ sigma_px: sigma }) => has(sigma))) {
    await expectShapes(page, '#uncertainty svg [aria-label="raster"] image', 1, "the map");
    if (data.maps.columns > 2 && data.maps.rows > 2)
      await expectShapes(page, '#uncertainty svg [aria-label="contour"] path', 3, "lines of equal value");
    await expectShapes(page, "#uncertainty .map-legend svg", 1, "the colours' scale");
  }
  if (has(data.halves?.difference_px)) await expectShapes(page, "#halves svg .arrows", 3, "the differences");
  if (data.coverage?.corners?.length) await checkCoverage(page, data);
  if (data.views?.some(({ tilt_rad: tilt }) => isNumber(tilt)))
    await expectShapes(page, "#coverage svg circle", 3, "the tilts");
}

// A chooser where there is something to choose.
async function checkDistances(page, { maps }) {
  const several = maps?.maps?.filter(({ sigma_px: sigma }) => sigma.some(isNumber)).length > 1;
  assert.equal(
    await page.locator('select[name="distance"]').count(),
    several ? 1 : 0,
    "a choice of distances",
  );
}

async function checkCoverage(page, { coverage, next_view: next }) {
  const empty = coverage.corners.filter((count) => count === 0).length;
  if (empty)
    await expectShapes(
      page,
      "#coverage svg rect[stroke-dasharray], #coverage g[stroke-dasharray] rect",
      empty,
      "empty cells",
    );
  if (next?.outline_px?.length)
    await expectShapes(page, '#coverage svg [aria-label="line"] path', 1, "the proposed view");
}

// Changes that the page answers by drawing something else.
async function expectChange(page, selector, action, what) {
  const before = await page.locator(selector).first().innerHTML();
  await action();
  await page
    .waitForFunction(([place, old]) => document.querySelector(place).innerHTML !== old, [selector, before])
    .catch(() => assert.fail(`${what} changes nothing`));
}

async function checkSwitches(page, data) {
  const choose = (name) => page.locator(`select[name="${name}"]`);
  const other = async (name) => {
    const values = await choose(name)
      .locator("option")
      .evaluateAll((all) => all.map(({ value }) => value));
    const now = await choose(name).inputValue();
    await choose(name).selectOption(values.find((value) => value !== now));
  };
  if ((await choose("distance").count()) > 0)
    await expectChange(page, "#uncertainty .map", () => other("distance"), "another distance");
  if (data.halves?.difference_px) {
    await expectShapes(page, "#halves .plot svg", 1, "the differences");
    await expectChange(page, "#halves figure", () => other("halves-factor"), "the factor of the arrows");
  }
  if (!(await choose("residual-mode").count())) return;
  for (const name of ["residual-factor", "residual-mode"]) {
    await expectShapes(page, "#residuals .plot svg", 3, "the residuals");
    await expectChange(page, "#residuals", () => other(name), name);
  }
  await expectShapes(page, "#residuals .plot svg", 3, "the residuals");
}

const FATES = [
  [".found.whole", (weight) => weight >= 1],
  [".weighed-down-corner", (weight) => weight > 0 && weight < 1],
  [".outlier", (weight) => weight !== null && weight <= 0],
];

// A few pictures: the first, the last, one with left-out corners.
async function checkPictures(page, views) {
  if (!views?.length) return assert.equal(await page.locator("#pictures").isVisible(), false);
  const faulty = views.findIndex(({ left_out_corners: leftOut }) => leftOut?.length);
  for (const index of new Set([0, views.length - 1, faulty].filter((each) => each >= 0))) {
    const { name, picture, corners, left_out_corners: leftOut } = views[index];
    await page.evaluate((hash) => (window.location.hash = hash), `pictures/${encodeURIComponent(name)}`);
    await page.locator("#pictures .picture-caption", { hasText: name }).waitFor();
    const count = (selector) => page.locator(`#pictures .stage ${selector}`).count();
    assert.equal(await count("image"), picture ? 1 : 0, `image of ${name}`);
    assert.equal(await count(".no-picture"), picture ? 0 : 1, `empty frame of ${name}`);
    for (const [selector, has] of FATES) {
      const wanted = (corners ?? []).filter((corner) => isNumber(corner[2]) && has(corner[4])).length;
      assert.equal(await count(selector), wanted, `${selector} in ${name}`);
    }
    const titles = await page.locator("#pictures .stage .left-out-corner title").allTextContents();
    assert.equal(titles.length, leftOut?.length ?? 0, `left-out corners of ${name}`);
    for (const [place, { why }] of (leftOut ?? []).entries()) assert.ok(titles[place].includes(why), why);
  }
}

async function checkLeftOut(page, data) {
  const text = (await page.locator("#left-out").textContent()).toLowerCase();
  for (const { name, left_out: why } of data.views ?? [])
    if (why)
      assert.ok(text.includes(name.toLowerCase()) && text.includes(why.toLowerCase()), `${name}: ${why}`);
}

async function checkResiduals(page, data) {
  const corners = (data.views ?? []).filter((view) => !view.left_out).flatMap((view) => view.corners ?? []);
  const counted = corners.filter((corner) => isNumber(corner[2]));
  if (!counted.length) return assert.equal(await page.locator("#residuals").isVisible(), false);
  await expectShapes(page, "#residuals svg .arrows", 2, "the residuals");
  const bars = data.views.filter(({ rms_px: rms }) => isNumber(rms)).length;
  await expectShapes(page, '#residuals svg [aria-label="bar"] rect', bars, "the views' residuals");
  const shown = await page.locator("#residuals table td:nth-child(2)").allTextContents();
  const sum = shown.reduce((total, text) => total + Number(text), 0);
  const before = data.views.flatMap(({ left_out_corners: leftOut }) => leftOut ?? []).length;
  assert.equal(sum, counted.length + before, "corners that are accounted for");
}

async function checkSize(page, data) {
  const [elements, markup] = await page.evaluate(() => [
    document.querySelectorAll("*").length,
    document.querySelector("main").innerHTML.length,
  ]);
  const images = Math.max(0, ...(data.views ?? []).map(({ picture }) => picture?.length ?? 0));
  assert.ok(elements < MOST_ELEMENTS, `${elements} elements`);
  assert.ok(markup - images < MOST_MARKUP, `${markup} characters of drawings`);
}

async function checkPage(page, data) {
  await checkSectionsDrawn(page);
  await checkFigures(page, data.intrinsics ?? {});
  await checkWords(page, data);
  await checkMaps(page, data);
  await checkDistances(page, data);
  await checkResiduals(page, data);
  await checkLabelsApart(page);
  await checkSwitches(page, data);
  await checkLabelsApart(page);
  await checkPictures(page, data.views);
  await checkLeftOut(page, data);
  await checkSize(page, data);
}

checkInBrowser(process.argv[2], checkPage);
