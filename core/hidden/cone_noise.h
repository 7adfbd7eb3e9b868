// The largest error of the platform's pose when every seen direction is off by at most an angle (Briot et al.
// 2016, section 5.1.2 and eq. A.2).
#pragma once

#include <optional>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

struct LargestPoseError {
  double position_m = 0;
  double rotation_rad = 0;
};

// In first order: the twist is M^+ du, each du_i in the disc of that radius across u_i, all at once; the
// largest position and the largest rotation, each by itself. The largest length of a sum of ellipses is found
// by branch and bound over its direction, to one part in 1000. Nothing where a leg does not reach the pose or
// the hidden robot is singular there.
std::optional<LargestPoseError> LargestErrorByConeNoise(const ParallelRobot& robot,
                                                        const std::vector<int>& legs,
                                                        const Rigid3& base_from_platform,
                                                        double half_angle_rad);

}  // namespace legible
