// The page of `legible intrinsics`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/intrinsics_run.h"

namespace legible {

// The data that RenderIntrinsicsPage takes (apps/report_page.h); `document` is what intrinsics.json holds.
nlohmann::json IntrinsicsReportData(const IntrinsicsRun& run, const nlohmann::ordered_json& document);

}  // namespace legible
