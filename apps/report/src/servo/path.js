// The path of the platform in space: the robot at any moment, and how far the path bends.
import { append, figure, html, muted } from "../shared/dom.js";
import { isNumber, significant } from "../shared/format.js";
import { COLOR, key } from "../shared/plots.js";
import { MM } from "../shared/quantities.js";
import { timePlot } from "../shared/time_plot.js";
import { centersOf, deviations, straightWay } from "./path_geometry.js";
import { PathView } from "./path_view.js";

const HEIGHT = 220;

export function renderPath(section, run) {
  const view = new PathView(run);
  append(section, view.element, deviationPlot(run));
}

function deviationPlot(run) {
  const { cycles } = run.data;
  const way = straightWay(run.data);
  if (!way) return muted("The place of the platform was not recorded.");
  const away = (poses) =>
    deviations(centersOf(poses), way).map((value) => (value === null ? null : MM.scale * value));
  const curves = [
    { label: "by the readings", values: away(cycles.poses), color: COLOR.first },
    { label: "true", values: away(cycles.true_poses), color: COLOR.second },
  ].filter(({ values }) => values.some(isNumber));
  const largest = Math.max(0, ...curves[0].values.filter(isNumber));
  return figure(
    `Distance of the platform's centre from the straight line ${way.toGoal ? "from the start to the goal" : "between the path's ends"}; ` +
      `by the readings it is ${significant(largest)} mm at most.`,
    html("h3", null, "Deviation from the straight line"),
    key(curves.map(({ label, color }) => ["line", color, label])),
    timePlot(run, curves, {
      description: "Deviation of the path from the straight line over time",
      unit: MM.unit,
      height: HEIGHT,
      zero: true,
    }),
  );
}
