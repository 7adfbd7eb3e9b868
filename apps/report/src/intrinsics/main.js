// Fills the page from its embedded data.
import { embeddedData, renderHeader, renderSections, withoutNulls } from "../shared/page.js";
import { hasCoverage, renderCoverage } from "./coverage.js";
import { hasHalves, renderHalves } from "./halves.js";
import { renderLeftOut } from "./left_out.js";
import { renderOptions } from "./options.js";
import { hasParameters, renderParameters } from "./parameters.js";
import { hasPictures, renderPictures } from "./pictures.js";
import { hasResiduals, renderResiduals } from "./residuals.js";
import { hasUncertainty, renderUncertainty } from "./uncertainty.js";
import { renderVerdict } from "./verdict.js";

// What each section needs, and how it is filled.
const SECTIONS = {
  verdict: [() => true, renderVerdict],
  parameters: [hasParameters, renderParameters],
  uncertainty: [hasUncertainty, renderUncertainty],
  halves: [hasHalves, renderHalves],
  residuals: [hasResiduals, renderResiduals],
  pictures: [hasPictures, renderPictures],
  coverage: [hasCoverage, renderCoverage],
  "left-out": [({ views, intrinsics }) => views?.length || intrinsics?.views_left_out?.length, renderLeftOut],
  options: [() => true, renderOptions],
};

const data = withoutNulls(embeddedData());
const program = data.program_version && `legible ${data.program_version}`;
renderHeader(data.title ?? "Intrinsics report", "intrinsics report", [data.board, program]);
renderSections(SECTIONS, data);
