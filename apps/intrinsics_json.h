// intrinsics.json: what `legible intrinsics` found, for other programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/intrinsics_run.h"

namespace legible {

// Where there is a camera, and all that has been worked out of it.
nlohmann::ordered_json IntrinsicsJson(const IntrinsicsRun& run, const std::vector<std::string>& warnings);

// Where there is none: status, message, and what became of the views.
nlohmann::ordered_json FailureJson(const IntrinsicsRun& run);

}  // namespace legible
