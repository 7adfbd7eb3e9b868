// Least squares in six unknowns by singular values: plain, truncated or damped.
#pragma once

#include <Eigen/Core>

#include "core/geometry/rigid3.h"

namespace legible {

// Rows of a task: at most two for each of twelve edges.
inline constexpr int kMostTaskRows = 24;
using TaskMatrix = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMostTaskRows, 6>;
using TaskVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostTaskRows, 1>;

// Of a square matrix: singular values, descending, and the right singular vectors in the same order. Values
// are exact to the rounding of the largest, but for those that lie below 1e-8 of it together with others.
struct RightSingular {
  Vector6d values;
  Matrix6d vectors;
};
RightSingular RightSingularOf(const Matrix6d& matrix);

struct PseudoInverseOptions {
  // Both are shares of the largest singular value. Directions with less than `truncation` are left alone;
  // each other answers s / (s^2 + damping^2) instead of 1 / s.
  double truncation = 1e-9;
  double damping = 0;

  void Check() const;  // throws std::invalid_argument
};

struct LeastSquares {
  Vector6d solution = Vector6d::Zero();         // of matrix * solution = right
  Vector6d singular_values = Vector6d::Zero();  // descending
  Matrix6d triangle = Matrix6d::Zero();         // R of the matrix: R^T R = matrix^T matrix
  int rank = 0;                                 // singular values that were not left out
};

// matrix needs six rows or more. Where anything is not a number, so are the singular values, and the rank is
// 0. Allocates nothing.
LeastSquares SolveLeastSquares(const TaskMatrix& matrix, const TaskVector& right,
                               const PseudoInverseOptions& options);

}  // namespace legible
