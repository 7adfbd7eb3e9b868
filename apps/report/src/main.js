// Fills the page from its embedded data.
import { renderChecks } from "./checks.js";
import { renderCorrelations } from "./correlations.js";
import { append, html } from "./dom.js";
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

function renderHeader(data) {
  const title = data.title ?? "Calibration report";
  document.title = `${title}: calibration report`;
  document.getElementById("title").textContent = title;
  const program = data.program_version && `legible ${data.program_version}`;
  document.getElementById("origin").textContent = [data.session, program].filter(Boolean).join(" · ");
}

// One section that fails must not take the others with it.
function renderSection(id, render, data) {
  const section = document.getElementById(id);
  try {
    render(section, data);
  } catch (error) {
    console.error(error);
    append(section, html("p", { class: "notice" }, `This section could not be drawn: ${error.message}`));
  }
}

const data = JSON.parse(document.getElementById("data").textContent);
renderHeader(data);
for (const [id, render] of Object.entries(SECTIONS)) renderSection(id, render, data);
