// When which limits were in force. No page elements here.

const PERCENT = /\d+(?:\.\d+)? %/g;

// limits: one text a cycle, clauses joined by "; ". Returns one entry a clause, those in force longest first:
// [{words, cycles, seconds, spans: [{from, to}]}] in s; percentages that change from cycle to cycle become a range.
export function limitSpans(times, limits) {
  const found = new Map();
  times.forEach((time, index) => {
    const until = times[index + 1] ?? time + periodOf(times);
    for (const clause of clausesOf(limits[index])) {
      const key = clause.replace(PERCENT, "%");
      if (!found.has(key)) found.set(key, { clauses: [], spans: [], last: null });
      extend(found.get(key), clause, index, time, until);
    }
  });
  return [...found.values()].map(summary).sort((a, b) => b.seconds - a.seconds);
}

const clausesOf = (text) =>
  String(text ?? "")
    .split(";")
    .map((clause) => clause.trim())
    .filter(Boolean);

function extend(entry, clause, index, from, to) {
  entry.clauses.push(clause);
  if (entry.last === index - 1 && entry.spans.length) entry.spans[entry.spans.length - 1].to = to;
  else entry.spans.push({ from, to });
  entry.last = index;
}

function summary({ clauses, spans }) {
  const seconds = spans.reduce((sum, { from, to }) => sum + to - from, 0);
  return { words: withRange(clauses), cycles: clauses.length, seconds, spans };
}

// "all at 40 % …", "all at 93 % …" -> "all at 40 to 93 % …"
function withRange(clauses) {
  const values = clauses.map((clause) => (clause.match(PERCENT) ?? []).map(Number.parseFloat));
  let place = 0;
  return clauses[0].replace(PERCENT, (text) => {
    const here = values.map((each) => each[place]);
    place += 1;
    const [least, most] = here.reduce(
      ([a, b], value) => [Math.min(a, value), Math.max(b, value)],
      [Infinity, -Infinity],
    );
    return least === most ? text : `${least} to ${most} %`;
  });
}

// Spans without the overlaps and the gaps of at most `gap` (s) between them, the earliest first.
export function mergedSpans(spans, gap) {
  const merged = [];
  for (const { from, to } of [...spans].sort((a, b) => a.from - b.from)) {
    const last = merged[merged.length - 1];
    if (last && from - last.to <= gap) last.to = Math.max(last.to, to);
    else merged.push({ from, to });
  }
  return merged;
}

// The median time (s) from cycle to cycle.
export function periodOf(times) {
  const periods = times.slice(1).map((time, index) => time - times[index]);
  return periods.sort((a, b) => a - b)[Math.floor(periods.length / 2)] ?? 0;
}
