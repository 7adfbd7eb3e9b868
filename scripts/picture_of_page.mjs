// Writes a picture of a part of a report page, as README shows them:
//   node picture_of_page.mjs PAGE.html "#pictures .stage" OUT.png [WIDTH]
// To be run from a folder whose node_modules hold playwright-core: build/release/apps/report.
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [page, selector, out, width = "1000"] = process.argv.slice(2);
const { chromium } = createRequire(resolve("package.json"))("playwright-core");
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
});
const view = await browser.newPage({ viewport: { width: Number(width), height: 900 } });
await view.goto(pathToFileURL(page).href);
await view.locator(selector).first().scrollIntoViewIfNeeded();
await view.waitForTimeout(1000); // drawings come a frame after their place
await view.locator(selector).first().screenshot({ path: out });
await browser.close();
