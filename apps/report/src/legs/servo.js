// The simulated servo of the chosen set: the errors of its directions, and how far the platform is from the goal.
import { append, figure, html, muted } from "../shared/dom.js";
import { legColor } from "../shared/leg_colors.js";
import { COLOR, key } from "../shared/plots.js";
import { DEGREES, MM, MRAD } from "../shared/quantities.js";
import { timePlot } from "../shared/time_plot.js";
import { endOf } from "./wording.js";

const TALL = 300;
const SMALL = 210;
// Below this a distance (m or rad) is rounding.
const NOTHING = 1e-12;

const scaled = (values, { scale }) => values.map((value) => (value > NOTHING ? scale * value : null));

export function renderServo(section, { data, set }) {
  const found = data.simulations?.[set.index];
  if (!found)
    return append(
      section,
      muted("Not simulated: the best set is, and those of which nothing is proved about the way."),
    );
  if (!found.errors_rad.flat().some((value) => value > NOTHING))
    return append(section, muted("Simulated: the seen legs point as at the goal from the start."));
  append(
    section,
    directionPlot(found, set),
    html(
      "div",
      { class: "panels" },
      distancePlot(found, "position_from_goal_m", "Position", MM),
      distancePlot(found, "rotation_from_goal_rad", "Rotation", DEGREES),
    ),
  );
}

function directionPlot({ time_s: times, errors_rad: errors }, set) {
  const curves = set.legs.map((leg, index) => ({
    label: `leg ${leg}`,
    values: scaled(errors[index], MRAD),
    color: legColor(leg - 1),
  }));
  const end = set.simulation ? `At the end ${endOf(set.simulation)}.` : "";
  return figure(
    ["Sine of the angle between each seen direction and that at the goal.", end].join(" "),
    html("h4", null, "Errors of the seen directions"),
    key(curves.map(({ color, label }) => ["line", color, label])),
    timePlot({ times }, curves, {
      description: "Errors of the seen directions over time",
      unit: MRAD.unit,
      height: TALL,
      log: true,
    }),
  );
}

function distancePlot(found, name, title, quantity) {
  const values = scaled(found[name], quantity);
  if (!values.some(Boolean)) return null;
  return figure(
    null,
    html("h4", null, `${title}: distance from the goal`),
    timePlot({ times: found.time_s }, [{ label: title.toLowerCase(), values, color: COLOR.first }], {
      description: `${title} of the platform: distance from the goal over time`,
      unit: quantity.unit,
      height: SMALL,
      log: true,
    }),
  );
}
