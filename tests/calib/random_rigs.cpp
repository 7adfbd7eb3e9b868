#include "tests/calib/random_rigs.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "datasets/synthetic_session.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

Rigid3 DrawCamera(std::mt19937_64& generator) {
  const double azimuth = Uniform(generator, 0, 2 * std::numbers::pi);
  const double distance_m = Uniform(generator, 0.85, 1.15);
  const Eigen::Vector3d place(distance_m * std::cos(azimuth), distance_m * std::sin(azimuth),
                              Uniform(generator, 0.15, 0.5));
  return LookAt(place, Eigen::Vector3d(0, 0, 0.14) + UniformVector(generator, -0.02, 0.02));
}

}  // namespace

RandomRig DrawRig(std::mt19937_64& generator) {
  RandomRig rig;
  rig.drawing = DesktopHexapod(generator, 0.01);
  for (Leg& leg : rig.drawing.legs) {
    leg.radius_m = 0.01;
    leg.joint_range_m = {0.345, 0.485};
  }
  rig.truth = {rig.drawing, DesktopCamera(true), DrawCamera(generator)};
  for (Leg& leg : rig.truth.robot.legs) {
    leg.base_joint_m += UniformVector(generator, -0.002, 0.002);
    leg.platform_joint_m += UniformVector(generator, -0.002, 0.002);
    leg.joint_offset_m += Uniform(generator, -0.0015, 0.0015);
    leg.radius_m += Uniform(generator, -0.0006, 0.0006);
  }
  rig.guess = {rig.drawing, DesktopCamera(false), rig.truth.camera_from_base};
  Vector6d displacement;
  displacement << UniformVector(generator, -0.03, 0.03), UniformVector(generator, -0.05, 0.05);
  rig.guess.camera_from_base = Displaced(rig.truth.camera_from_base, displacement);
  return rig;
}

ImageObservation SeenIn(const RandomRig& rig, const Rigid3& base_from_platform,
                        const ExpectedEdgeOptions& options) {
  const Vector6d readings_m = InverseKinematics(rig.guess.robot, base_from_platform);
  const auto found = ForwardKinematics(rig.truth.robot, readings_m, base_from_platform);
  if (found.status != ForwardKinematicsStatus::kConverged)
    throw std::runtime_error("the true robot cannot go where the drawing can");
  return ExpectObservation(rig.truth, found.base_from_platform, options);
}

}  // namespace legible
