#include "apps/leg_visibility.h"

#include <Eigen/Geometry>

#include "core/robots/leg_state.h"

namespace legible {
namespace {

constexpr int kPointsOfLeg = 9;

bool IsInImage(const Camera& camera, double monotonic_radius, const Eigen::Vector3d& x_in_camera) {
  if (!(x_in_camera.z() > 0)) return false;
  const Eigen::Vector2d normalised = x_in_camera.hnormalized();
  if (normalised.norm() > monotonic_radius) return false;
  const Eigen::Vector2d pixel = ProjectNormalised(camera, normalised);
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width_px - 1 &&
         pixel.y() <= camera.height_px - 1;
}

}  // namespace

std::function<bool(int leg, const Rigid3& base_from_platform)> VisibilityOfLegs(
    const ParallelRobot& robot, const Camera& camera, const Rigid3& camera_from_base) {
  const double radius = MonotonicRadius(camera.lens, camera.distortion);
  return [legs = robot.legs, camera, camera_from_base, radius](int leg, const Rigid3& pose) {
    const auto state = StateOf(legs[static_cast<size_t>(leg)], pose);
    if (!state) return false;
    for (int i = 0; i < kPointsOfLeg; ++i) {
      const double part = static_cast<double>(i) / (kPointsOfLeg - 1);
      const Eigen::Vector3d point_m = (1 - part) * state->start_m + part * state->platform_joint_m;
      if (IsInImage(camera, radius, camera_from_base * point_m)) return true;
    }
    return false;
  };
}

}  // namespace legible
