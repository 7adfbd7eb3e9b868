// A hexapod before a camera, for the tests of its images.
#pragma once

#include "core/vision/predicted_legs.h"
#include "datasets/synthetic_session.h"

namespace legible {

struct Scene {
  GoughStewart robot = DesktopHexapod();
  Camera camera;
  Rigid3 camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
  Rigid3 base_from_platform;

  explicit Scene(bool is_distorted) : camera(DesktopCamera(is_distorted)), base_from_platform(robot.home) {
    base_from_platform.translation += Eigen::Vector3d(0.01, -0.02, 0.01);
  }

  LegsInCamera Legs() const { return PlaceLegs(robot, camera_from_base, base_from_platform); }
  // As the camera would see them after its frame was displaced by (v, omega).
  LegsInCamera LegsDisplaced(const Vector6d& displacement) const {
    return PlaceLegs(robot, Displaced(camera_from_base, displacement), base_from_platform);
  }
};

}  // namespace legible
