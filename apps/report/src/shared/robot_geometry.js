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
  const up = { base: [0, 0, 1], platform: vec3.transformQuat([], [0, 0, 1], place.rotation_xyzw) };
  return { legs, origin: place.translation_m, up };
}

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
