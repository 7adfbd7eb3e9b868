#include "core/robots/three_upu.h"

#include <Eigen/Geometry>

namespace legible {
namespace {

// Sine of the angle between leg and outer axis below which the inner axis is open.
constexpr double kLeastSine = 1e-12;

Eigen::Vector3d AlongLeg(const UpuLeg& leg, const Eigen::Vector3d& translation_m) {
  return translation_m + leg.platform_joint_m - leg.base_joint_m;
}

// s = u x v with v = u x n / |u x n|.
Eigen::Vector3d ConstraintMoment(const Eigen::Vector3d& u, const Eigen::Vector3d& n) {
  const Eigen::Vector3d inner = u.cross(n);
  if (inner.norm() < kLeastSine) return Eigen::Vector3d::Zero();
  return u.cross(inner.normalized());
}

}  // namespace

Eigen::Vector3d InverseKinematics(const ThreeUpu& robot, const Eigen::Vector3d& translation_m) {
  Eigen::Vector3d readings_m;
  for (size_t i = 0; i < kUpuLegCount; ++i)
    readings_m[static_cast<Eigen::Index>(i)] =
        AlongLeg(robot.legs[i], translation_m).norm() - robot.legs[i].joint_offset_m;
  return readings_m;
}

FullInverseJacobian FullInverseJacobianOf(const ThreeUpu& robot, const Eigen::Vector3d& translation_m) {
  FullInverseJacobian jacobian{Eigen::Matrix<double, 6, 6>::Zero(), kUpuLegCount, 3};
  for (int i = 0; i < kUpuLegCount; ++i) {
    const UpuLeg& leg = robot.legs[static_cast<size_t>(i)];
    const Eigen::Vector3d n = AlongLeg(leg, translation_m).normalized();
    jacobian.matrix.row(i) << n.transpose(), leg.platform_joint_m.cross(n).transpose();
    jacobian.matrix.row(kUpuLegCount + i).tail<3>() = ConstraintMoment(leg.outer_axis, n).transpose();
  }
  return jacobian;
}

}  // namespace legible
