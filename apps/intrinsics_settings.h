// What the user of `legible intrinsics` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/board_fit_settings.h"
#include "core/geometry/camera.h"

namespace legible {

struct IntrinsicsSettings {
  std::vector<std::filesystem::path> images;  // files, and folders of images
  std::filesystem::path board;
  std::optional<std::filesystem::path> corners;      // found elsewhere
  std::optional<std::pair<int, int>> image_size_px;  // width, height; for corners without images
  std::filesystem::path out = "intrinsics";
  LensModel lens = LensModel::kBrownConrady;
  BoardFitSettings board_fit;
  std::optional<std::string> guess;               // as it was typed: a camera file, or a focal length
  std::optional<double> guessed_focal_length_px;  // where it is a number
  std::vector<double> distances_m;  // of the maps; none: the boards', three times that and infinity
  bool prints_json = false;
  bool embeds_pictures = true;
  int threads = 2;
};

// The options that change the result, as they would be typed; "none" if all are default.
std::string OptionsText(const IntrinsicsSettings& settings);

}  // namespace legible
