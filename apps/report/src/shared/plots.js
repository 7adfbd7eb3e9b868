// What all plots share: type, size that follows the page, keys.
import * as Plot from "@observablehq/plot";
import { html, svg } from "./dom.js";

export const COLOR = {
  first: "var(--first)",
  second: "var(--second)",
  third: "var(--third)",
  text: "var(--text)",
  muted: "var(--muted)",
  rule: "var(--rule)",
  page: "var(--page)",
};
export const TIP = { fill: COLOR.page, stroke: COLOR.muted, fontSize: 12 };

// draw(width_px) -> SVG; drawn again when the width of the page changes.
export function responsive(draw) {
  const place = html("div", { class: "plot" });
  let drawn = 0;
  new ResizeObserver(([entry]) => {
    const width = Math.floor(entry.contentRect.width);
    if (width < 1 || Math.abs(width - drawn) < 8) return;
    drawn = width;
    requestAnimationFrame(() => place.replaceChildren(draw(width)));
  }).observe(place);
  return place;
}

// Plot.plot with the report's type and a description for those who cannot see it.
export function plot(description, options) {
  const drawing = Plot.plot({
    ...options,
    ariaLabel: description,
    style: { fontSize: "12px", fontFamily: "inherit", background: "none", overflow: "visible" },
  });
  drawing.setAttribute("role", "img");
  return drawing;
}

// Draws a dot mark as one path a facet: thousands of dots cost as little as one line.
export function asOnePath(radius) {
  return (index, scales, values) => {
    const dots = Array.from(index, (i) => `M${values.x[i].toFixed(1)},${values.y[i].toFixed(1)}h0`).join("");
    return svg("path", { d: dots, class: "dots", "stroke-width": 2 * radius });
  };
}

const SWATCHES = {
  dot: (color) => svg("circle", { cx: 8, cy: 8, r: 4, fill: color }),
  diamond: (color) =>
    svg("path", { d: "M8,2L13,8L8,14L3,8Z", fill: "none", stroke: color, "stroke-width": 1.8 }),
  cross: (color) => svg("path", { d: "M4,4L12,12M4,12L12,4", stroke: color, "stroke-width": 1.8 }),
  line: (color) => svg("path", { d: "M0,8H16", stroke: color, "stroke-width": 2.5 }),
  dashes: (color) =>
    svg("path", { d: "M0,8H16", stroke: color, "stroke-width": 1.5, "stroke-dasharray": "4 3" }),
};

// entries: [[shape, colour, label]]
export function key(entries) {
  return html(
    "p",
    { class: "key" },
    entries.map(([shape, color, label]) =>
      html(
        "span",
        null,
        svg("svg", { width: 16, height: 16, "aria-hidden": "true" }, SWATCHES[shape](color)),
        label,
      ),
    ),
  );
}
