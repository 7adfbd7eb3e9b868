// result.json: what came of a servo.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/servo_run.h"

namespace legible {

nlohmann::ordered_json ServoJson(const PreparedServo& prepared, const FinishedServo& finished);

}  // namespace legible
