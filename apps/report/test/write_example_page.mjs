// Joins a page's template and data: node write_example_page.mjs BEFORE.html AFTER.html DATA.json PAGE.html
import { readFileSync, writeFileSync } from "node:fs";

const [before, after, data] = process.argv.slice(2, 5).map((path) => readFileSync(path, "utf8"));
// As apps/report_page.cpp does: "<" could end the script element.
writeFileSync(process.argv[5], before + JSON.stringify(JSON.parse(data)).replaceAll("<", "\\u003c") + after);
