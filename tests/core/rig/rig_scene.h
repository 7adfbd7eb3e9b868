// Robots before cameras, for the tests of the simulated camera's images.
#pragma once

#include <random>

#include "core/rig/scene_camera.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/random.h"

namespace legible {

// With half as many pixels each way.
inline Camera Halved(Camera camera) {
  camera.width_px /= 2;
  camera.height_px /= 2;
  camera.fx_px /= 2;
  camera.fy_px /= 2;
  camera.cx_px = (camera.cx_px + 0.5) / 2 - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) / 2 - 0.5;
  return camera;
}

inline Camera HalfCamera(bool is_distorted) { return Halved(DesktopCamera(is_distorted)); }

inline SimulationTruth DesktopTruth(const Camera& camera) {
  return {DesktopHexapod(), camera, LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})};
}

// The camera turned about its optical axis.
inline Rigid3 Rolled(const Rigid3& camera_from_base, double angle_rad) {
  return Rigid3{RotationFromVector({0, 0, angle_rad}), Eigen::Vector3d::Zero()} * camera_from_base;
}

inline Rigid3 RandomPose(std::mt19937_64& generator) {
  Vector6d displacement;
  displacement << UniformVector(generator, -0.03, 0.03), UniformVector(generator, -0.1, 0.1);
  return Displaced(DesktopHexapod().home, displacement);
}

// Legs of one brightness before a background of another.
inline SceneOptions EvenScene() {
  SceneOptions options;
  options.ambient = 1;
  options.leg_grey = 180;
  options.ground_grey = options.plate_grey = options.joint_grey = 40;
  options.texture_grey = 0;
  options.noise_grey = 0;
  return options;
}

inline LegsInCamera LegsOf(const SimulationTruth& truth, const Rigid3& base_from_platform) {
  return PlaceLegs(truth.robot, truth.camera_from_base, base_from_platform);
}

}  // namespace legible
