// Opens a page of `legible legs`, any that the program wrote, in a headless Chromium: node legs_page.browser.js PAGE.html
// What has to be seen follows from the data in the page. Exits with 1 and says what is wrong.
import assert from "node:assert/strict";
import { leavesOf, valueAt } from "../src/shared/document.js";
import { fixed, significant } from "../src/shared/format.js";
import { fromRotationVector } from "./example_geometry.mjs";
import { checkInBrowser, checkSectionsDrawn, expectShapes } from "./page_in_browser.js";

const UNITS = { mm: 1e3, mrad: 1e3, "°": 180 / Math.PI, s: 1, "%": 100, "": 1 };
// How much of what the names of quantities end in.
const KINDS = {
  mm: /_m(\.\d)?$/,
  mrad: /_rad$/,
  "°": /(_rad|rotation_vector\.\d)$/,
  s: /_s$/,
  "%": /free_up_to$/,
};
const MOST_CHOSEN = 16;
const MOST_ELEMENTS = 9000;

const isNumber = (value) => typeof value === "number";

// {path: shown value, in SI}, each compared with the document.
async function figures(page, document) {
  const shown = await page
    .locator("[data-value]")
    .evaluateAll((all) =>
      all.map((each) => [each.dataset.value, each.dataset.unit, Number(each.value), each.textContent]),
    );
  const found = new Map();
  for (const [path, unit, value, text] of shown) {
    if (unit) assert.match(path, KINDS[unit], `${path} in ${unit}`);
    const readable = [significant(value), String(value), fixed(value, unit === "mm" ? 2 : 3)];
    assert.ok(readable.includes(text), `${path} reads ${text}, not ${value}`);
    found.set(path, value / UNITS[unit]);
    if (!/rotation_vector/.test(path)) checkClose(found.get(path), valueAt(document, path), path);
  }
  return found;
}

const checkClose = (found, wanted, what) =>
  assert.ok(Math.abs(found - wanted) <= 1e-9 * Math.abs(wanted), `${what}: ${found}, not ${wanted}`);

// What has to be shown of a part of the document: its numbers, rotations as rotation vectors.
function wantedPaths(document, part) {
  const numbers = leavesOf(valueAt(document, part), { intoLists: true, path: part }).filter(
    ([path, value]) => isNumber(value) && !/\.legs\.\d+$|\.most_possible$/.test(path),
  );
  return [
    ...new Set(
      numbers
        .map(([path]) => path)
        .map((path) =>
          /rotation_xyzw\.\d$/.test(path) ? path.replace(/rotation_xyzw\.\d/, "rotation_vector.0") : path,
        ),
    ),
  ];
}

function checkPart(found, document, part) {
  for (const path of wantedPaths(document, part)) {
    assert.ok(found.has(path), `${path} is not shown`);
    if (path.endsWith("rotation_vector.0"))
      checkRotation(found, document, path.slice(0, -".rotation_vector.0".length));
  }
}

function checkRotation(found, document, pose) {
  const vector = [0, 1, 2].map((axis) => found.get(`${pose}.rotation_vector.${axis}`));
  const shown = fromRotationVector(vector);
  const given = valueAt(document, `${pose}.rotation_xyzw`);
  const overlap = Math.abs(shown.reduce((sum, value, index) => sum + value * given[index], 0));
  assert.ok(Math.abs(overlap - 1) < 1e-6, `${pose}: turned by ${vector}, not ${given}`);
}

async function checkWords(page, document) {
  const text = (await page.locator("main").innerText()).toLowerCase();
  const legs = (document.legs ?? []).flatMap(({ chain, hidden_chain: hidden }) => [chain, hidden]);
  const whys = (document.sets ?? []).map(({ why }) => why);
  for (const words of [...legs, ...whys, ...(document.warnings ?? []), document.robot_path?.why])
    if (words) assert.ok(text.includes(words.toLowerCase()), `“${words}” is not on the page`);
  if (document.choice) {
    assert.ok(text.includes(`watch leg`), "the choice is not named");
    assert.equal(await page.locator("#verdict .verdict.bad").count(), 0, "a red verdict");
  } else await expectShapes(page, "#verdict .verdict.bad", 1, "the verdict's colour");
}

async function choose(page, index) {
  await page.locator(`.sets button[data-set="${index}"]`).click();
  await page.waitForFunction((wanted) => document.body.dataset.set === String(wanted), index);
}

// Few enough for large robots: some of each verdict.
function chosenOf(sets) {
  const seen = new Map();
  const each = Math.ceil(MOST_CHOSEN / new Set(sets.map(({ verdict }) => verdict)).size);
  return sets.flatMap(({ verdict }, index) => {
    seen.set(verdict, (seen.get(verdict) ?? 0) + 1);
    return seen.get(verdict) <= each ? [index] : [];
  });
}

async function checkSets(page, data) {
  const { document } = data;
  await expectShapes(page, ".sets tr[data-set]", document.sets.length, "the table of sets");
  for (const index of chosenOf(document.sets)) {
    await choose(page, index);
    checkPart(await figures(page, document), document, `sets.${index}`);
    assert.equal(await page.locator(".sets tr.chosen").count(), 1, "not one chosen row");
    await checkDrawings(page, data, index);
  }
}

async function checkDrawings(page, { document, robot, simulations, places }, index) {
  const set = document.sets[index];
  if (simulations?.[index]?.errors_rad.flat().some((value) => value > 1e-12))
    await expectShapes(
      page,
      '#servo .plot svg [aria-label="line"] path',
      set.legs.length + 1,
      `the simulation of ${set.legs}`,
    );
  if (!robot?.legs?.length || !places?.to) return;
  await expectShapes(page, "#modes .turnable .leg", robot.legs.length, `the robot of ${set.legs}`);
  const others = Math.max(0, (set.assembly_modes?.modes.length ?? 0) - 1);
  await expectShapes(page, "#modes .turnable .ghost.mode", others - 1, `other modes of ${set.legs}`);
  assert.equal(await page.locator("#modes .buttons button").count(), 2 + others, `places of ${set.legs}`);
}

async function checkOrder(page, sets) {
  if (sets.length < 2) return;
  await page.locator('#sets select[name="order"]').selectOption({ label: "number of legs" });
  const first = Number(await page.locator(".sets tr[data-set]").first().getAttribute("data-set"));
  assert.equal(
    sets[first].legs.length,
    Math.min(...sets.map(({ legs }) => legs.length)),
    "the order by legs",
  );
  await page.locator('#sets select[name="order"]').selectOption("0");
  const best = await page.locator(".sets tr[data-set]").first().getAttribute("data-set");
  assert.equal(best, "0", "the order by verdict");
}

async function checkMaps(page, { maps }) {
  assert.equal(await page.locator("#maps").isVisible(), Boolean(maps?.sets?.length), "the maps");
  if (!maps?.sets?.length) return;
  const [legs, quantity] = ["set", "quantity"].map((name) => page.locator(`#maps select[name="${name}"]`));
  const captions = new Set();
  for (const index of maps.sets.keys()) {
    await legs.selectOption(String(index));
    for (let each = 0; each < (await quantity.locator("option").count()); ++each) {
      await quantity.selectOption(String(each));
      captions.add(await page.locator("#maps figcaption").textContent());
      await expectShapes(page, "#maps .plot svg image", 1, `map ${each}`);
    }
    const isSigned = (of) => of.type_2_geometric?.flat().some((value) => value > 0) && changesSign(of);
    const loci = [maps.sets[index], maps.robot].filter(isSigned).length;
    await expectShapes(page, '#maps .plot svg [aria-label="link"] path', 2 * loci, "the singularities");
  }
  assert.equal(captions.size, 6 * maps.sets.length, "maps with one caption");
}

const changesSign = ({ type_2_geometric: grid }) =>
  grid.some((row) => row.some((value, column) => value * (row[column + 1] ?? value) < 0));

async function checkPage(page, data) {
  const { document } = data;
  await checkSectionsDrawn(page);
  await checkWords(page, document);
  const found = await figures(page, document);
  for (const part of ["from", "to", "noise_rad", "robot_path", "robot_modes"])
    checkPart(found, document, part);
  await checkSets(page, data);
  await checkOrder(page, document.sets);
  await checkMaps(page, document);
  const elements = await page.locator("*").count();
  assert.ok(elements < MOST_ELEMENTS, `${elements} elements`);
}

checkInBrowser(process.argv[2], checkPage);
