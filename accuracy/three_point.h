// The condition numbers of the inverse Jacobian that takes the velocities of three points of the platform
// instead of a twist (Merlet 2006, section 4, C_2^3 and C_F^3): free of units.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/robots/gough_stewart.h"

namespace legible {

struct ThreePointRange {
  double least = 0, largest = 0;
};

// Over all triplets of platform joints that do not lie on one line.
struct ThreePointConditions {
  ThreePointRange two, frobenius, frobenius_of_gram;  // as in ConditionNumbers
  int triplets = 0;                                   // 20, less those on a line
};

// Leg speeds (m/s) from the velocities of three platform joints (9, in base): row i is w_i (x) u_i where B_i
// lies in the triplet's plane, w_i its affine weights. Off it by h, the unit normal's own velocity counts as
// well, times h: a calibrated platform is not quite flat. Throws std::invalid_argument where the three lie on
// one line.
Eigen::Matrix<double, kLegCount, 9> ThreePointJacobian(const GoughStewart& robot,
                                                       const Rigid3& base_from_platform,
                                                       const std::array<int, 3>& triplet);

ThreePointConditions ThreePointConditionsOf(const GoughStewart& robot, const Rigid3& base_from_platform);

}  // namespace legible
