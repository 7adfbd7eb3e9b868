// The 3-UPS hidden in a hexapod: a way on which a servo of three legs' directions ends at another pose with
// all errors at zero.
#pragma once

#include <optional>
#include <string>

#include "core/robots/gough_stewart.h"
#include "core/robots/parallel_robot.h"

namespace legible {

struct MisledWay {
  std::vector<int> legs;  // three, from 0
  Rigid3 from, to;        // within the joint ranges
  Rigid3 ends_at;
  double largest_error_rad = 0;
};

// Searches poses of the robot within its joint ranges (fixed seed): goals that have a second mode of three
// legs within the joint ranges, and starts near that other mode. Nothing where there is none in so many
// tries.
std::optional<MisledWay> FindMisledWay(const GoughStewart& robot, int tries);

// Markdown: the way, where three legs lead, and what the choice of legs makes of it.
std::string MisledTable(const GoughStewart& robot, const MisledWay& way);

}  // namespace legible
