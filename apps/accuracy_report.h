// The data of an accuracy report's page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/accuracy_run.h"

namespace legible {

// What RenderAccuracyPage takes; `document` is that of AccuracyJson.
nlohmann::json AccuracyReportData(const AccuracyRun& run, const nlohmann::ordered_json& document);

}  // namespace legible
