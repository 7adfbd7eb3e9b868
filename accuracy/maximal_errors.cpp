#include "accuracy/maximal_errors.h"

#include <stdexcept>

#include "accuracy/zonotope.h"

namespace legible {

Eigen::Matrix3Xd LinearPart(const Eigen::MatrixXd& twists, int linear) {
  Eigen::Matrix3Xd part = Eigen::Matrix3Xd::Zero(3, twists.cols());
  part.topRows(linear) = twists.topRows(linear);
  return part;
}

Eigen::Matrix3Xd AngularPart(const Eigen::MatrixXd& twists, int linear) {
  Eigen::Matrix3Xd part = Eigen::Matrix3Xd::Zero(3, twists.cols());
  part.bottomRows(twists.rows() - linear) = twists.bottomRows(twists.rows() - linear);
  return part;
}

MaximalErrors MaximalErrorsOf(const PlatformJacobian& jacobian, const Eigen::VectorXd& bounds) {
  if (jacobian.status == PoseStatus::kSingular)
    throw std::invalid_argument("MaximalErrorsOf: a singular pose has no finite errors");
  if (bounds.size() != jacobian.matrix.cols() || !(bounds.minCoeff() >= 0) || !bounds.allFinite())
    throw std::invalid_argument("MaximalErrorsOf: give one bound, 0 or more, for each joint");
  return MaximalErrorsOf(jacobian.matrix * bounds.asDiagonal(), jacobian.linear);
}

MaximalErrors MaximalErrorsOf(const Eigen::MatrixXd& generators, int linear) {
  MaximalErrors errors;
  errors.of_coordinate = generators.cwiseAbs().rowwise().sum();
  errors.largest_position_m = FarthestPoint(LinearPart(generators, linear));
  errors.largest_rotation_rad = FarthestPoint(AngularPart(generators, linear));
  return errors;
}

}  // namespace legible
