// The images of a calibration's report: found points, residuals, predicted outlines.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/calibration_run.h"

namespace legible {

// The member `images` of the page's data (report_page.h), in the order of the session.
nlohmann::json ReportImages(const CalibrationRun& run);

}  // namespace legible
