// The data of the page of `legible legs`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/legs_run.h"

namespace legible {

// What RenderLegsPage takes; `document` is that of LegsJson.
nlohmann::json LegsReportData(const LegsRun& run, const nlohmann::ordered_json& document);

}  // namespace legible
