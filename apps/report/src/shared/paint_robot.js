// The robot as SVG: plates, legs as shaded cylinders, axes, numbers of the joints; nearer things over farther ones.
import { polygonHull } from "d3";
import { vec3 } from "gl-matrix";
import { svg } from "./dom.js";
import { middle } from "./robot_geometry.js";

// Legs are cut into pieces for sorting by depth: they pass in front of each other.
const PIECES = 12;
const THINNEST_LEG = 0.009; // of the scene's radius
const PLATE = { thickness: 0.035, rim: 0.05 }; // of the scene's radius
const AXES = [
  { name: "x", direction: [1, 0, 0] },
  { name: "y", direction: [0, 1, 0] },
  { name: "z", direction: [0, 0, 1] },
];

export const path = (points, closed = true) =>
  `M${points.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join("L")}${closed ? "Z" : ""}`;

// The outline of points on the screen; of fewer than three, the points themselves.
export function outline(points) {
  const hull = polygonHull(points.map(({ x, y }) => [x, y]));
  return hull ? hull.map(([x, y]) => ({ x, y })) : points;
}

// robot: of robotAt, a leg's `segments` [{from, to, radius, color?}] instead of a straight one where it has them;
// radius: the scene's.
export function paintRobot(robot, screen, radius) {
  const joints = {
    base: robot.legs.map(({ base }) => base),
    platform: robot.legs.map(({ platform }) => platform),
  };
  const rise = vec3.subtract([], middle(joints.platform), middle(joints.base));
  const basePlate = plate("base", joints.base, robot.up.base, screen, radius);
  const platformPlate = plate("platform", joints.platform, robot.up.platform, screen, radius);
  const legs = svg("g", { class: "legs" }, paintLegs(robot.legs, screen, radius));
  // All legs lie on one side of each plate, so the side that the eye is on says what hides what.
  const seenFromLegs = (normal, direction) =>
    vec3.dot(normal, direction) * vec3.dot(normal, screen.axes.toward) >= 0;
  const baseBehind = seenFromLegs(robot.up.base, rise);
  const platformBehind = seenFromLegs(robot.up.platform, vec3.negate([], rise));
  return [
    baseBehind && basePlate,
    platformBehind && platformPlate,
    legs,
    !platformBehind && platformPlate,
    !baseBehind && basePlate,
  ].filter(Boolean);
}

// A flat plate through joints: its two faces, and between them the rim as the outline of both.
function plate(name, joints, normal, screen, radius) {
  const shift = vec3.scale([], normal, (PLATE.thickness * radius) / 2);
  const face = (sign) => joints.map((joint) => screen.at(vec3.scaleAndAdd([], joint, shift, sign)));
  const near = vec3.dot(normal, screen.axes.toward) >= 0 ? 1 : -1;
  const rim = (PLATE.rim * radius * screen.scale * 2).toFixed(1);
  return svg(
    "g",
    { class: `plate ${name}` },
    svg("path", { class: "rim", d: path(outline([...face(1), ...face(-1)])), "stroke-width": rim }),
    svg("path", { class: "face", d: path(outline(face(near))), "stroke-width": rim }),
  );
}

const segmentsOf = ({ base, platform, radius, segments }) =>
  segments ?? [{ from: base, to: platform, radius }];

function paintLegs(legs, screen, radius) {
  const segments = legs.flatMap(segmentsOf);
  const parts = segments.flatMap((segment, index) => segmentParts(segment, index, screen, radius));
  const gradients = segments.map((segment, index) => cylinderShade(segment, index, screen, radius));
  parts.sort((a, b) => a.depth - b.depth);
  return [svg("defs", null, gradients, ballShade()), ...parts.map(({ element }) => element)];
}

const drawnRadius = (segment, screen, radius) =>
  Math.max(segment.radius, THINNEST_LEG * radius) * screen.scale;

function segmentParts(segment, index, screen, radius) {
  const ends = [screen.at(segment.from), screen.at(segment.to)];
  const width = drawnRadius(segment, screen, radius);
  const between = (share) => mixed(ends[0], ends[1], share);
  const pieces = Array.from({ length: PIECES }, (_, piece) => ({
    depth: between((piece + 0.5) / PIECES).depth,
    // A little longer than it is, for no gap to the next.
    element: svg("path", {
      class: "leg",
      d: path([between(piece / PIECES), between(Math.min(1, (piece + 1.08) / PIECES))], false),
      stroke: `url(#leg-${index})`,
      "stroke-width": (2 * width).toFixed(2),
    }),
  }));
  const balls = ends.map(({ x, y, depth }) => ({
    depth: depth + 1.5 * segment.radius,
    element: svg("circle", {
      class: "ball",
      cx: x.toFixed(1),
      cy: y.toFixed(1),
      r: (1.35 * width).toFixed(2),
    }),
  }));
  return [...pieces, ...balls];
}

const mixed = (a, b, share) => ({
  x: a.x + share * (b.x - a.x),
  y: a.y + share * (b.y - a.y),
  depth: a.depth + share * (b.depth - a.depth),
});

const stops = (entries) =>
  entries.map(([offset, color]) => svg("stop", { offset, style: `stop-color:${color}` }));

const metal = (name) => `var(--metal-${name})`;

// Light across a cylinder, from the upper left of the screen; a coloured one keeps its colour but for the gloss.
function cylinderShade(segment, index, screen, radius) {
  const [a, b] = [screen.at(segment.from), screen.at(segment.to)];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const width = drawnRadius(segment, screen, radius);
  let across = { x: (-(b.y - a.y) / length) * width, y: ((b.x - a.x) / length) * width };
  if (across.x + across.y < 0) across = { x: -across.x, y: -across.y };
  return svg(
    "linearGradient",
    {
      id: `leg-${index}`,
      gradientUnits: "userSpaceOnUse",
      x1: a.x - across.x,
      y1: a.y - across.y,
      x2: a.x + across.x,
      y2: a.y + across.y,
    },
    stops([
      [0, segment.color ?? metal("mid")],
      [0.3, metal("light")],
      [0.65, segment.color ?? metal("mid")],
      [1, segment.color ?? metal("dark")],
    ]),
  );
}

const ballShade = () =>
  svg(
    "radialGradient",
    { id: "ball", cx: 0.35, cy: 0.3, r: 0.75 },
    stops([
      [0, metal("light")],
      [0.5, metal("mid")],
      [1, metal("dark")],
    ]),
  );

// Numbers beside the base joints, away from the middle.
export function paintNumbers(robot, screen, radius) {
  const center = middle(robot.legs.map(({ base }) => base));
  return robot.legs.map(({ base }, index) => {
    const out = vec3.subtract([], base, center);
    const length = vec3.length(out) || 1;
    const { x, y } = screen.at(vec3.scaleAndAdd([], base, out, (0.16 * radius) / length));
    return svg("text", { class: "joint-number", x: x.toFixed(1), y: y.toFixed(1) }, String(index + 1));
  });
}

// The axes of base, with their names.
export function paintAxes(origin, length, screen) {
  const start = screen.at(origin);
  return AXES.map(({ name, direction }) => {
    const end = screen.at(vec3.scaleAndAdd([], origin, direction, length));
    const label = screen.at(vec3.scaleAndAdd([], origin, direction, 1.14 * length));
    return svg(
      "g",
      { class: `axis axis-${name}` },
      arrow(start, end),
      svg("text", { x: label.x.toFixed(1), y: label.y.toFixed(1) }, name),
    );
  });
}

// A line with a head; seen along itself, only a line.
export function arrow(start, end) {
  const [x, y] = [end.x - start.x, end.y - start.y];
  const length = Math.hypot(x, y);
  if (length < 4) return svg("path", { d: path([start, end], false) });
  const [ux, uy] = [x / length, y / length];
  const head = Math.min(9, 0.4 * length);
  const wing = (side) => ({
    x: end.x - head * (ux - 0.45 * side * uy),
    y: end.y - head * (uy + 0.45 * side * ux),
  });
  return svg("path", { d: path([start, end], false) + path([wing(1), end, wing(-1)], false) });
}

// The outline of a platform with its joints at these points.
export const paintGhost = (joints, screen, name = "") =>
  svg("path", { class: `ghost ${name}`.trim(), d: path(outline(joints.map(screen.at))) });

// A place in the scene, and its name beside it, to the left or the right.
export const paintDot = ({ x, y }, name, radius = 4) =>
  svg("circle", { class: `way-dot ${name}`, cx: x.toFixed(1), cy: y.toFixed(1), r: radius });

export const paintName = ({ x, y }, text, isLeft) =>
  svg(
    "text",
    {
      class: "place",
      x: (x + (isLeft ? -9 : 9)).toFixed(1),
      y: (y - 7).toFixed(1),
      "text-anchor": isLeft ? "end" : "start",
    },
    text,
  );
