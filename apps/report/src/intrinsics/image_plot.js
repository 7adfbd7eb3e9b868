// Plots whose plane is the camera's image, and arrows over it.
import * as Plot from "@observablehq/plot";
import { html, svg } from "../shared/dom.js";
import { COLOR, plot } from "../shared/plots.js";
import { roundBelow } from "../shared/scale_bars.js";

const MARGIN = { left: 62, right: 20, top: 10, bottom: 40 };
const FACTORS = [0.2, 0.5, 1, 2, 5];
const HEAD_PX = 4.5;
const LEAST_PX = 7; // of an arrow with a head

export const frameOf = ({ width, height }) => ({ x1: -0.5, x2: width - 0.5, y1: -0.5, y2: height - 0.5 });

// options: those of Plot.plot beside the axes; the image's frame is drawn around the marks.
export function imagePlot(description, size, available, { marks, ...options }) {
  const frame = frameOf(size);
  const inner = available - MARGIN.left - MARGIN.right;
  const axis = (label, count) => ({
    label,
    labelArrow: false,
    labelAnchor: "center",
    ticks: count,
    tickFormat: "d",
  });
  const drawing = plot(description, {
    width: available,
    height: Math.round((inner * size.height) / size.width) + MARGIN.top + MARGIN.bottom,
    marginLeft: MARGIN.left,
    marginRight: MARGIN.right,
    marginTop: MARGIN.top,
    marginBottom: MARGIN.bottom,
    x: { ...axis("x, px", Math.max(3, Math.round(available / 110))), domain: [frame.x1, frame.x2] },
    y: { ...axis("y, px", Math.max(3, Math.round(available / 140))), domain: [frame.y2, frame.y1] },
    ...options,
    marks: [...marks, Plot.rect([frame], { ...RECT, fill: null, stroke: COLOR.muted, strokeWidth: 1 })],
  });
  return drawing;
}

export const RECT = { x1: "x1", x2: "x2", y1: "y1", y2: "y2" };

// Draws a mark's points as one path, in the element that the mark itself would fill: that clips.
const asOnePath = (className, pathOf) => (index, scales, values, dimensions, context, next) => {
  const place = next([], scales, values, dimensions, context);
  const d = Array.from(index, (i) => pathOf(values, i)).join("");
  place.append(svg("path", { class: className, d }));
  return place;
};

// Arrows from {x, y} by {dx, dy} times the factor, all as one path.
export const arrows = (points, factor, className) =>
  Plot.link(points, {
    x1: "x",
    y1: "y",
    x2: ({ x, dx }) => x + factor * dx,
    y2: ({ y, dy }) => y + factor * dy,
    clip: true,
    render: asOnePath(`arrows ${className}`, ({ x1, y1, x2, y2 }, i) =>
      arrowPath(x1[i], y1[i], x2[i], y2[i]),
    ),
  });

function arrowPath(x1, y1, x2, y2) {
  const [dx, dy] = [x2 - x1, y2 - y1];
  const length = Math.hypot(dx, dy);
  const shaft = `M${x1.toFixed(1)},${y1.toFixed(1)}l${dx.toFixed(1)},${dy.toFixed(1)}`;
  if (length < LEAST_PX) return shaft;
  const size = HEAD_PX / length;
  const [ux, uy] = [-size * dx, -size * dy];
  const barb = (turn) => `${(ux - turn * uy).toFixed(1)},${(uy + turn * ux).toFixed(1)}`;
  const [a, b] = [barb(0.6), barb(-0.6)];
  return `${shaft}l${a}M${x2.toFixed(1)},${y2.toFixed(1)}l${b}`;
}

// Circles around {x, y} with `radius` px of the image times the factor.
export const circles = (points, factor, className) =>
  Plot.link(points, {
    x1: "x",
    y1: "y",
    x2: ({ x, radius }) => x + factor * radius,
    y2: "y",
    clip: true,
    render: asOnePath(className, ({ x1, y1, x2 }, i) => circlePath(x1[i], y1[i], Math.abs(x2[i] - x1[i]))),
  });

function circlePath(x, y, radius) {
  const r = radius.toFixed(1);
  return `M${(x - radius).toFixed(1)},${y.toFixed(1)}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0Z`;
}

// The round factor that enlarges each of [[length, wanted]] (px) to no more than is wanted.
export function factorFor(...lengths) {
  const factors = lengths.filter(([length]) => length > 0).map(([length, wanted]) => wanted / length);
  return factors.length ? roundBelow(Math.min(...factors)) : 1;
}

// A list of factors around the one that suits; onChange(factor).
export function factorChooser(suits, name, onChange) {
  const select = html(
    "select",
    { name, onchange: () => onChange(Number(select.value)) },
    FACTORS.map((times) => Number((times * suits).toPrecision(3))).map((factor) =>
      html("option", { value: factor, selected: factor === suits }, `${factor}×`),
    ),
  );
  return html("label", null, "Arrows enlarged ", select);
}
