// Where the time went.
import { append } from "../shared/dom.js";
import { timeTable } from "../shared/timing.js";

const STAGES = {
  read: "Read the session",
  detect: "Find the edges",
  solve: "Estimate",
  covariance: "Covariance",
};

export const renderTiming = (section, data) =>
  append(section, timeTable(data.calibration?.time_s ?? {}, STAGES));
