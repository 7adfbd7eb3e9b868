#include "datasets/symmetric_yaml.h"

#include <fmt/format.h>

namespace legible {
namespace {

void DemandSymmetric(const Eigen::MatrixXd& matrix, const std::vector<YamlValue>& rows) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (matrix(i, i) < 0) rows[i].Fail(fmt::format("has the variance {}", matrix(i, i)), "give 0 or more");
    for (Eigen::Index j = 0; j < i; ++j) {
      if (matrix(i, j) == matrix(j, i)) continue;
      rows[i].Fail(fmt::format("has {} in column {}, and row {} has {} in column {}", matrix(i, j), j + 1,
                               j + 1, matrix(j, i), i + 1),
                   "give a symmetric matrix or its lower triangle");
    }
  }
}

}  // namespace

Eigen::MatrixXd SymmetricFromYaml(const YamlValue& section, size_t size) {
  const std::vector<YamlValue> rows = section.List(size);
  const bool is_whole = size > 1 && rows[0].List().size() == size;
  Eigen::MatrixXd matrix(size, size);
  for (size_t i = 0; i < size; ++i) {
    const std::vector<double> values = rows[i].Numbers(is_whole ? size : i + 1);
    for (size_t j = 0; j < values.size(); ++j) {
      matrix(i, j) = values[j];
      if (!is_whole) matrix(j, i) = values[j];
    }
  }
  DemandSymmetric(matrix, rows);
  return matrix;
}

std::string SymmetricToYaml(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::VectorXd row = matrix.row(i).head(i + 1);
    text += fmt::format("  - {}\n", ListText(row.data(), static_cast<size_t>(row.size())));
  }
  return text;
}

}  // namespace legible
