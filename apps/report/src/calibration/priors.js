// What was said beforehand, and how far the images pulled away from it.
import { append, barCell, html, muted, table } from "../shared/dom.js";
import { MISSING, decimalsFor, fixed, isNumber, signed } from "../shared/format.js";
import { describeParameter, parameterTitle } from "../shared/parameter_names.js";

const FULL_BAR_SIGMA = 6;
const ROWS_SHOWN = 30;

export function renderPriors(section, data) {
  const priors = [...(data.priors ?? [])].sort(
    (a, b) => Math.abs(b.pull_sigma ?? 0) - Math.abs(a.pull_sigma ?? 0),
  );
  if (priors.length === 0) {
    append(section, muted("Nothing was said beforehand about any parameter."));
    return;
  }
  append(
    section,
    muted(
      "Each value given beforehand enters as an observation with its σ. Pull is found minus given, divided by " +
        "the σ that this difference has (the root of the difference of their variances); more than " +
        `${data.contradicting_pull_sigma} either way contradicts what was given. Largest first.`,
    ),
    priorTable("Prior knowledge", priors.slice(0, ROWS_SHOWN), data.contradicting_pull_sigma),
    rest(priors.slice(ROWS_SHOWN), data.contradicting_pull_sigma),
  );
}

const rest = (priors, limit) =>
  priors.length > 0 &&
  html(
    "details",
    null,
    html("summary", null, `${priors.length} more`),
    priorTable("Prior knowledge, smaller pulls", priors, limit),
  );

function priorTable(caption, priors, limit) {
  return table(
    caption,
    [
      { label: "Parameter", text: true, cell: ({ name }) => parameterTitle(name) },
      { label: "Unit", text: true, cell: ({ name }) => describeParameter(name).unit },
      { label: "Given", cell: (prior) => inUnit(prior, prior.value) },
      { label: "± σ", cell: (prior) => inUnit(prior, prior.sigma) },
      { label: "Found", cell: (prior) => inUnit(prior, prior.found) },
      { label: "Pull", unit: "σ", cell: ({ pull_sigma: pull }) => signed(pull, 2) },
      {
        label: "−6 … +6 σ",
        cell: ({ pull_sigma: pull }) =>
          barCell(pull, FULL_BAR_SIGMA, { signed: true, alarming: Math.abs(pull) > limit }),
      },
    ],
    [{ rows: priors }],
  );
}

function inUnit({ name, sigma }, value) {
  const { scale } = describeParameter(name);
  return isNumber(value) ? fixed(value * scale, decimalsFor(sigma * scale)) : MISSING;
}
