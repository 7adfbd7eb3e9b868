// Symmetric matrices in YAML, for this folder's own .cpp files.
#pragma once

#include <Eigen/Core>
#include <string>

#include "datasets/yaml_value.h"

namespace legible {

// From rows of the lower triangle (1, 2, … values) or whole rows (`size` values each). Throws InputError for
// what is not symmetric or has a diagonal below 0.
Eigen::MatrixXd SymmetricFromYaml(const YamlValue& section, size_t size);

// The rows of the lower triangle, one a line.
std::string SymmetricToYaml(const Eigen::MatrixXd& matrix);

}  // namespace legible
