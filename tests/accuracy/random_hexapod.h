// Hexapods in random poses about home, for tests of what must hold for all.
#pragma once

#include <random>

#include "core/robots/gough_stewart.h"
#include "tests/testing/random.h"

namespace legible {

struct HexapodAtPose {
  GoughStewart robot;
  Rigid3 pose;
};

// Joints up to 5 mm and offsets up to 2 mm off a symmetric desktop robot, the pose up to 5 cm and 0.2 rad a
// coordinate off home.
inline HexapodAtPose RandomHexapod(std::mt19937_64& generator) {
  HexapodAtPose drawn{DesktopHexapod(generator, 0.005), {}};
  for (Leg& leg : drawn.robot.legs) leg.joint_offset_m = Uniform(generator, -0.002, 0.002);
  Vector6d displacement;
  displacement << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.2, 0.2);
  drawn.pose = Displaced(drawn.robot.home, displacement);
  return drawn;
}

// The same robot in the same place, described in a base frame that lies elsewhere at random.
inline HexapodAtPose InAnotherBase(const HexapodAtPose& hexapod, std::mt19937_64& generator) {
  const Rigid3 world_from_base{UniformRotation(generator), UniformVector(generator, -1, 1)};
  HexapodAtPose moved{hexapod.robot, world_from_base * hexapod.pose};
  for (Leg& leg : moved.robot.legs) leg.base_joint_m = world_from_base * leg.base_joint_m;
  return moved;
}

}  // namespace legible
