// JSON as text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

// Indented, with a line end; bytes that are not UTF-8 are replaced, numbers that are not finite become null.
std::string JsonText(const nlohmann::ordered_json& document);

}  // namespace legible
