// Maps of `legible legs` as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/hidden/map_slice.h"

namespace legible {

nlohmann::ordered_json SliceMapJson(const SliceMap& map);

}  // namespace legible
