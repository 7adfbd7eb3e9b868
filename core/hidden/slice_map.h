// Singularities and errors over a slice of the workspace.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/hidden/cone_noise.h"
#include "core/hidden/singularity_conditions.h"

namespace legible {

// A coordinate of poses (0 to 5: x y z in m, then a rotation vector in rad) and its values, equally spaced,
// both ends included.
struct SliceAxis {
  int coordinate = 0;
  double from = 0, to = 0;
  int count = 2;

  double At(int i) const { return from + (to - from) * i / (count - 1); }
};

struct SliceCell {
  double type1 = 0;                         // Type1MeasureOf, of all legs
  Type2Measure hidden, real;                // of the seen legs; of all legs
  std::optional<LargestPoseError> largest;  // by cone noise; nothing where the hidden robot is singular
};

struct SliceMap {
  std::array<SliceAxis, 2> axes;
  // Row by row, axes[0] the faster one; nothing where a leg does not reach the pose.
  std::vector<std::optional<SliceCell>> cells;
};

// Poses that differ from base_from_platform in the two coordinates of the axes. Throws std::invalid_argument
// where an axis has fewer than two values or the coordinates are the same.
SliceMap MapSlice(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& base_from_platform,
                  const std::array<SliceAxis, 2>& axes, double cone_half_angle_rad);

}  // namespace legible
