// A button that puts a table on the clipboard as tab separated text, numbers with all their digits.
import { html } from "./dom.js";
import { MINUS, MISSING } from "./format.js";

const SAID_SECONDS = 1.5;

// rows of texts -> what a spreadsheet pastes: tabs between cells, a line a row, a plain minus sign, nothing for a dash.
// Columns without any text, such as bars, are left out.
export function tabSeparated(rows) {
  const texts = rows.map((cells) => cells.map((text) => text.replace(/\s+/g, " ").trim()));
  const isUsed = (_, column) => texts.some((cells) => cells[column]);
  const plain = (text) => (text === MISSING ? "" : text.replaceAll(MINUS, "-"));
  return texts.map((cells) => cells.filter(isUsed).map(plain).join("\t")).join("\n");
}

// block: what table() of dom.js returns.
export function copyable(block) {
  const button = html(
    "button",
    { type: "button", class: "copy", title: "Copy this table as tab separated text" },
    "Copy",
  );
  button.addEventListener("click", async () => {
    const copied = await toClipboard(tableText(block.querySelector("table")));
    button.textContent = copied ? "Copied" : "Not allowed here";
    setTimeout(() => (button.textContent = "Copy"), 1000 * SAID_SECONDS);
  });
  return html("div", { class: "copyable" }, button, block);
}

const tableText = (table) => tabSeparated([...table.rows].map((row) => [...row.cells].map(fullText)));

function fullText(node) {
  if (node.nodeType === Node.TEXT_NODE) return node.data;
  if (node.tagName === "DATA" && node.value) return node.value;
  return [...node.childNodes].map(fullText).join("");
}

// Some browsers keep the clipboard from pages that were opened as files: then through a selected text field.
async function toClipboard(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = html("textarea", { readonly: true });
    field.value = text;
    document.body.append(field);
    field.select();
    const copied = document.execCommand("copy");
    field.remove();
    return copied;
  }
}
