// What every page has to pass in a headless Chromium, whatever is in it: drawn at once, nothing fetched, no errors, no
// slips in its words, no wider than the window.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

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
export async function expectShapes(page, selector, least, what) {
  const enough = ([each, count]) => document.querySelectorAll(each).length >= count;
  await page.waitForFunction(enough, [selector, least], { timeout: DRAWN_MS }).catch(() => {
    assert.fail(`${what}: fewer than ${least} of "${selector}"`);
  });
}

// Every section says what it has, and those without data are gone with the links to them.
export async function checkSectionsDrawn(page) {
  assert.equal(await page.locator("section .notice", { hasText: "could not be drawn" }).count(), 0);
  const hidden = await page.locator("main > section[hidden]").evaluateAll((all) => all.map(({ id }) => id));
  for (const id of hidden) assert.equal(await page.locator(`nav a[href="#${id}"]`).isVisible(), false, id);
}

// Of each drawing the words that stand upright: none over another.
export async function checkLabelsApart(page) {
  const overlaps = await page.evaluate(() => {
    const upright = (text) => !/rotate\((?!0)/.test(text.getAttribute("transform") ?? "");
    const boxes = (drawing) =>
      [...drawing.querySelectorAll("text")]
        .filter((text) => upright(text) && text.textContent && !text.closest('[aria-label="tip"]'))
        .map((text) => ({ text: text.textContent, ...text.getBoundingClientRect().toJSON() }))
        .filter(({ width, height }) => width > 0 && height > 0);
    const shared = (a, b) =>
      Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
      Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
    return [...document.querySelectorAll("main svg")].flatMap((drawing) => {
      const all = boxes(drawing);
      return all.flatMap((a, index) =>
        all
          .slice(index + 1)
          .filter((b) => shared(a, b) > 0.1 * Math.min(a.width * a.height, b.width * b.height))
          .map((b) => `“${a.text}” and “${b.text}” of ${drawing.closest("section").id}`),
      );
    });
  });
  assert.deepEqual(overlaps, [], "words overlap");
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

async function checkOnce(browser, address, width, colorScheme, check) {
  const { page, context, faults } = await open(browser, address, {
    viewport: { width, height: 900 },
    colorScheme,
  });
  const data = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
  await check(page, data);
  await checkOverflow(page, width);
  await checkText(page, data);
  assert.deepEqual(faults, [], `at ${width} px, ${colorScheme}`);
  await context.close();
}

async function checkAll(path, check) {
  if (!path) throw new Error("the page's path is missing");
  if (!existsSync(BROWSER))
    throw new Error(
      `there is no Chromium at ${BROWSER}: install it (scripts/install_dependencies.sh) or set CHROMIUM`,
    );
  const address = pathToFileURL(resolve(path)).href;
  const browser = await chromium.launch({ executablePath: BROWSER, args: QUIET });
  try {
    for (const colorScheme of ["light", "dark"])
      for (const width of WIDTHS) {
        await checkOnce(browser, address, width, colorScheme, check);
        console.log(`${path}: as it should be at ${width} px, ${colorScheme}`);
      }
  } finally {
    await browser.close();
  }
}

// Opens the page at `path` wide and narrow, light and dark; check(page, data) looks at what is special about it. Sets the
// exit code to 1 and says what is wrong.
export function checkInBrowser(path, check) {
  checkAll(path, check).catch((error) => {
    console.error(error instanceof assert.AssertionError ? `${path}: ${error.message}` : error.message);
    process.exitCode = 1;
  });
}
