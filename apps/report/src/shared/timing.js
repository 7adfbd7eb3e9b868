// Where the time went.
import { barCell, muted, table } from "./dom.js";
import { fixed, isNumber } from "./format.js";

// time: seconds by stage, with `total`; stages: {name: what it is called}, in order.
export function timeTable(time, stages) {
  const names = [...new Set([...Object.keys(stages), ...Object.keys(time)])].filter(
    (name) => name !== "total",
  );
  const rows = names
    .filter((name) => isNumber(time[name]))
    .map((name) => ({ label: stages[name] ?? name, time: time[name] }));
  if (rows.length === 0) return muted("Not recorded.");
  const total = isNumber(time.total) ? time.total : rows.reduce((sum, row) => sum + row.time, 0);
  return table(
    "Time by stage",
    [
      { label: "Stage", text: true, cell: ({ label }) => label },
      { label: "Time", unit: "s", cell: (row) => fixed(row.time, 2) },
      { label: "Share of the total", cell: (row) => barCell(row.time, total) },
    ],
    [{ rows: [...rows, { label: "Total", time: total }] }],
  );
}
