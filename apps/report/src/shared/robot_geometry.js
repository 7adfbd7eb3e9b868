// Where the robot's joints are at a pose, and where free motions take the platform. SI, in base. No page elements here.
import { vec3 } from "gl-matrix";

// place: {rotation_xyzw, translation_m}, base_from_platform.
export const inBase = ({ rotation_xyzw: rotation, translation_m: translation }, point) =>
  vec3.add([], vec3.transformQuat([], point, rotation), translation);

// {legs: [{base, platform, radius}], origin, up: {base, platform}} with points in base; null without a robot or place.
export function robotAt(robot, place) {
  if (!robot?.legs?.length || !place) return null;
  const legs = robot.legs.map(({ base_joint_m: base, platform_joint_m: platform, radius_m: radius }) => ({
    base,
    platform: inBase(place, platform),
    radius: radius ?? 0,
  }));
  return { ...frameAt(place), legs };
}

const frameAt = ({ rotation_xyzw: rotation, translation_m: origin }) => ({
  origin,
  up: { base: [0, 0, 1], platform: vec3.transformQuat([], [0, 0, 1], rotation) },
});

export function middle(points) {
  const sum = points.reduce((total, point) => vec3.add([], total, point), [0, 0, 0]);
  return vec3.scale([], sum, 1 / Math.max(1, points.length));
}

// Points after a small twist (v, w) of the platform about its origin, scaled so that the farthest moves by `reach`.
export function movedBy(points, origin, [vx, vy, vz, ...turn], reach) {
  const moves = points.map((point) =>
    vec3.add([], [vx, vy, vz], vec3.cross([], turn, vec3.subtract([], point, origin))),
  );
  const largest = Math.max(...moves.map((move) => vec3.length(move)));
  const scale = largest > 0 ? reach / largest : 0;
  return points.map((point, index) => vec3.scaleAndAdd([], point, moves[index], scale));
}

// A pose's free motion (in the units of the document) as a twist in SI.
export const twistOf = (motion, metres, radians) =>
  motion.map((value, index) => (value ?? 0) * (index < 3 ? metres : radians));

// The rotation vector (rad) of a unit quaternion, of an angle of at most half a turn.
export function rotationVector([x, y, z, w]) {
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, Math.abs(w));
  const scale = sine > 0 ? (Math.sign(w) || 1) * (angle / sine) : 0;
  return [x, y, z].map((value) => value * scale + 0);
}

// The same as robotAt, of legs that bend: places [{start_m (of the last segment; null where the leg does not reach),
// platform_joint_m}], in base, at the pose `place`. A leg that does not reach has no segments.
export function robotAlong(robot, places, place) {
  const legs = robot.legs.map(({ base_joint_m: base, radius_m: radius }, index) => {
    const { start_m: start, platform_joint_m: platform } = places[index];
    return {
      base,
      platform,
      radius: radius ?? 0,
      segments: start && segmentsAlong([base, start, platform], radius),
    };
  });
  return { ...frameAt(place), legs };
}

// Between neighbours that are apart.
const segmentsAlong = (points, radius) =>
  points
    .slice(1)
    .map((to, index) => ({ from: points[index], to, radius: radius ?? 0 }))
    .filter(({ from, to }) => vec3.distance(from, to) > 1e-9);
