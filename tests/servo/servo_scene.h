// A robot to servo and what its camera sees of it, without noise.
#pragma once

#include "servo/servo_model.h"
#include "tests/testing/hexapod_view.h"

namespace legible {

struct ServoScene {
  ServoModel model;
  Rigid3 pose;  // base_from_platform
};

inline ServoScene RandomScene(std::mt19937_64& generator) {
  const HexapodView view = RandomView(generator);
  return {MakeServoModel(view.robot, view.camera, view.camera_from_base), view.base_from_platform};
}

inline Eigen::Vector3d PlatformJointInCamera(const ServoModel& model, const Rigid3& pose, int leg) {
  return model.camera_from_base * (pose * model.robot.legs.at(static_cast<size_t>(leg)).platform_joint_m);
}

inline SeenEdges EdgesAt(const ServoModel& model, const Rigid3& pose) {
  return EdgesOf(model.robot, model.camera_from_base, pose);
}

}  // namespace legible
