// All sets of legs in one table; a click chooses the set that the sections below show.
import { copyable } from "../shared/copy_table.js";
import { append, html, muted, paragraph, table } from "../shared/dom.js";
import { plural, sentence } from "../shared/format.js";
import { DEGREES, MM } from "../shared/quantities.js";
import { bareFigureOf } from "./figures.js";
import { edgesOf, edgesSentence, legsOf, otherModes, verdictOf } from "./wording.js";

const errorAt = (name, size) => (set) => set[name]?.[size] ?? Infinity;
const ORDERS = [
  { label: "verdict, the best first", value: null },
  { label: "number of legs", value: ({ legs }) => legs.length },
  { label: "position error at the goal", value: errorAt("largest_error_at_goal", "position_m") },
  { label: "rotation error at the goal", value: errorAt("largest_error_at_goal", "rotation_rad") },
  { label: "number of other modes", value: ({ assembly_modes: modes }) => otherModes(modes).count },
];

export class SetsTable {
  // choose(index): of a set of the document
  constructor(document, choose) {
    this.document = document;
    this.sets = (document.sets ?? []).map((set, index) => ({ ...set, index }));
    this.choose = choose;
    this.place = html("div", { class: "sets" });
    this.place.addEventListener("click", ({ target }) => {
      const row = target.closest("tr[data-set]");
      if (row) this.choose(Number(row.dataset.set));
    });
    this.order(0);
  }

  renderInto(section) {
    const select = html(
      "select",
      { name: "order", onchange: () => this.order(Number(select.value)) },
      ORDERS.map(({ label }, index) => html("option", { value: index }, label)),
    );
    append(
      section,
      paragraph(edgesSentence(this.sets)),
      muted(
        "Click a row to see more of a set below. Errors: what directions off by their most can add up to.",
      ),
      html("div", { class: "toolbar" }, html("label", null, "Order by ", select)),
      this.place,
    );
  }

  order(index) {
    const { value } = ORDERS[index];
    const groups = value ? [{ rows: ordered(this.sets, value) }] : byVerdict(this.sets);
    this.place.replaceChildren(copyable(table("Sets of legs", columnsOf(this.document), groups)));
    for (const button of this.place.querySelectorAll("button[data-set]"))
      button.closest("tr").dataset.set = button.dataset.set;
    this.mark(this.chosen);
  }

  mark(index) {
    this.chosen = index;
    for (const row of this.place.querySelectorAll("tr[data-set]"))
      row.classList.toggle("chosen", Number(row.dataset.set) === index);
  }
}

// Stable, so that what is alike stays in the order of the verdict.
export const ordered = (sets, value) => [...sets].sort((a, b) => compared(value(a), value(b)));
const compared = (a, b) => (a === b ? 0 : a - b);

// Neighbours of one verdict form a group.
export function byVerdict(sets) {
  const groups = [];
  for (const set of sets) {
    if (groups.at(-1)?.verdict !== set.verdict) groups.push({ verdict: set.verdict, rows: [] });
    groups.at(-1).rows.push(set);
  }
  return groups.map(({ rows }) => ({
    label: `${verdictOf(rows[0]).label}: ${plural(rows.length, "set")}`,
    rows,
  }));
}

function columnsOf(document) {
  const error = (label, name, size, { unit }) => ({
    label,
    unit,
    cell: ({ index }) => bareFigureOf(document, `sets.${index}.${name}.${size}`),
  });
  return [
    { label: "Legs", text: true, cell: chooseButton },
    { label: "Verdict", text: true, cell: verdictCell },
    { label: "Other modes", cell: ({ assembly_modes: modes }) => otherModes(modes).text },
    error("Error at goal", "largest_error_at_goal", "position_m", MM),
    error("Error at goal", "largest_error_at_goal", "rotation_rad", DEGREES),
    error("On the way", "largest_error_on_path", "position_m", MM),
    error("On the way", "largest_error_on_path", "rotation_rad", DEGREES),
    { label: "Its edges …", text: true, cell: edgesCell },
  ];
}

const chooseButton = (set) =>
  html("button", { type: "button", class: "link", "data-set": set.index }, legsOf(set));

function verdictCell(set) {
  const { label, level } = verdictOf(set);
  return html(
    "span",
    null,
    html("span", { class: "status" }, html("span", { class: `light ${level}` }), label),
    set.why && html("small", null, sentence(set.why)),
  );
}

function edgesCell(set) {
  const { text, gained } = edgesOf(set);
  const why = set.by_lines?.why;
  return html("span", { class: gained ? "gained" : null }, text, why && html("small", null, sentence(why)));
}
