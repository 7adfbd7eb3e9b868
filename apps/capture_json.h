// What came of holding a session.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/capture_run.h"

namespace legible {

nlohmann::ordered_json CaptureJson(const PreparedCapture& prepared, const CaptureRun& run);

}  // namespace legible
