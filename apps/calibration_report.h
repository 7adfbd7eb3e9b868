// The data of a calibration's report page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/calibration_run.h"
#include "apps/found_parameters.h"

namespace legible {

// What RenderCalibrationPage takes; `calibration` is the document of CalibrationJson, `images` of
// ReportImages.
nlohmann::json ReportData(const CalibrationRun& run, const FoundParameters& found,
                          const nlohmann::ordered_json& calibration, const nlohmann::json& images);

}  // namespace legible
