// The data of the servo's page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/servo_run.h"

namespace legible {

// As RenderServoPage takes them; `document` is ServoJson's.
nlohmann::json ServoReportData(const PreparedServo& prepared, const FinishedServo& finished,
                               const nlohmann::ordered_json& document);

}  // namespace legible
