// Maps of errors and indices over a slice of the workspace.
import { append, html } from "../shared/dom.js";
import { sliceFigure } from "../shared/slice_map.js";
import { pretty } from "./units.js";

export const hasMaps = (maps) =>
  Boolean(maps?.quantities?.length && maps.x?.values?.length && maps.y?.values?.length);

export function renderMaps(section, { data }) {
  const { maps } = data;
  const inWords = (part) => ({ ...part, label: part.label ?? part.key, unit: pretty(part.unit) });
  const slice = { x: inWords(maps.x), y: inWords(maps.y), states: maps.states };
  const quantities = maps.quantities.map(inWords);
  const place = html("div", { class: "map" });
  const show = (index) => {
    const quantity = quantities[index];
    const title = `${quantity.label}${maps.fixed ? ` at ${maps.fixed}` : ""}`;
    place.replaceChildren(sliceFigure(slice, quantity, title));
  };
  append(section, chooser(quantities, show), place);
  show(0);
}

function chooser(quantities, show) {
  if (quantities.length < 2) return null;
  const select = html(
    "select",
    { onchange: () => show(Number(select.value)) },
    quantities.map(({ label }, index) => html("option", { value: index }, label)),
  );
  return html("div", { class: "toolbar" }, html("label", null, "Show ", select));
}
