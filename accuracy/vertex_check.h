// How far the linear errors are from the truth: forward kinematics at the corners of the box of joint errors.
#pragma once

#include <Eigen/Core>

#include "core/robots/gough_stewart.h"

namespace legible {

struct VertexCheck {
  bool converged = false;            // forward kinematics did at all 64 corners
  double position_difference_m = 0;  // largest, over the corners, of |true displacement - J corner|
  double rotation_difference_rad = 0;
  // The larger of both differences over the largest linear position and rotation error.
  double relative = 0;
};

// From the pose, joint errors of +-bounds_m (m) on top of its readings. Needs a pose that is not singular.
VertexCheck CheckAtVertices(const GoughStewart& robot, const Rigid3& base_from_platform,
                            const Vector6d& bounds_m);

}  // namespace legible
