// What the user of `legible capture` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace legible {

struct CaptureSettings {
  std::string rig;                             // "sim:TRUTH"
  std::optional<std::filesystem::path> robot;  // drawing and guessed camera; none: those that the rig names
  std::optional<std::filesystem::path> camera;
  std::optional<std::filesystem::path> poses;  // none: proposed ones
  std::optional<int> count;
  std::optional<double> until_m;                                     // sigma of the predicted position
  std::vector<std::pair<std::string, std::optional<double>>> known;  // names of KnownNames(); none: forgotten
  double speed_limit_m_per_s = 0.05;
  int seed = 1;
  int threads = 2;
  std::filesystem::path out;
  bool resumes = false;
  bool prints_json = false;
};

inline constexpr int kUsualImages = 40;

}  // namespace legible
