// Fills the page from its embedded data.
import { renderCorrelations } from "../shared/correlations.js";
import { embeddedData, renderHeader, renderSection } from "../shared/page.js";
import { renderChecks } from "./checks.js";
import { renderLeftOut } from "./left_out.js";
import { renderOptions } from "./options.js";
import { renderParameters } from "./parameters.js";
import { renderPictures } from "./pictures.js";
import { renderPriors } from "./priors.js";
import { renderResiduals } from "./residuals.js";
import { renderTiming } from "./timing.js";
import { renderVerdict } from "./verdict.js";
import { renderWeak } from "./weak.js";

const SECTIONS = {
  verdict: renderVerdict,
  parameters: renderParameters,
  residuals: renderResiduals,
  pictures: renderPictures,
  "left-out": renderLeftOut,
  correlations: renderCorrelations,
  weak: renderWeak,
  priors: renderPriors,
  checks: renderChecks,
  options: renderOptions,
  timing: renderTiming,
};

const data = embeddedData();
const program = data.program_version && `legible ${data.program_version}`;
renderHeader(data.title ?? "Calibration report", "calibration report", [data.session, program]);
for (const [id, render] of Object.entries(SECTIONS)) renderSection(id, render, data);
