// The errors over time: the controlled one, those that nothing controls, and how fast they fall.
import { copyable } from "../shared/copy_table.js";
import { append, checkbox, figure, html, muted, table } from "../shared/dom.js";
import { MISSING, isNumber, significant } from "../shared/format.js";
import { legColor } from "../shared/leg_colors.js";
import { COLOR, key } from "../shared/plots.js";
import { timePlot } from "../shared/time_plot.js";
import { errorSeries, exponentialRate } from "./error_series.js";
import { periodOf } from "./spans.js";

const TALL = 320;
const SMALL = 210;
// A logarithmic axis is the first choice for errors that fall by more than this.
const WIDE = 20;

export function renderErrors(section, run) {
  const series = errorSeries(run.data);
  if (series.length === 0) return append(section, muted("No errors were recorded."));
  append(section, new ErrorPlots(series, run).element, rateTable(series, run));
}

class ErrorPlots {
  constructor(series, run) {
    this.run = run;
    this.panels = panelsOf(series);
    this.shown = { log: fallsFar(series[0].values) };
    this.place = html("div");
    this.element = html("div", null, this.toolbar(), this.place);
    this.redraw();
  }

  toolbar() {
    const withSingles = this.panels.flatMap(({ key: name, curves }) => (curves[0].single ? [name] : []));
    const toggle = (name, label) => checkbox(this.shown, name, label, () => this.redraw());
    return html(
      "div",
      { class: "toolbar" },
      toggle("log", "Logarithmic: an exponential fall is a straight line"),
      withSingles.map((name) => toggle(name, this.singleLabel(name))),
    );
  }

  singleLabel(name) {
    const { curves } = this.panels.find((panel) => panel.key === name);
    return curves[0].single.length > 6 ? "Single edges" : "Single directions";
  }

  redraw() {
    const [first, ...others] = this.panels.map((panel, index) =>
      this.draw(panel, index === 0 ? TALL : SMALL),
    );
    this.place.replaceChildren(first, html("div", { class: "panels" }, others));
  }

  draw(panel, height) {
    const { label, unit, curves } = panel;
    const { log } = this.shown;
    const drawn = [
      ...this.singles(panel),
      ...curves.map((curve, index) => mainCurve(curve, index, this.shown[panel.key])),
    ];
    const tolerance = curves[0].tolerance;
    if (tolerance?.some(isNumber))
      drawn.unshift({ label: "tolerance", values: tolerance, color: COLOR.muted, width: 1.4, dash: "5 4" });
    return figure(
      null,
      html("h4", null, label),
      keyOf(curves, this.shown[panel.key]),
      timePlot(this.run, drawn, { description: `${label} over time`, unit, height, log, zero: true }),
    );
  }

  singles({ key: name, curves }) {
    if (!this.shown[name]) return [];
    return (curves[0].single ?? []).map((single) => ({ ...single, color: legColor(single.leg), width: 0.9 }));
  }
}

const COLORS = [COLOR.first, COLOR.second];
// Beside single curves in colours all together is black.
const colorOf = (index, hasSingles) => (hasSingles ? COLOR.text : COLORS[index]);
const mainCurve = ({ label, values }, index, hasSingles) => ({
  label,
  values,
  color: colorOf(index, hasSingles),
  width: 2.2,
});

// A curve that is alone needs none.
function keyOf(curves, hasSingles) {
  const entries = entriesOf(curves, hasSingles);
  return entries.length > 1 && key(entries);
}

function entriesOf(curves, hasSingles) {
  const [{ tolerance, single }] = curves;
  const several = curves.length > 1;
  return [
    ...curves.map(({ source }, index) => [
      "line",
      colorOf(index, hasSingles),
      several ? source : "all together",
    ]),
    ...(tolerance?.some(isNumber) ? [["dashes", COLOR.muted, "tolerance"]] : []),
    ...(hasSingles
      ? [0, 1, 2, 3, 4, 5]
          .filter((leg) => single.some((each) => each.leg === leg && each.values.some(isNumber)))
          .map((leg) => ["line", legColor(leg), `leg ${leg + 1}`])
      : []),
  ];
}

// Curves of one panel, such as a pose by readings and the true one, are drawn together.
function panelsOf(series) {
  const panels = new Map();
  for (const each of series) {
    const name = each.panel ?? each.key;
    if (!panels.has(name))
      panels.set(name, { key: name, label: each.panel ?? each.label, unit: each.unit, curves: [] });
    panels.get(name).curves.push(each);
  }
  return [...panels.values()];
}

// What a constant gain leads to with commands at intervals; null for a gain that changes.
function expectedRate(gains, times) {
  const [gain, period] = [gains?.[0], periodOf(times)];
  if (!isNumber(gain) || !(period > 0) || gains.some((each) => each !== gain) || gain * period >= 1)
    return null;
  const rate = -Math.log(1 - gain * period) / period;
  return (
    ` In steps of ${significant(1e3 * period)} ms that is ${significant(rate)} 1/s for the gain of ` +
    `${significant(gain)} 1/s.`
  );
}

function fallsFar(values) {
  const present = values.filter((value) => isNumber(value) && value > 0);
  return Math.max(...present) > WIDE * Math.min(...present);
}

function rateTable(series, { data, times }) {
  const rows = series.map((each) => {
    const present = each.values.filter(isNumber);
    const rate = exponentialRate(times, each.values, data.cycles.limits);
    return { ...each, start: present[0], end: present[present.length - 1], rate };
  });
  const digits = (value) =>
    html("data", { value: isNumber(value) ? String(value) : null }, significant(value));
  const columns = [
    { label: "Error", text: true, cell: ({ label }) => label },
    { label: "Unit", text: true, cell: ({ unit }) => unit },
    { label: "At the start", cell: ({ start }) => digits(start) },
    { label: "At the end", cell: ({ end }) => digits(end) },
    { label: "Rate of its fall", unit: "1/s", cell: ({ rate }) => digits(rate?.rate_per_s) },
    {
      label: "Fitted",
      unit: "s",
      cell: ({ rate }) => (rate ? `${significant(rate.from_s)} to ${significant(rate.to_s)}` : MISSING),
    },
  ];
  return [
    copyable(table("How fast the errors fall", columns, [{ rows }])),
    muted(
      "The rate is the slope of the straight line through the logarithm of the error, over the cycles in which no " +
        "limit was in force and the error was well above what was left at the end. An exponential fall under the law " +
        "has the gain as its rate.",
      expectedRate(data.cycles.gain_per_s, times),
    ),
  ];
}
