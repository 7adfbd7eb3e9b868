// From the inverse Jacobian that a robot offers to the Jacobian that its errors are computed with, and
// whether there is one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/robots/full_inverse_jacobian.h"

namespace legible {

enum class PoseStatus {
  kRegular,
  kNearSingular,  // errors are computed, but they are so large that the linear answer means little
  kSingular,      // with all joints locked the platform can still move: no errors are computed
};
const char* ToString(PoseStatus status);  // "regular", "near_singular", "singular"

// Smallest over largest singular value of the balanced inverse Jacobian below which a pose counts as near a
// singularity, and as singular. Balanced: angular columns divided by the length that makes them as large as
// the linear ones, every row of length 1, so that no unit and no size of robot plays a part.
inline constexpr double kNearSingularRatio = 1e-3;
inline constexpr double kSingularRatio = 1e-8;

struct PlatformJacobian {
  PoseStatus status = PoseStatus::kSingular;
  double balanced_ratio = 0;  // that ratio
  int linear = 0;             // rows of the twist that are linear (m); the rest are angular (rad)
  Eigen::MatrixXd matrix;     // twist of the platform by joint errors: a column a joint; empty where singular
  // Unit motions that the locked joints leave free, as twists: orthonormal in the balanced coordinates, then
  // scaled to a rotation of 1 rad where they turn, to 1 m where not. Only where singular.
  std::vector<Eigen::VectorXd> free_motions;
};

// Throws std::invalid_argument unless the matrix is square and finite, with 1 … rows actuated joints.
PlatformJacobian Invert(const FullInverseJacobian& inverse_jacobian);

}  // namespace legible
