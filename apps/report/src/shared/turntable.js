// How a scene is looked at: a parallel projection on a turntable, z up. No page elements here.
import { vec3 } from "gl-matrix";

export const START = { azimuth: (-62 * Math.PI) / 180, elevation: (22 * Math.PI) / 180, zoom: 1 };
const STEEPEST = Math.PI / 2;
// Where the scene's centre is, from the top: below it stand the scale bars.
const MIDDLE = 0.47;
const ZOOM = { least: 0.4, most: 12 };

const clamp = (value, least, most) => Math.max(least, Math.min(most, value));

// The view after a turn by angles (rad), or closer by a factor.
export const turned = (view, azimuth, elevation) => ({
  ...view,
  azimuth: view.azimuth + azimuth,
  elevation: clamp(view.elevation + elevation, -STEEPEST, STEEPEST),
});
export const zoomed = (view, factor) => ({ ...view, zoom: clamp(view.zoom * factor, ZOOM.least, ZOOM.most) });

// Unit vectors of the screen in the scene: to the right, up, and out of it toward the eye.
export function screenAxes({ azimuth, elevation }) {
  const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
  return { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], toward: [ce * ca, ce * sa, se] };
}

// scene: {center, radius} (m) that fills the screen at zoom 1; size: {width, height} (px).
// Returns {axes, scale (px/m), at(point) -> {x, y (px, y down), depth (m, more is nearer)}}.
export function projection(view, scene, { width, height }) {
  const axes = screenAxes(view);
  const scale = (view.zoom * Math.min(width, height)) / (2 * scene.radius);
  const at = (point) => {
    const from = vec3.subtract([], point, scene.center);
    return {
      x: width / 2 + scale * vec3.dot(from, axes.right),
      y: MIDDLE * height - scale * vec3.dot(from, axes.up),
      depth: vec3.dot(from, axes.toward),
    };
  };
  return { axes, scale, at };
}

// The sphere around the middle of the box around points.
export function enclosing(points) {
  const ends = [0, 1, 2].map((i) => {
    const values = points.map((point) => point[i]);
    return [Math.min(...values), Math.max(...values)];
  });
  const center = ends.map(([least, most]) => (least + most) / 2);
  const radius = Math.max(...points.map((point) => vec3.distance(point, center)));
  return { center, radius: radius > 0 ? radius : 1 };
}
