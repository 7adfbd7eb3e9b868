// JSON from vectors, and as text.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

nlohmann::ordered_json List(const Eigen::Ref<const Eigen::VectorXd>& values);

// To the four digits that are enough for a picture, which keep a page small.
double Rounded(double value);

// Indented, with a line end; bytes that are not UTF-8 are replaced, numbers that are not finite become null.
std::string JsonText(const nlohmann::ordered_json& document);

}  // namespace legible
