#include "core/robots/planar_2r.h"

#include <Eigen/LU>
#include <cmath>

namespace legible {

Eigen::Matrix2d Jacobian(const Planar2R& robot, const Eigen::Vector2d& joint_angles_rad) {
  const double first = joint_angles_rad[0], both = joint_angles_rad.sum();
  const Eigen::Vector2d first_link = robot.first_link_m * Eigen::Vector2d(std::cos(first), std::sin(first));
  const Eigen::Vector2d second_link = robot.second_link_m * Eigen::Vector2d(std::cos(both), std::sin(both));
  const Eigen::Vector2d arm = first_link + second_link;
  Eigen::Matrix2d jacobian;
  jacobian << -arm.y(), -second_link.y(), arm.x(), second_link.x();
  return jacobian;
}

std::optional<FullInverseJacobian> FullInverseJacobianOf(const Planar2R& robot,
                                                         const Eigen::Vector2d& joint_angles_rad) {
  constexpr double kLeastSine = 1e-12;  // of the second angle
  if (std::abs(std::sin(joint_angles_rad[1])) < kLeastSine) return std::nullopt;
  return FullInverseJacobian{Jacobian(robot, joint_angles_rad).inverse(), 2, 2};
}

}  // namespace legible
