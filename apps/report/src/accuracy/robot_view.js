// The robot at the selected pose, with its magnified errors at the platform.
import { append, checkbox, html } from "../shared/dom.js";
import { sentence, tick } from "../shared/format.js";
import { paintAxes, paintGhost, paintNumbers, paintRobot } from "../shared/paint_robot.js";
import { movedBy, robotAt, twistOf } from "../shared/robot_geometry.js";
import { paintScaleBars } from "../shared/scale_bars.js";
import { TurnableView } from "../shared/turnable_view.js";
import { enclosing, projection } from "../shared/turntable.js";
import { magnification } from "./error_geometry.js";
import { paintDirection, paintEllipsoid, paintPolyhedron } from "./paint_errors.js";
import { poseTable } from "./pose_table.js";
import { metresPer, radiansPer, unitsOf } from "./units.js";

// Of the scene's radius.
const GHOST_REACH = 0.16;
const AXIS_LENGTH = 0.3;
const MARGIN = 1.06;
// Below this width (px) the scale bars need a strip of their own.
const NARROW = 600;
const BARS_HEIGHT = 70;

export const canDrawRobot = (data) => Boolean(data.robot?.legs?.length && data.poses_si?.some(Boolean));

export class RobotView {
  constructor(data) {
    this.data = data;
    this.units = data.document?.units ?? {};
    this.shown = { polyhedron: true, ellipsoid: true, rotation: false };
    this.turnable = new TurnableView(
      "The robot seen from the side, with its magnified errors at the platform",
      (view, size) => this.draw(view, size),
    );
    this.caption = html("p", { class: "key", "aria-live": "polite" });
    this.side = html("div", { class: "view-side" });
    this.scene = sceneOf(data);
  }

  renderInto(section) {
    const picture = html(
      "div",
      null,
      this.toolbar(),
      this.turnable.element,
      this.caption,
      this.turnable.hint(),
    );
    append(section, html("div", { class: "view" }, picture, this.side));
  }

  toolbar() {
    const redraw = () => {
      this.describe();
      this.turnable.redraw();
    };
    const toggle = (name, label) => checkbox(this.shown, name, label, redraw);
    return html(
      "div",
      { class: "toolbar" },
      toggle("polyhedron", "Polyhedron"),
      toggle("ellipsoid", "Ellipsoid"),
      toggle("rotation", "Rotation errors instead of position errors"),
      this.turnable.buttons(),
    );
  }

  show(pose) {
    this.pose = pose;
    this.robot = robotAt(this.data.robot, this.data.poses_si?.[pose?.index]);
    this.side.replaceChildren(poseTable(this.data.document, pose));
    this.describe();
    this.turnable.redraw();
  }

  get quantity() {
    return this.shown.rotation ? "rotation" : "position";
  }

  // {times: how much errors are magnified (rotations: m of picture a rad), perUnit: m of picture a unit of the document}
  magnified() {
    const si = this.shown.rotation ? radiansPer(this.units.angle) : metresPer(this.units.length);
    const sizeOf = (pose) => si * (pose?.max_error?.[this.quantity] ?? 0);
    const error = sizeOf(this.pose);
    if (!(error > 0)) return null;
    const times = magnification(error, this.data.document.poses.map(sizeOf), this.scene.errorRoom);
    return { times, perUnit: times * si };
  }

  describe() {
    const caption = () => {
      if (!this.robot) return ["There is no picture of this pose."];
      if (this.magnified()) return legend(this.shown);
      if (this.pose.free_motions?.length)
        return ["Dashed: where the platform can go with all joints locked; how far is arbitrary."];
      return [sentence(this.pose.message ?? "No errors are known at this pose")];
    };
    this.caption.replaceChildren(...caption());
  }

  draw(view, size) {
    if (!this.robot) return [];
    const strip = size.width < NARROW ? BARS_HEIGHT : 0;
    const screen = projection(view, this.scene, { ...size, height: size.height - strip });
    const { radius } = this.scene;
    return [
      ...paintRobot(this.robot, screen, radius),
      ...paintAxes([0, 0, 0], AXIS_LENGTH * radius, screen),
      ...paintNumbers(this.robot, screen, radius),
      ...this.ghosts(screen),
      ...this.errors(screen),
      ...this.bars(screen, size),
    ].filter(Boolean);
  }

  errors(screen) {
    const magnified = this.magnified();
    if (!magnified) return [];
    const { origin } = this.robot;
    const { perUnit } = magnified;
    const { polyhedron, ellipsoid, largest_direction: largest, max_error: error } = this.pose;
    const kind = this.quantity;
    return [
      this.shown.polyhedron && paintPolyhedron(polyhedron?.[kind], origin, perUnit, screen),
      this.shown.ellipsoid && paintEllipsoid(ellipsoid?.[kind], origin, perUnit, screen),
      paintDirection(largest?.[kind], error[kind], origin, perUnit, screen),
    ];
  }

  ghosts(screen) {
    const joints = this.robot.legs.map(({ platform }) => platform);
    const reach = GHOST_REACH * this.scene.radius;
    return (this.pose.free_motions ?? []).flatMap((motion) => {
      const twist = twistOf(motion, metresPer(this.units.length), radiansPer(this.units.angle));
      return [-1, 1].map((sign) =>
        paintGhost(movedBy(joints, this.robot.origin, twist, sign * reach), screen),
      );
    });
  }

  bars(screen, size) {
    const { length, angle } = unitsOf(this.data.document);
    const metres = metresPer(this.units.length);
    const robot = {
      className: "robot",
      pixelsPerUnit: screen.scale * metres,
      unit: length,
      text: (value) => `robot: bar = ${value}`,
    };
    const magnified = this.magnified();
    if (!magnified) return paintScaleBars([robot], size);
    const name = this.shown.rotation ? "rotation errors" : `errors × ${tick(magnified.times)}`;
    const errors = {
      className: "errors",
      pixelsPerUnit: screen.scale * magnified.perUnit,
      unit: this.shown.rotation ? angle : length,
      text: (value) => `${name}; bar = ${value}`,
    };
    return paintScaleBars([robot, errors], size);
  }
}

// Around the robot at all its poses, so that it keeps its size from pose to pose.
function sceneOf(data) {
  const points = (data.poses_si ?? []).flatMap((place) => {
    const robot = robotAt(data.robot, place);
    return robot ? robot.legs.flatMap(({ base, platform }) => [base, platform]) : [];
  });
  const { center, radius } = enclosing(points.length ? points : [[0, 0, 0]]);
  return { center, radius: MARGIN * radius, errorRoom: platformSize(data.robot) || radius / 2 };
}

// As large as the platform is what errors are magnified to.
const platformSize = (robot) =>
  Math.max(0, ...(robot?.legs ?? []).map(({ platform_joint_m: joint }) => Math.hypot(...joint)));

function legend({ polyhedron, ellipsoid, rotation }) {
  const entry = (name, text) => html("span", null, html("span", { class: `swatch ${name}` }), text);
  return [
    polyhedron &&
      entry("polyhedron", "polyhedron: all errors that joint errors within their bounds can cause"),
    ellipsoid &&
      entry("ellipsoid", "ellipsoid: those whose joint errors, taken together, are no larger than one bound"),
    entry("direction", rotation ? "the largest error, along its axis of rotation" : "the largest error"),
  ].filter(Boolean);
}
