// Where the time went.
import { append, barCell, muted, table } from "../shared/dom.js";
import { fixed, isNumber } from "../shared/format.js";

const STAGES = {
  read: "Read the session",
  detect: "Find the edges",
  solve: "Estimate",
  covariance: "Covariance",
};

export function renderTiming(section, data) {
  const time = data.calibration?.time_s ?? {};
  const names = [...new Set([...Object.keys(STAGES), ...Object.keys(time)])].filter(
    (name) => name !== "total",
  );
  const rows = names
    .filter((name) => isNumber(time[name]))
    .map((name) => ({ label: STAGES[name] ?? name, time: time[name] }));
  if (rows.length === 0) {
    append(section, muted("Not recorded."));
    return;
  }
  const total = isNumber(time.total) ? time.total : rows.reduce((sum, row) => sum + row.time, 0);
  append(
    section,
    table(
      "Time by stage",
      [
        { label: "Stage", text: true, cell: ({ label }) => label },
        { label: "Time", unit: "s", cell: (row) => fixed(row.time, 2) },
        { label: "Share of the total", cell: (row) => barCell(row.time, total) },
      ],
      [{ rows: [...rows, { label: "Total", time: total }] }],
    ),
  );
}
