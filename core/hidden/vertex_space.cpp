#include "core/hidden/vertex_space.h"

#include <Eigen/Geometry>

namespace legible {

VertexSpace VertexSpaceOf(const RobotLeg& leg, const Eigen::Vector3d& direction) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const Eigen::Vector3d rod_end_m = leg.base_joint_m + leg.rod_m * direction;
  switch (segment.carrier) {
    case Carrier::kCircle: {
      // Axes of robots are unit and across each other to 1e-6 only.
      const Eigen::Vector3d second = leg.first_axis.cross(leg.zero_direction).normalized();
      return {true, rod_end_m, second.cross(leg.first_axis).normalized(), second, leg.arm_m};
    }
    case Carrier::kLine:
      return {false, rod_end_m, leg.first_axis, none, 0};
    case Carrier::kFixed:
      break;
  }
  return {false, leg.base_joint_m, direction, none, 0};
}

}  // namespace legible
