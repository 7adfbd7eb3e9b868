// What a user should know before a calibration is trusted.
#pragma once

#include <string>
#include <vector>

#include "apps/calibration_run.h"
#include "apps/found_parameters.h"

namespace legible {

// Each in a sentence without full stop, parameters named as calibration.json names them: what was left out,
// what the images contradict, what is known only poorly. Standard error, calibration.json and the report all
// show these.
std::vector<std::string> Warnings(const CalibrationRun& run, const FoundParameters& found);

// Why there is no model, in a sentence without full stop; empty where there is one. kParametersOpen where the
// observability's sentences say more.
std::string WhyThereIsNoModel(const CalibrationRun& run);
inline constexpr char kParametersOpen[] = "the session leaves parameters open";

}  // namespace legible
