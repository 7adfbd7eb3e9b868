// write_figures.mjs DRAW.js DATA_FOLDER OUT_FOLDER: draws the figures in headless Chromium, as files.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [script, dataFolder, outFolder] = process.argv.slice(2);
const read = (name) => JSON.parse(readFileSync(join(dataFolder, `${name}.json`), "utf8"));
const names = ["side_view", "error_curves", "slice_070", "slice_061"];
const data = Object.fromEntries(names.map((name) => [name, read(name)]));

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"],
});
try {
  const page = await browser.newPage();
  await page.addScriptTag({ path: script });
  const figures = await page.evaluate((given) => window.drawFigures(given), data);
  for (const [name, drawing] of Object.entries(figures)) {
    // A tenth of a pixel is enough of every path.
    const small = drawing.replace(/ d="[^"]*"/g, (path) => path.replace(/(\.\d)\d+/g, "$1"));
    writeFileSync(join(outFolder, `${name}.svg`), small + "\n");
    console.log(join(outFolder, `${name}.svg`));
  }
} finally {
  await browser.close();
}
