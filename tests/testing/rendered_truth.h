// What the renderer of a session knew (truth.json), for checking only; no program reads it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

struct RenderedTruth {
  Camera camera;
  Rigid3 camera_from_base;
  GoughStewart robot;                                  // without joint ranges
  std::vector<std::pair<std::string, Rigid3>> images;  // name, base_from_platform
};

// Throws std::runtime_error where the file is missing or is not what it should be.
RenderedTruth ReadRenderedTruth(const std::filesystem::path& file);

}  // namespace legible
