// What a control law is asked in tests, and how.
#pragma once

#include "servo/control_law.h"
#include "tests/servo/servo_scene.h"

namespace legible {

// A scene with a goal that the robot is not at.
struct LawTask {
  ServoScene scene;
  ServoGoal goal;

  LawInput Input(const SeenEdges& seen) const {
    return {seen, InverseKinematics(scene.model.robot, scene.pose), Vector6d::Zero(), scene.pose};
  }
  LawInput Input() const { return Input(EdgesAt(scene.model, scene.pose)); }
};

inline LawTask RandomTask(std::mt19937_64& generator, double most_m) {
  const ServoScene scene = RandomScene(generator);
  return {scene, GoalAtPose(scene.model, Nearby(scene.pose, most_m, generator))};
}

inline ControlLawOptions Law(ControlMode mode, bool is_weighted = false,
                             DirectionSource source = DirectionSource::kEdges) {
  ControlLawOptions options;
  options.mode = mode;
  options.is_weighted = is_weighted;
  options.direction_source = source;
  options.most_motion_sigma = 1e9;  // edges may be said to have any noise
  return options;
}

}  // namespace legible
