// The robot at the start, the goal or another assembly mode, the seen segments of its legs in colour; to be turned.
import { html, svg } from "../shared/dom.js";
import { legColor } from "../shared/leg_colors.js";
import {
  paintAxes,
  paintDot,
  paintGhost,
  paintName,
  paintNumbers,
  paintRobot,
  path,
} from "../shared/paint_robot.js";
import { key } from "../shared/plots.js";
import { MM } from "../shared/quantities.js";
import { middle, robotAlong } from "../shared/robot_geometry.js";
import { paintScaleBars } from "../shared/scale_bars.js";
import { TurnableView } from "../shared/turnable_view.js";
import { START, enclosing, projection } from "../shared/turntable.js";

// Of the scene's radius.
const AXIS_LENGTH = 0.25;
const MARGIN = 1.18; // with the numbers of the joints
// A planar robot is looked at from above.
const FROM_ABOVE = { ...START, azimuth: -Math.PI / 2, elevation: (75 * Math.PI) / 180 };
const PLANAR = ["planar", "planar-point"];

export const canDrawRobot = ({ robot, places }) => Boolean(robot?.legs?.length && places?.to);

export class RobotView {
  constructor(data, set) {
    this.data = data;
    this.seen = new Set(set.legs.map((leg) => leg - 1));
    this.places = placesOf(data, set);
    this.scene = sceneOf(this.places);
    const isPlanar = PLANAR.includes(data.document.platform);
    this.turnable = new TurnableView(
      "The robot at the chosen pose, with its platform at the others",
      (look, size) => this.draw(look, size),
      undefined,
      isPlanar ? FROM_ABOVE : START,
    );
    this.buttons = this.places.map(({ name, label }) =>
      html("button", { type: "button", "data-place": name, onclick: () => this.show(name) }, label),
    );
    this.caption = html("p", { class: "muted", "aria-live": "polite" });
    this.element = this.layout();
    // The goal itself is the first of its modes.
    this.show((this.places.find(({ kind }) => kind === "mode") ?? this.places.at(-1)).name);
  }

  layout() {
    return html(
      "div",
      { class: "robot-view" },
      html("div", { class: "buttons", role: "group", "aria-label": "Pose" }, this.buttons),
      html("div", { class: "toolbar" }, this.turnable.buttons()),
      this.turnable.element,
      key(this.legend()),
      this.caption,
      this.turnable.hint(),
    );
  }

  legend() {
    const hasOthers = this.places.some(({ kind }) => kind === "mode");
    return [
      ...[...this.seen].map((leg) => ["line", legColor(leg), `leg ${leg + 1}, seen`]),
      ["dashes", "var(--care)", "platform at the start"],
      ["dashes", "var(--good)", "platform and seen legs at the goal"],
      ...(hasOthers ? [["dashes", "var(--bad)", "platform at other modes"]] : []),
    ];
  }

  // name: "start", "mode 0" (the goal), "mode 1", …
  show(name) {
    this.place = this.places.find((place) => place.name === name) ?? this.places[0];
    for (const button of this.buttons)
      button.setAttribute("aria-pressed", String(button.dataset.place === this.place.name));
    const missing = this.place.robot.legs.flatMap(({ segments }, leg) => (segments ? [] : [leg + 1]));
    this.caption.textContent = missing.length
      ? `Dotted: legs that do not reach this pose as they bend at home: ${missing.join(", ")}.`
      : "";
    this.turnable.redraw();
  }

  draw(look, size) {
    const screen = projection(look, this.scene, size);
    const { radius } = this.scene;
    const robot = this.coloured(this.place.robot);
    const bar = {
      className: "robot",
      pixelsPerUnit: screen.scale / MM.scale,
      unit: MM.unit,
      text: (value) => `bar = ${value}`,
    };
    return [
      ...paintRobot(robot, screen, radius),
      ...paintAxes([0, 0, 0], AXIS_LENGTH * radius, screen),
      ...paintNumbers(robot, screen, radius),
      ...this.ghosts(screen),
      ...this.unreached(screen),
      ...paintScaleBars([bar], size),
    ];
  }

  coloured(robot) {
    const legs = robot.legs.map((leg, index) => {
      const segments = (leg.segments ?? []).map((segment, place, all) =>
        place === all.length - 1 && this.seen.has(index) ? { ...segment, color: legColor(index) } : segment,
      );
      return { ...leg, segments };
    });
    return { ...robot, legs };
  }

  ghosts(screen) {
    const others = this.places.filter((place) => place !== this.place);
    const joints = ({ legs }) => legs.map(({ platform }) => platform);
    return [
      ...others.map(({ kind, robot }) => paintGhost(joints(robot), screen, kind)),
      ...others.flatMap(({ kind, robot }) => (kind === "goal" ? this.seenLines(robot, screen) : [])),
      ...others.flatMap(({ kind, label, robot }) => {
        const at = screen.at(middle(joints(robot)));
        return [paintDot(at, kind), paintName(at, label.toLowerCase(), kind === "start")];
      }),
    ];
  }

  // That seen legs point alike shows beside those at the goal.
  seenLines(robot, screen) {
    return [...this.seen].flatMap((index) => {
      const segment = robot.legs[index]?.segments?.at(-1);
      if (!segment) return [];
      const ends = [segment.from, segment.to].map(screen.at);
      return svg("path", { class: "ghost goal", d: path(ends, false) });
    });
  }

  unreached(screen) {
    return this.place.robot.legs
      .filter(({ segments }) => !segments)
      .map(({ base, platform }) =>
        svg("path", { class: "unreached", d: path([base, platform].map(screen.at), false) }),
      );
  }
}

// [{name, label, kind, robot}]: start, goal, other modes.
function placesOf({ document, robot, places }, set) {
  const modes = set.assembly_modes?.modes ?? [];
  const drawn = places.modes?.[set.index] ?? [];
  const others = modes.slice(1).map((mode, index) => ({
    name: `mode ${index + 1}`,
    label: `Mode ${index + 1}`,
    kind: "mode",
    pose: mode.base_from_platform,
    legs: drawn[index + 1],
  }));
  return [
    { name: "start", label: "Start", kind: "start", pose: document.from, legs: places.from },
    { name: "mode 0", label: "Goal", kind: "goal", pose: document.to, legs: places.to },
    ...others,
  ]
    .filter(({ pose, legs }) => pose && legs)
    .map(({ pose, legs, ...place }) => ({ ...place, robot: robotAlong(robot, legs, pose) }));
}

// Around the robot at all its places, so that it keeps its size.
function sceneOf(places) {
  const points = places.flatMap(({ robot }) =>
    robot.legs.flatMap(({ base, platform, segments }) => [
      base,
      platform,
      ...(segments ?? []).map(({ to }) => to),
    ]),
  );
  const { center, radius } = enclosing(points);
  return { center, radius: MARGIN * radius };
}
