// What the user of `legible legs` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "apps/option_values.h"
#include "core/geometry/orientation.h"
#include "core/geometry/rigid3.h"

namespace legible {

// Half angle of the cone about each seen direction, where the user says nothing: 0.1 degrees, as in the
// paper.
inline constexpr double kAssumedDirectionNoise_rad = 0.1 * kDegree_rad;

enum class LegsFormat { kTable, kJson, kHtml };

struct LegsSettings {
  std::filesystem::path model;
  std::optional<Vector6d> from, to;        // x y z (m) and a rotation vector (rad); else the robot's home
  std::vector<std::vector<int>> leg_sets;  // from 0; empty: every set
  double noise_rad = kAssumedDirectionNoise_rad;
  double gain_per_s = 0.8;
  std::optional<CoordinateRanges> map;  // of two coordinates
  LegsFormat format = LegsFormat::kTable;
  std::optional<std::filesystem::path> out;  // else standard output
};

}  // namespace legible
