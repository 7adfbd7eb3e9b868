// What a person reads on the console at the end of a calibration.
#pragma once

#include <string>

#include "apps/calibration_run.h"
#include "apps/found_parameters.h"

namespace legible {

// The result in some twenty lines: how well it fits, what was found against the drawing.
std::string SummaryText(const CalibrationRun& run, const FoundParameters& found);

// Where the files are.
std::string FilesText(const CalibrationRun& run);

// Why there is no model, and what is open, a line each; empty where there is one.
std::string FailureText(const CalibrationRun& run);

}  // namespace legible
