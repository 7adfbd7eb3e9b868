// The gain over time, and the factors by which limits slowed the robot.
import { append, figure, html, muted } from "../shared/dom.js";
import { isNumber } from "../shared/format.js";
import { COLOR, key } from "../shared/plots.js";
import { timePlot } from "../shared/time_plot.js";

const HEIGHT = 210;

export function renderGain(section, run) {
  const { gain_per_s: gain, speed_factor: speed, singularity_factor: singularity } = run.data.cycles;
  const factors = [
    { label: "speed limit", values: speed, color: COLOR.first },
    { label: "nearness to a singularity", values: singularity, color: COLOR.second, dash: "6 3" },
  ].filter(({ values }) => values?.some(isNumber));
  if (!gain?.some(isNumber) && factors.length === 0) return append(section, muted("Not recorded."));
  append(
    section,
    html(
      "div",
      { class: "panels" },
      gain?.some(isNumber) && gainPlot(gain, run),
      factors.length > 0 && factorPlot(factors, run),
    ),
  );
}

const gainPlot = (values, run) =>
  figure(
    "The rate at which the law lets the error fall where no limit holds the robot back.",
    html("h4", null, "Gain"),
    timePlot(run, [{ label: "gain", values, color: COLOR.first }], {
      description: "The gain over time",
      unit: "1/s",
      height: HEIGHT,
      zero: true,
    }),
  );

const factorPlot = (factors, run) =>
  figure(
    "What is left of the speeds that the law asked for; 1: all.",
    html("h4", null, "Factors on the speeds"),
    key(factors.map(({ label, color, dash }) => [dash ? "dashes" : "line", color, label])),
    timePlot(run, factors, {
      description: "Factors on the speeds over time",
      unit: "",
      height: HEIGHT,
      domain: [0, 1.05],
    }),
  );
