// What the user of `legible servo` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "servo/servo_controller.h"

namespace legible {

// One of them is given.
struct GoalSetting {
  std::optional<Vector6d> pose;      // x y z (m) and a rotation vector (rad): base_from_platform
  std::optional<Vector6d> joints_m;  // joint readings; with an image: those that it was taken at
  std::optional<std::filesystem::path> image;
};

struct ServoSettings {
  std::filesystem::path model;
  std::optional<std::filesystem::path> camera;  // of a model that has none
  std::string rig;                              // "sim:TRUTH"
  GoalSetting goal;
  ServoOptions options;
  bool chooses_legs = false;  // those of options are replaced by the best for the way
  double period_s = 0.02;
  bool is_image_free = false;  // edges of a simulated rig without images
  std::filesystem::path log = "servo";
  bool keeps_images = false;
  bool prints_json = false;
};

// "2" or "6:2:300": the gain near the goal (1/s), that from afar, and how fast it falls from the first to the
// second (1/s by m that a joint still has to go). Throws std::invalid_argument with a message for the user.
AdaptiveGain ParseGain(const std::string& text);

}  // namespace legible
