// Merlet's robot as the project ships it, and the poses of his tables.
#pragma once

#include <array>
#include <numbers>

#include "core/robots/gough_stewart.h"
#include "datasets/robot_file.h"

namespace legible {

inline GoughStewart MerletRobot() {
  return ReadRobot(LEGIBLE_SOURCE_DIR "/datasets/merlet-gough/robot.yaml");
}

inline std::array<Rigid3, 3> MerletPoses() {
  return {Rigid3{Eigen::Quaterniond::Identity(), {0, 0, 0.53}},
          Rigid3{RotationFromVector({0, 0, std::numbers::pi / 6}), {0, 0, 0.53}},
          Rigid3{Eigen::Quaterniond::Identity(), {0.1, 0.1, 0.53}}};
}

}  // namespace legible
