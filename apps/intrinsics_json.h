// intrinsics.json: what `legible intrinsics` found, for other programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/intrinsics_run.h"

namespace legible {

nlohmann::ordered_json IntrinsicsJson(const IntrinsicsRun& run, const std::vector<std::string>& warnings);

}  // namespace legible
