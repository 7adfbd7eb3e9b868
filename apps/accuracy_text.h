// The document of AccuracyJson as text for people and for spreadsheets: the same numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

// Tables of errors, sources and indices by pose, then what there is over all poses and over the workspace.
std::string AccuracyTable(const nlohmann::ordered_json& document);

// A header with units in its names, and a row a pose.
std::string AccuracyCsv(const nlohmann::ordered_json& document);

}  // namespace legible
