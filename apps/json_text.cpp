#include "apps/json_text.h"

#include <nlohmann/json.hpp>

namespace legible {

std::string JsonText(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace legible
