// What a robot says of itself at a pose so that its accuracy can be judged: the full inverse kinematic
// Jacobian (Merlet 2006, eq. 6).
#pragma once

#include <Eigen/Core>

namespace legible {

// Speeds of the actuated joints, then zeros for what the passive joints forbid, from the twist of the
// platform:
//   (joint speeds, 0) = matrix * twist.
// The twist has its `linear` linear velocities (m/s, of the platform's origin) first, then its angular ones
// (rad/s), all in base. Six coordinates show every motion of a rigid platform; a planar robot judged by where
// its tip is has two.
struct FullInverseJacobian {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

  Matrix matrix;     // square
  int actuated = 0;  // rows of actuated joints; those of constraints follow
  int linear = 0;    // columns of linear velocities; those of angular ones follow
};

}  // namespace legible
