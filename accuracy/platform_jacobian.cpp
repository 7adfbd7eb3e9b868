#include "accuracy/platform_jacobian.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <stdexcept>

namespace legible {
namespace {

using Matrix = FullInverseJacobian::Matrix;

void Check(const FullInverseJacobian& given) {
  const Eigen::Index size = given.matrix.rows();
  if (size == 0 || given.matrix.cols() != size || given.actuated < 1 || given.actuated > size ||
      given.linear < 0 || given.linear > size || !given.matrix.allFinite())
    throw std::invalid_argument(
        "Invert: the inverse Jacobian is not a finite square matrix with joints of its own");
}

// rows * matrix * columns, the scales that make it comparable within itself.
struct Balanced {
  Eigen::VectorXd rows, columns;
  Matrix matrix;
};

// That makes angular columns of the joints' rows as large as linear ones.
double BalancingLength(const FullInverseJacobian& given) {
  const auto joints = given.matrix.topRows(given.actuated);
  const double linear = joints.leftCols(given.linear).norm();
  const double angular = joints.rightCols(joints.cols() - given.linear).norm();
  return linear > 0 && angular > 0 ? angular / linear : 1;
}

Balanced Balance(const FullInverseJacobian& given) {
  const Eigen::Index size = given.matrix.rows();
  Balanced balanced{Eigen::VectorXd::Ones(size), Eigen::VectorXd::Ones(size), {}};
  balanced.columns.tail(size - given.linear).setConstant(1 / BalancingLength(given));
  balanced.matrix = given.matrix * balanced.columns.asDiagonal();
  for (Eigen::Index i = 0; i < size; ++i) {
    const double length = balanced.matrix.row(i).norm();
    if (length > 0) balanced.rows[i] = 1 / length;
  }
  balanced.matrix = balanced.rows.asDiagonal() * balanced.matrix;
  return balanced;
}

// In units of the twist, 1 rad or 1 m large.
Eigen::VectorXd UnitMotion(const Eigen::VectorXd& balanced_motion, const Balanced& balanced, int linear) {
  constexpr double kTurns = 1e-6;  // of the balanced motion
  const Eigen::VectorXd motion = balanced.columns.cwiseProduct(balanced_motion);
  const Eigen::Index angular = motion.size() - linear;
  const bool turns = angular > 0 && balanced_motion.tail(angular).norm() > kTurns;
  return motion / (turns ? motion.tail(angular).norm() : motion.head(linear).norm());
}

PoseStatus StatusOf(double ratio) {
  if (ratio < kSingularRatio) return PoseStatus::kSingular;
  return ratio < kNearSingularRatio ? PoseStatus::kNearSingular : PoseStatus::kRegular;
}

}  // namespace

const char* ToString(PoseStatus status) {
  switch (status) {
    case PoseStatus::kRegular:
      return "regular";
    case PoseStatus::kNearSingular:
      return "near_singular";
    case PoseStatus::kSingular:
      return "singular";
  }
  throw std::invalid_argument("ToString: not a PoseStatus");
}

PlatformJacobian Invert(const FullInverseJacobian& inverse_jacobian) {
  Check(inverse_jacobian);
  const Balanced balanced = Balance(inverse_jacobian);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(balanced.matrix, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();  // descending
  PlatformJacobian result;
  result.linear = inverse_jacobian.linear;
  result.balanced_ratio = values[0] > 0 ? values[values.size() - 1] / values[0] : 0;
  result.status = StatusOf(result.balanced_ratio);
  if (result.status != PoseStatus::kSingular) {
    const Eigen::MatrixXd inverse = balanced.matrix.inverse();
    result.matrix = (balanced.columns.asDiagonal() * inverse * balanced.rows.asDiagonal())
                        .leftCols(inverse_jacobian.actuated);
    return result;
  }
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (values[i] <= kSingularRatio * values[0])
      result.free_motions.push_back(UnitMotion(svd.matrixV().col(i), balanced, inverse_jacobian.linear));
  return result;
}

}  // namespace legible
