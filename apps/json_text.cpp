#include "apps/json_text.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace legible {

nlohmann::ordered_json List(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

std::string JsonText(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace legible
