// Finds the camera while drawing, lens and place are only guessed: what brings predictions within reach of
// the fine search for edges.
#pragma once

#include "calib/leg_calibration.h"
#include "core/vision/leg_edges.h"

namespace legible {

// How far off the legs may be in the image where a tape measure placed the camera (3 cm, 3 degrees).
double TapePoseRange_px(const Camera& camera);

// How far from its prediction an edge lies at most once the first look has succeeded.
inline constexpr double kSearchAfterFirstLook_px = 5;

// For the rough places of the edges in a few images, with legs up to range_px off all together.
LegEdgeOptions FirstLookEdges(const LegEdgeOptions& usual, double range_px);

// Of images measured like that: the drawing is trusted to 2 mm, the lens as one trusts a guess, the camera's
// pose not at all. What is not converged says nothing.
LegCalibration FirstLook(LegCalibrationInput input, const HeldParameters& hold, int threads);

}  // namespace legible
