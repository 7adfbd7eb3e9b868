// What the papers' figures share: panels on white, as SVG files that stand by themselves, for pages light and dark.
import * as Plot from "@observablehq/plot";

export const TEXT = "#24292f";
export const MUTED = "#6e7781";
const FONT = "system-ui, -apple-system, 'Segoe UI', Helvetica, Arial, sans-serif";

export const svgNode = (name, attributes, ...children) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
};

export const plot = (options) =>
  Plot.plot({
    ...options,
    style: { background: "none", color: TEXT, fontSize: "12px", fontFamily: FONT, overflow: "visible" },
  });

const titleText = (title, x, y) =>
  svgNode("text", { x, y, fill: TEXT, "font-family": FONT, "font-size": 14, "font-weight": 600 }, title);

// Entries [colour, label, dashes] in a row.
function legend(entries, x, y) {
  const group = svgNode("g", { "font-family": FONT, "font-size": 12, fill: TEXT });
  let at = x;
  for (const [color, label, dashes] of entries) {
    const line = { x1: at, x2: at + 22, y1: y - 4, y2: y - 4, stroke: color, "stroke-width": 2 };
    group.append(svgNode("line", dashes ? { ...line, "stroke-dasharray": dashes } : line));
    group.append(svgNode("text", { x: at + 28, y }, label));
    at += 28 + 7 * label.length + 22;
  }
  return group;
}

// Panels [{title, drawing}] side by side on white, under a legend.
export function compose(description, panels, entries) {
  const top = entries ? 34 : 8;
  const heads = 24;
  const widths = panels.map(({ drawing }) => +drawing.getAttribute("width"));
  const height = Math.max(...panels.map(({ drawing }) => +drawing.getAttribute("height"))) + top + heads + 8;
  const width = widths.reduce((sum, each) => sum + each, 0) + 20 * (panels.length + 1);
  const sheet = svgNode("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
  sheet.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  sheet.append(svgNode("title", {}, description));
  sheet.append(svgNode("rect", { width, height, fill: "white", rx: 6 }));
  if (entries) sheet.append(legend(entries, 30, 26));
  let x = 20;
  panels.forEach(({ title, drawing }, i) => {
    sheet.append(titleText(title, x + 10, top + 18));
    drawing.setAttribute("x", x);
    drawing.setAttribute("y", top + heads);
    sheet.append(drawing);
    x += widths[i] + 20;
  });
  return new XMLSerializer().serializeToString(sheet);
}
