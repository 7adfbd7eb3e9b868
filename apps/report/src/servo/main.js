// Fills the page from its embedded data.
import { isNumber } from "../shared/format.js";
import { embeddedData, renderHeader, renderSections, withoutNulls } from "../shared/page.js";
import { renderConditioning } from "./conditioning.js";
import { renderErrors } from "./errors.js";
import { renderGain } from "./gain.js";
import { renderLegs } from "./legs.js";
import { Moment } from "./moment.js";
import { renderPath } from "./path.js";
import { canDrawPath } from "./path_view.js";
import { hasPictures, renderPictures } from "./pictures.js";
import { renderSettings } from "./settings.js";
import { hasTimes, renderTimes } from "./times.js";
import { renderVerdict } from "./verdict.js";

// What each section needs, and how it is filled.
const hasCycles = ({ cycles }) => cycles?.time_s?.some(isNumber);
const SECTIONS = {
  verdict: [() => true, renderVerdict],
  errors: [hasCycles, renderErrors],
  legs: [hasCycles, renderLegs],
  conditioning: [hasCycles, renderConditioning],
  gain: [hasCycles, renderGain],
  path: [(data) => hasCycles(data) && canDrawPath(data), renderPath],
  pictures: [hasPictures, renderPictures],
  times: [(data) => hasCycles(data) && hasTimes(data), renderTimes],
  settings: [() => true, renderSettings],
};

const data = withoutNulls(embeddedData());
const times = data.cycles?.time_s ?? [];
const run = { data, times, moment: new Moment(times) };
const program = data.program_version && `legible ${data.program_version}`;
renderHeader(data.title ?? "Servo report", "servo report", [data.log, data.model, data.rig, program]);
renderSections(SECTIONS, data, run);
