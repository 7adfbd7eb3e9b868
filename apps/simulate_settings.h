// What the user of `legible simulate` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/synthetic_session.h"

namespace legible {

struct SimulateSettings {
  std::optional<std::filesystem::path> truth;  // none: one is drawn about a drawing
  std::optional<std::filesystem::path> robot, camera;
  // Half widths of the uniform errors that a truth is drawn with.
  double geometry_error_m = SyntheticOptions().geometry_error_m;
  double offset_error_m = SyntheticOptions().joint_offset_error_m;
  double radius_error_m = SyntheticOptions().radius_error_m;
  double camera_error_px = SyntheticOptions().camera_error_px;
  double camera_position_error_m = SyntheticOptions().camera_position_error_m;
  double camera_rotation_error_rad = SyntheticOptions().camera_rotation_error_rad;
  double reading_noise_m = SyntheticOptions().joint_reading_sigma_m;
  std::optional<int> width_px, height_px;
  std::vector<std::pair<std::string, std::optional<double>>> known;  // names of KnownNames(); none: forgotten
  int images = 40;
  int seed = 1;
  std::filesystem::path out;
};

}  // namespace legible
