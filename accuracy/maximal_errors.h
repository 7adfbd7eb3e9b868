// Merlet's maximal positioning errors: what joint errors that are bounded one by one can add up to (Merlet
// 2006, sections 3 and 4).
#pragma once

#include <Eigen/Core>

#include "accuracy/platform_jacobian.h"

namespace legible {

struct MaximalErrors {
  // |twist coordinate| at most, in the order of the Jacobian's rows (m, rad): row sums of |J| times the
  // bounds.
  Eigen::VectorXd of_coordinate;
  // The largest displacement and the largest rotation vector in any direction, exact: the farthest corner of
  // the box of joint errors.
  Eigen::Vector3d largest_position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d largest_rotation_rad = Eigen::Vector3d::Zero();

  double position_m() const { return largest_position_m.norm(); }
  double rotation_rad() const { return largest_rotation_rad.norm(); }
};

// `bounds`: of each joint error (m, or rad for a revolute joint), not negative. Throws std::invalid_argument
// for bounds that do not fit, and for a singular pose.
MaximalErrors MaximalErrorsOf(const PlatformJacobian& jacobian, const Eigen::VectorXd& bounds);

// The same of any parameters: `generators` holds what each parameter's bound moves the platform by, a column
// each.
MaximalErrors MaximalErrorsOf(const Eigen::MatrixXd& generators, int linear);

// The linear or the angular part of twists, a column each, with zeros for what a planar robot does not have.
Eigen::Matrix3Xd LinearPart(const Eigen::MatrixXd& twists, int linear);
Eigen::Matrix3Xd AngularPart(const Eigen::MatrixXd& twists, int linear);

}  // namespace legible
