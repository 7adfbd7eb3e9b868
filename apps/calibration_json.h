// calibration.json: what a calibration found, for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/calibration_run.h"
#include "apps/found_parameters.h"

namespace legible {

// The document. Numbers that are not known are NaN, which become null in its text (JsonText of
// apps/json_text.h).
nlohmann::ordered_json CalibrationJson(const CalibrationRun& run, const FoundParameters& found,
                                       const std::vector<std::string>& warnings);

// {camera, legs} of the drawing and the first guess of the camera, in the form of the document above.
nlohmann::ordered_json NominalJson(const CalibrationRun& run);

}  // namespace legible
