// A verdict in a box of its colour: a headline, sentences, lists of what to look at.
import { html, paragraph } from "./dom.js";

const SYMBOL = { good: "✓", care: "!", bad: "✕" };

// level: "good" | "care" | "bad"; lists: [[title, [items]]], of which empty ones are left out
export function verdictBox({ level, headline, sentences, lists }) {
  return html(
    "div",
    { class: `verdict ${level}`, role: "status" },
    html("p", { class: "headline" }, html("span", { "aria-hidden": "true" }, SYMBOL[level]), headline),
    sentences.map((text) => paragraph(text)),
    lists.map(([title, items]) => list(title, items)),
  );
}

const list = (title, items) =>
  items.length > 0 && [
    html("h3", null, title),
    html(
      "ul",
      null,
      items.map((item) => html("li", null, item)),
    ),
  ];
