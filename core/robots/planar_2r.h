// The planar 2R arm, of which Merlet (2006, section 6) shows how a workspace average is got wrong.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/robots/full_inverse_jacobian.h"

namespace legible {

struct Planar2R {
  double first_link_m = 1, second_link_m = 1;
};

// d(tip x, y) / d(joint angles), m, the second angle measured from the first link.
Eigen::Matrix2d Jacobian(const Planar2R& robot, const Eigen::Vector2d& joint_angles_rad);

// Joint speeds (rad/s) from the velocity of the tip; nothing where the arm is stretched or folded, for there
// no joint speeds move the tip along the arm.
std::optional<FullInverseJacobian> FullInverseJacobianOf(const Planar2R& robot,
                                                         const Eigen::Vector2d& joint_angles_rad);

}  // namespace legible
