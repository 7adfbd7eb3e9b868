// Finds legs whose predicted place is wrong by tens of pixels.
#pragma once

#include <array>
#include <optional>

#include "core/vision/gray_image.h"
#include "core/vision/predicted_legs.h"

namespace legible {

struct LegLockOptions {
  double blur_px = 2;            // the image is smoothed by this first
  double range_px = 45;          // how far off all legs together may be (camera guess)
  double roll_range_rad = 0.07;  // by how much the image may be turned about its centre
  double scale_range = 0.05;     // by how much the robot may look larger or smaller
  double leg_range_px = 12;      // how far off each leg may be once the common error is gone (drawing)
  double least_contrast = 1.5;   // grey levels per px that both edges of a leg must show on average

  void Check() const;  // throws std::invalid_argument
};

// By how much a leg lies beside its prediction, across it towards its edge 2 (outward normal n2).
struct LegLock {
  double shift_at_a_px = 0;
  double shift_at_b_px = 0;
  double contrast = 0;  // mean over the profiles, grey levels per px
};

// First the shift, roll and scale common to all legs that puts most leg-like profiles (two opposite edges a
// leg's width apart) under the predicted axes, by branch and bound; then each leg by itself. A leg that
// shows no two edges near its place gets none.
std::array<std::optional<LegLock>, kLegCount> LockOnLegs(const GrayImage& image,
                                                         const PredictedEdges& predicted,
                                                         const LegLockOptions& options);

}  // namespace legible
