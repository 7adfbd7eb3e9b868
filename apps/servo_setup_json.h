// setup.json: what a servo starts from.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/servo_log.h"

namespace legible {

inline constexpr int kServoLogSchema = 2;

nlohmann::ordered_json SetupToJson(const ServoSetup& setup);

// Throws nlohmann::json::exception, or std::invalid_argument, for what SetupToJson has not written.
ServoSetup SetupFromJson(const nlohmann::ordered_json& document);

}  // namespace legible
