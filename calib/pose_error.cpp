#include "calib/pose_error.h"

#include <Eigen/LU>
#include <stdexcept>

#include "calib/calibrated_model.h"

namespace legible {
namespace {

// Rows of the geometry (ReadingsByGeometry) among the model's parameters: all of a leg but its radius.
Eigen::MatrixXd GeometryRows(const Eigen::MatrixXd& by_shared) {
  Eigen::MatrixXd geometry(kGeometryCount, by_shared.cols());
  for (int leg = 0; leg < kLegCount; ++leg) {
    const int row = kCameraParameterCount + leg * kModelLegParameters;
    geometry.middleRows<6>(kGeometryPerLeg * leg) = by_shared.middleRows<6>(row);
    geometry.row(kGeometryPerLeg * leg + 6) = by_shared.row(row + 7);
  }
  return geometry;
}

}  // namespace

PoseErrorForms PoseErrorOf(const GoughStewart& robot, const std::vector<Rigid3>& base_from_platform,
                           const Eigen::MatrixXd& by_shared) {
  if (base_from_platform.empty()) throw std::invalid_argument("PoseErrorOf: no poses");
  using Form = Eigen::Matrix<double, kGeometryCount, kGeometryCount>;
  Form position = Form::Zero(), rotation = Form::Zero();
  for (const Rigid3& pose : base_from_platform) {
    const Eigen::FullPivLU<Matrix6d> jacobian(InverseJacobian(robot, pose));
    if (!jacobian.isInvertible()) throw std::invalid_argument("PoseErrorOf: a pose is singular");
    const Eigen::Matrix<double, 6, kGeometryCount> moved = -jacobian.solve(ReadingsByGeometry(robot, pose));
    position += moved.topRows<3>().transpose() * moved.topRows<3>();
    rotation += moved.bottomRows<3>().transpose() * moved.bottomRows<3>();
  }
  const Eigen::MatrixXd geometry = GeometryRows(by_shared);
  const auto count = static_cast<double>(base_from_platform.size());
  return {geometry.transpose() * position * geometry / count,
          geometry.transpose() * rotation * geometry / count};
}

}  // namespace legible
