// The robot at the chosen moment of the run, with the path of its platform, to be turned and played.
import { vec3 } from "gl-matrix";
import { copyable } from "../shared/copy_table.js";
import { html, svg, table } from "../shared/dom.js";
import { MISSING, fixed, isNumber, significant } from "../shared/format.js";
import {
  paintAxes,
  paintDot,
  paintGhost,
  paintName,
  paintNumbers,
  paintRobot,
  path,
} from "../shared/paint_robot.js";
import { COLOR, key } from "../shared/plots.js";
import { MM } from "../shared/quantities.js";
import { robotAt } from "../shared/robot_geometry.js";
import { paintScaleBars } from "../shared/scale_bars.js";
import { sparse } from "../shared/thinning.js";
import { TurnableView } from "../shared/turnable_view.js";
import { START, enclosing, projection, screenAxes } from "../shared/turntable.js";
import { centersOf, deviations, firstOf, lastOf, straightWay } from "./path_geometry.js";
import { MM_PER_S, ofError } from "./quantities.js";

// Of the scene's radius.
const AXIS_LENGTH = 0.3;
const MARGIN = 1.06;
const FINEST_STEP = 1 / 600;
const SAME_PLACE = 0.02;
const CLOSEST = 0.02;
const CLOSE_MARGIN = 1.5; // of the path's radius
const LEAST_BEND = 0.01; // of the way's length
const LEVEL = 0.1; // upward part of a direction to the eye that counts as neither from above nor from below
const ELEVATION = { least: (20 * Math.PI) / 180, most: (48 * Math.PI) / 180 };

export const canDrawPath = ({ robot, cycles }) =>
  Boolean(robot?.legs?.length && cycles?.poses?.some(Boolean));

export class PathView {
  constructor(run) {
    this.run = run;
    const { cycles, goal, robot } = run.data;
    this.goal = goal?.base_from_platform ?? null;
    this.way = straightWay(run.data);
    this.ends = [
      ["start", firstOf(cycles.poses)],
      ["end", lastOf(cycles.poses)],
      ["goal", this.goal],
    ].filter(([, pose]) => pose);
    this.scene = sceneOf(robot, this.ends, centersOf(cycles.poses));
    this.closeUp = closeUpOf(this.ends, centersOf(cycles.poses), this.scene);
    this.isClose = false;
    this.paths = [this.pathOf("readings", cycles.poses), this.pathOf("true", cycles.true_poses)].filter(
      ({ points }) => points.length,
    );
    this.turnable = new TurnableView(
      "The robot at the chosen moment, with the path of its platform",
      (look, size) => this.draw(look, size),
      undefined,
      viewOf(this.way, centersOf(cycles.poses)),
    );
    this.side = html("div", { class: "view-side" });
    this.slider = this.sliderFor(run.times.length);
    this.output = html("output");
    this.element = this.layout();
    run.moment.onChange((index) => this.show(index));
    this.show(run.moment.index);
  }

  pathOf(name, poses) {
    const centers = centersOf(poses);
    const points = sparse(centers, FINEST_STEP * this.scene.radius).map((index) => centers[index]);
    return { name, points };
  }

  layout() {
    const controls = html("div", { class: "toolbar" }, this.turnable.buttons(), this.closeUpSwitch());
    const picture = html(
      "div",
      null,
      controls,
      this.turnable.element,
      this.timeBar(),
      this.legend(),
      this.turnable.hint(),
    );
    return html("div", { class: "view" }, picture, this.side);
  }

  closeUpSwitch() {
    const box = html("input", {
      type: "checkbox",
      name: "close-up",
      onchange: () => {
        this.isClose = box.checked;
        this.turnable.redraw();
      },
    });
    return html("label", null, box, "Close to the path");
  }

  sliderFor(count) {
    const slider = html("input", {
      type: "range",
      name: "moment",
      "aria-label": "Moment of the run",
      min: 0,
      max: count - 1,
      value: 0,
      oninput: () => {
        this.stop();
        this.run.moment.choose(Number(slider.value));
      },
    });
    return slider;
  }

  timeBar() {
    this.button = html(
      "button",
      {
        type: "button",
        title: "Play the run as fast as it went",
        onclick: () => (this.playing ? this.stop() : this.play()),
      },
      "Play",
    );
    return html("div", { class: "toolbar time-bar" }, this.button, this.slider, this.output);
  }

  play() {
    const { times, moment } = this.run;
    const from = moment.index < times.length - 1 ? moment.time : times[0];
    const began = performance.now();
    this.playing = true;
    this.button.textContent = "Pause";
    const next = (now) => {
      if (!this.playing) return;
      const time = from + Math.max(0, now - began) / 1000;
      moment.chooseTime(time);
      if (time < times[times.length - 1]) requestAnimationFrame(next);
      else this.stop();
    };
    requestAnimationFrame(next);
  }

  stop() {
    this.playing = false;
    this.button.textContent = "Play";
  }

  legend() {
    const isKnown = (name) => this.paths.some((each) => each.name === name);
    return key(
      [
        ["line", COLOR.first, "path of the platform's centre by the readings"],
        isKnown("true") && ["line", COLOR.second, "true path"],
        this.way && ["dashes", COLOR.muted, `straight ${this.way.toGoal ? "to the goal" : "to the end"}`],
        ["dashes", "var(--care)", "platform at the start and at the end"],
        this.goal && ["dashes", "var(--good)", "platform at the goal"],
      ].filter(Boolean),
    );
  }

  show(index) {
    const { cycles, robot } = this.run.data;
    this.robot = robotAt(robot, cycles.poses[index]);
    this.slider.value = String(index);
    this.output.textContent = `${significant(this.run.times[index])} s`;
    this.side.replaceChildren(momentTable(this.run, index));
    this.turnable.redraw();
  }

  draw(look, size) {
    const screen = projection(look, this.isClose ? this.closeUp : this.scene, size);
    const { radius } = this.scene;
    const bar = {
      className: "robot",
      pixelsPerUnit: screen.scale / MM.scale,
      unit: MM.unit,
      text: (value) => `bar = ${value}`,
    };
    return [
      ...(this.robot ? paintRobot(this.robot, screen, radius) : []),
      ...paintAxes([0, 0, 0], AXIS_LENGTH * radius, screen),
      ...(this.robot ? paintNumbers(this.robot, screen, radius) : []),
      ...this.ends.map(([name, pose]) => paintGhost(platformAt(this.run.data.robot, pose), screen, name)),
      ...this.lines(screen),
      ...this.labels(screen),
      ...(this.robot ? [paintDot(screen.at(this.robot.origin), "now", 5.5)] : []),
      ...paintScaleBars([bar], size),
    ];
  }

  lines(screen) {
    const line = (points, name) =>
      svg("path", { class: `way ${name}`, d: path(points.map(screen.at), false) });
    return [
      this.way && line([this.way.from, this.way.to], "straight"),
      // So that the paths stand out from the platform.
      this.paths.length > 0 && line(this.paths[0].points, "halo"),
      ...this.paths.map(({ name, points }) => line(points, name)),
    ].filter(Boolean);
  }

  // Names of the path's ends; those that are in one place share a label.
  labels(screen) {
    const near = SAME_PLACE * this.scene.radius;
    const places = [];
    for (const [name, { translation_m: point }] of this.ends) {
      const same = places.find((place) => vec3.distance(place.point, point) < near);
      if (same) same.names.push(name);
      else places.push({ point, names: [name] });
    }
    const shown = places.map((place) => ({ ...place, ...screen.at(place.point) }));
    const middle = shown.reduce((sum, { x }) => sum + x, 0) / Math.max(1, shown.length);
    return shown.flatMap(({ x, y, names }) => [
      paintDot({ x, y }, names[0]),
      paintName({ x, y }, names.join(", "), x < middle),
    ]);
  }
}

const count = (value) => (isNumber(value) ? String(value) : MISSING);

const platformAt = (robot, pose) => robotAt(robot, pose).legs.map(({ platform }) => platform);

function sceneOf(robot, ends, centers) {
  const joints = ends.flatMap(([, pose]) =>
    robotAt(robot, pose).legs.flatMap(({ base, platform }) => [base, platform]),
  );
  const { center, radius } = enclosing([...joints, ...centers.filter(Boolean)]);
  return { center, radius: MARGIN * radius };
}

// Of the size of the path, but not so near that nothing of the robot is seen.
function closeUpOf(ends, centers, scene) {
  const points = [...centers.filter(Boolean), ...ends.map(([, { translation_m: point }]) => point)];
  const { center, radius } = enclosing(points);
  return { center, radius: Math.max(CLOSE_MARGIN * radius, CLOSEST * scene.radius) };
}

// A first view in which the path is seen in full: along the normal of the plane in which it bends, from above but not
// from straight above; of a straight path, across it.
export function viewOf(way, centers) {
  if (!way) return START;
  const along = vec3.subtract([], way.to, way.from);
  const away = deviations(centers, way);
  const farthest = centers[away.indexOf(away.reduce((a, b) => Math.max(a, b ?? 0), 0))] ?? way.from;
  const bend = vec3.cross([], along, vec3.subtract([], farthest, way.from));
  const isBent = vec3.length(bend) > LEAST_BEND * vec3.squaredLength(along);
  const normal = isBent ? bend : vec3.cross([], along, [0, 0, 1]);
  if (!(vec3.length(normal) > 0)) return START;
  const unit = vec3.normalize([], normal);
  const isAbove = Math.abs(unit[2]) > LEVEL ? unit[2] > 0 : vec3.dot(unit, screenAxes(START).toward) > 0;
  const toEye = isAbove ? unit : vec3.negate([], unit);
  const elevation = Math.asin(toEye[2]);
  return {
    ...START,
    azimuth: Math.atan2(toEye[1], toEye[0]),
    elevation: Math.max(ELEVATION.least, Math.min(ELEVATION.most, elevation)),
  };
}

// What the run knew at a moment.
function momentTable({ data, times }, index) {
  const { cycles, document } = data;
  const error = ofError(document);
  const value = (name, { scale } = { scale: 1 }) =>
    isNumber(cycles[name]?.[index]) ? scale * cycles[name][index] : null;
  const center = cycles.poses[index]?.translation_m ?? [];
  const row = (name, number, unit, text = significant(number)) => ({ name, number, unit, text });
  const general = [
    row("time", times[index], "s"),
    row("cycle", index + 1, "", String(index + 1)),
    row("error", value("error", error), error.unit),
    row("edges seen", value("edges"), "", count(value("edges"))),
    ...["x", "y", "z"].map((name, axis) =>
      row(`platform ${name}`, MM.scale * center[axis], "mm", fixed(MM.scale * center[axis], 2)),
    ),
  ];
  const legs = (name, { unit, scale }, decimals) =>
    (cycles[name]?.[index] ?? []).map((each, leg) =>
      row(`leg ${leg + 1}`, scale * each, unit, fixed(isNumber(each) ? scale * each : NaN, decimals)),
    );
  const groups = [
    { rows: general },
    { label: "Speeds", rows: legs("joint_speeds_m_per_s", MM_PER_S, 2) },
    { label: "Readings", rows: legs("joint_readings_m", MM, 2) },
  ].filter(({ rows }) => rows.length);
  const columns = [
    { label: "", text: true, cell: ({ name }) => name },
    {
      label: "Value",
      cell: ({ number, text }) => html("data", { value: isNumber(number) ? String(number) : null }, text),
    },
    { label: "Unit", text: true, cell: ({ unit }) => unit },
  ];
  return copyable(table("At this moment", columns, groups));
}
