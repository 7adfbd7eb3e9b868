// Two 3-UPU robots.
#pragma once

#include <cmath>
#include <numbers>

#include "core/robots/three_upu.h"

namespace legible {

// Joints on circles of 0.2 m (base) and 0.1 m (platform) at 120 degrees, the platform 0.4 m up; outer axes at
// `angle_rad` from the radius, in the plane.
inline ThreeUpu SymmetricUpu(double angle_rad) {
  ThreeUpu robot;
  robot.home.translation = {0, 0, 0.4};
  for (size_t i = 0; i < kUpuLegCount; ++i) {
    const double at = 2 * std::numbers::pi * static_cast<double>(i) / 3;
    const Eigen::Vector3d radius(std::cos(at), std::sin(at), 0);
    robot.legs[i].base_joint_m = 0.2 * radius;
    robot.legs[i].platform_joint_m = 0.1 * radius;
    robot.legs[i].outer_axis = {std::cos(at + angle_rad), std::sin(at + angle_rad), 0};
    robot.legs[i].radius_m = 0.01;
    robot.legs[i].joint_range_m = {0.3, 0.6};
  }
  return robot;
}

// Outer axes through the centre: at home all inner axes are horizontal, all three moments vertical.
inline ThreeUpu SeoulUpu() { return SymmetricUpu(0); }

// Outer axes along the tangents: the moments lie along the legs.
inline ThreeUpu TsaiUpu() { return SymmetricUpu(std::numbers::pi / 2); }

}  // namespace legible
