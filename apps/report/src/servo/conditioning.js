// How well what is seen determines the motion of the platform, and how far the robot is from a singularity.
import { append, figure, html, muted } from "../shared/dom.js";
import { isNumber } from "../shared/format.js";
import { COLOR } from "../shared/plots.js";
import { timePlot } from "../shared/time_plot.js";

const HEIGHT = 210;
const PANELS = [
  {
    name: "conditioning",
    title: "Conditioning of what is seen",
    caption:
      "Smallest over largest singular value of the edges' interaction with the platform's motion; 1 is best.",
  },
  {
    name: "motion_sigma_m",
    title: "σ of the motion told worst",
    caption: "What the noise of one image leaves of the platform's least certain motion, rotations at its radius.",
    unit: "mm",
    scale: 1e3,
  },
  {
    name: "robot_conditioning",
    title: "Conditioning of the robot",
    caption: "The same of the legs' speeds; near zero the robot is near a singularity.",
  },
  {
    name: "edges",
    title: "Edges seen",
    caption: "Of twelve, two a leg.",
    domain: [0, 12.6],
    ticks: 4,
  },
];

export function renderConditioning(section, run) {
  const panels = PANELS.filter(({ name }) => run.data.cycles[name]?.some(isNumber));
  if (panels.length === 0) return append(section, muted("Not recorded."));
  append(
    section,
    html(
      "div",
      { class: "panels" },
      panels.map((panel) => draw(panel, run)),
    ),
  );
}

const scaled = (scale) => (value) => (isNumber(value) ? scale * value : value);

const draw = ({ name, title, caption, unit = "", scale = 1, domain, ticks }, run) =>
  figure(
    caption,
    html("h4", null, title),
    timePlot(run, [{ label: title, values: run.data.cycles[name].map(scaled(scale)), color: COLOR.first }], {
      description: `${title} over time`,
      unit,
      height: HEIGHT,
      zero: true,
      domain,
      ticks,
    }),
  );
