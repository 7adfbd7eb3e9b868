// Speeds and readings of the legs, and the limits that were in force.
import * as Plot from "@observablehq/plot";
import { copyable } from "../shared/copy_table.js";
import { append, figure, html, muted, table } from "../shared/dom.js";
import { capitalized, fixed, isNumber, significant } from "../shared/format.js";
import { legColor } from "../shared/leg_colors.js";
import { COLOR, TIP, key, plot, responsive } from "../shared/plots.js";
import { MM } from "../shared/quantities.js";
import { timeAxis, timePlot } from "../shared/time_plot.js";
import { MM_PER_S } from "./quantities.js";
import { limitSpans, mergedSpans } from "./spans.js";

const TALL = 300;
const SMALL = 190;
const ROW = 34;
const MOST_ROWS = 10;

export function renderLegs(section, run) {
  const limits = limitSpans(run.times, run.data.cycles.limits ?? []);
  const speeds = perLeg(run.data.cycles.joint_speeds_m_per_s, MM_PER_S);
  const readings = perLeg(run.data.cycles.joint_readings_m, MM);
  append(
    section,
    speeds.length > 0 && new SpeedPlot(speeds, limits, run).element,
    limitsInForce(limits, run),
    readings.length > 0 && html("h3", null, "Joint readings"),
    readings.length > 0 && readingPanels(readings, run),
  );
}

// One array of values a leg, in the unit.
const perLeg = (rows, { scale }) =>
  Array.from({ length: rows?.[0]?.length ?? 0 }, (_, leg) =>
    rows.map((row) => (isNumber(row?.[leg]) ? scale * row[leg] : null)),
  );

class SpeedPlot {
  constructor(speeds, limits, run) {
    Object.assign(this, { speeds, run });
    const spans = limits.flatMap((limit) => limit.spans);
    this.spans = mergedSpans(spans, finestGap(run.times));
    this.hidden = new Set();
    this.place = html("div");
    const limit = run.data.robot?.speed_limit_m_per_s;
    this.levels = isNumber(limit)
      ? [-1, 1].map((sign) => ({ value: sign * MM_PER_S.scale * limit, color: "var(--bad)", dash: "6 4" }))
      : [];
    this.element = figure(
      `Speeds as they were commanded${this.levels.length ? "; dashed: the limit" : ""}. ` +
        "Shaded: a limit was in force. A click on any plot over time moves the robot of “The path in space” there.",
      html("h3", null, "Speeds"),
      this.legSwitches(),
      this.place,
    );
    this.redraw();
  }

  legSwitches() {
    const toggle = (_, leg) => {
      const box = html("input", {
        type: "checkbox",
        checked: true,
        style: `accent-color:${legColor(leg)}`,
        onchange: () => {
          if (box.checked) this.hidden.delete(leg);
          else this.hidden.add(leg);
          this.redraw();
        },
      });
      const swatch = html("span", { class: "leg-swatch", style: `background:${legColor(leg)}` });
      return html("label", null, box, swatch, `leg ${leg + 1}`);
    };
    return html("div", { class: "leg-switches" }, this.speeds.map(toggle));
  }

  redraw() {
    const curves = this.speeds
      .map((values, leg) => ({ label: `leg ${leg + 1}`, values, color: legColor(leg), leg }))
      .filter(({ leg }) => !this.hidden.has(leg));
    const options = {
      description: "Speeds of the legs over time",
      unit: MM_PER_S.unit,
      height: TALL,
      zero: true,
      levels: [...this.levels, { value: 0 }],
      spans: this.spans,
    };
    this.place.replaceChildren(timePlot(this.run, curves, options));
  }
}

function limitsInForce(limits, run) {
  if (!run.data.cycles.limits?.length) return null;
  if (limits.length === 0) return muted("No limit was in force at any time.");
  const named = limits.map((limit, index) => ({ ...limit, name: letter(index) }));
  const columns = [
    { label: "", text: true, cell: ({ name }) => name },
    { label: "Limit", text: true, cell: ({ words }) => capitalized(words) },
    { label: "Cycles", cell: ({ cycles }) => String(cycles) },
    { label: "Together", unit: "s", cell: ({ seconds }) => significant(seconds) },
    { label: "From", unit: "s", cell: ({ spans }) => significant(spans[0].from) },
    { label: "To", unit: "s", cell: ({ spans }) => significant(spans[spans.length - 1].to) },
  ];
  return [
    html("h3", null, "Limits in force"),
    figure(
      named.length > MOST_ROWS ? `The ${MOST_ROWS} that were in force longest.` : null,
      responsive((width) => spanPlot(named.slice(0, MOST_ROWS), run, width)),
    ),
    html(
      "div",
      { class: "limits" },
      copyable(table("Limits, those in force longest first", columns, [{ rows: named }])),
    ),
  ];
}

// Gaps (s) that a drawing cannot show.
const finestGap = (times) => (times[times.length - 1] - times[0]) / 1000;

const letter = (index) => (index < 26 ? String.fromCharCode(65 + index) : String(index + 1));

// A row a limit: its words, and below them bars over the times at which it was in force.
function spanPlot(limits, { times, moment }, width) {
  const bars = limits.flatMap(({ name, words, spans }) =>
    mergedSpans(spans, finestGap(times)).map((span) => ({ name, words, ...span })),
  );
  const drawing = plot("When which limits were in force", {
    width,
    height: ROW * limits.length + 44,
    marginLeft: 52,
    marginRight: 12,
    marginTop: 4,
    marginBottom: 36,
    x: timeAxis(times),
    y: { type: "band", domain: limits.map(({ name }) => name), label: null, tickSize: 0, padding: 0 },
    marks: [
      Plot.barX(bars, { x1: "from", x2: "to", y: "name", fill: "var(--care)", insetTop: 19, insetBottom: 3 }),
      Plot.text(limits, {
        x: times[0],
        y: "name",
        text: "words",
        textAnchor: "start",
        dx: 4,
        dy: -6,
        fill: COLOR.text,
        lineWidth: Math.max(8, (width - 80) / 12.5),
        textOverflow: "ellipsis",
      }),
      Plot.tip(bars, Plot.pointerX({ x1: "from", x2: "to", y: "name", title: spanTip, ...TIP })),
    ],
  });
  moment.markIn(drawing);
  return drawing;
}

const spanTip = ({ words, from, to }) => `${words}\n${significant(from)} to ${significant(to)} s`;

function readingPanels(readings, run) {
  const legs = run.data.robot?.legs ?? [];
  const goal = run.data.goal?.joint_readings_m;
  return [
    key(
      [
        ["line", COLOR.muted, "reading"],
        goal && ["dashes", COLOR.text, "goal"],
        legs.some(({ joint_range_m: range }) => range) && ["line", "var(--bad)", "end of the range"],
      ].filter(Boolean),
    ),
    html(
      "div",
      { class: "panels small" },
      readings.map((values, leg) => readingPanel(values, leg, legs[leg]?.joint_range_m, goal?.[leg], run)),
    ),
  ];
}

function readingPanel(values, leg, range, goal, run) {
  const ends = (range ?? []).filter(isNumber).map((end) => MM.scale * end);
  const levels = [
    ...ends.map((value) => ({ value, color: "var(--bad)" })),
    ...(isNumber(goal) ? [{ value: MM.scale * goal, color: COLOR.text, dash: "4 3" }] : []),
  ];
  const all = [...values.filter(isNumber), ...levels.map(({ value }) => value)];
  const [least, most] = all.reduce(
    ([a, b], value) => [Math.min(a, value), Math.max(b, value)],
    [Infinity, -Infinity],
  );
  const room = 0.04 * (most - least) || 1;
  const nearest = nearestEnd(values, ends);
  return figure(
    nearest === null ? null : `Never nearer than ${fixed(nearest, 1)} mm to an end of its range.`,
    html("h4", null, `Leg ${leg + 1}`),
    timePlot(run, [{ label: `leg ${leg + 1}`, values, color: legColor(leg), width: 2.2 }], {
      description: `Reading of leg ${leg + 1} over time, within its range`,
      unit: MM.unit,
      height: SMALL,
      domain: [least - room, most + room],
      levels,
    }),
  );
}

// How near a leg came to an end of its range (mm); null without a range.
export function nearestEnd(values, ends) {
  if (ends.length < 2) return null;
  const [least, most] = ends;
  const rooms = values.filter(isNumber).map((value) => Math.min(value - least, most - value));
  return rooms.length ? rooms.reduce((a, b) => Math.min(a, b)) : null;
}
