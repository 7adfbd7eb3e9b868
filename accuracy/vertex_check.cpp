#include "accuracy/vertex_check.h"

#include <Eigen/LU>
#include <algorithm>

namespace legible {

VertexCheck CheckAtVertices(const GoughStewart& robot, const Rigid3& base_from_platform,
                            const Vector6d& bounds_m) {
  const Vector6d readings_m = InverseKinematics(robot, base_from_platform);
  const Matrix6d jacobian = InverseJacobian(robot, base_from_platform).inverse();
  VertexCheck check{true};
  double largest_position_m = 0, largest_rotation_rad = 0;
  for (unsigned corner = 0; corner < 1U << kLegCount; ++corner) {
    Vector6d error_m = bounds_m;
    for (int i = 0; i < kLegCount; ++i)
      if ((corner >> i & 1U) == 0) error_m[i] = -error_m[i];
    const auto found = ForwardKinematics(robot, readings_m + error_m, base_from_platform);
    if (found.status != ForwardKinematicsStatus::kConverged) return {};
    const Vector6d linear = jacobian * error_m;
    const Vector6d difference = Displacement(base_from_platform, found.base_from_platform) - linear;
    check.position_difference_m = std::max(check.position_difference_m, difference.head<3>().norm());
    check.rotation_difference_rad = std::max(check.rotation_difference_rad, difference.tail<3>().norm());
    largest_position_m = std::max(largest_position_m, linear.head<3>().norm());
    largest_rotation_rad = std::max(largest_rotation_rad, linear.tail<3>().norm());
  }
  check.relative = std::max(check.position_difference_m / largest_position_m,
                            check.rotation_difference_rad / largest_rotation_rad);
  return check;
}

}  // namespace legible
