// The document of LegsJson as text for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

std::string LegsTable(const nlohmann::ordered_json& document);

}  // namespace legible
