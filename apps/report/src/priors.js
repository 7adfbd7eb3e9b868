// What was said beforehand, and how far the images pulled away from it.
import { append, barCell, html, muted, table } from "./dom.js";
import {
  MISSING,
  decimalsFor,
  describeParameter,
  fixed,
  isNumber,
  parameterTitle,
  signed,
} from "./format.js";
import { PULL_LIMIT_SIGMA } from "./judgement.js";

const FULL_BAR_SIGMA = 4;
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
      "Each value given beforehand enters as an observation with its σ. Pull is found minus given in units " +
        `of that σ; more than ${PULL_LIMIT_SIGMA} either way contradicts what was given. Largest first.`,
    ),
    priorTable("Prior knowledge", priors.slice(0, ROWS_SHOWN)),
    rest(priors.slice(ROWS_SHOWN)),
  );
}

const rest = (priors) =>
  priors.length > 0 &&
  html(
    "details",
    null,
    html("summary", null, `${priors.length} more`),
    priorTable("Prior knowledge, smaller pulls", priors),
  );

function priorTable(caption, priors) {
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
        label: "−4 … +4 σ",
        cell: ({ pull_sigma: pull }) =>
          barCell(pull, FULL_BAR_SIGMA, { signed: true, alarming: Math.abs(pull) > PULL_LIMIT_SIGMA }),
      },
    ],
    [{ rows: priors }],
  );
}

function inUnit({ name, sigma }, value) {
  const { scale } = describeParameter(name);
  return isNumber(value) ? fixed(value * scale, decimalsFor(sigma * scale)) : MISSING;
}
