// Tags on base and platform of a synthetic session, and what its camera sees of them.
#pragma once

#include <cstdint>
#include <vector>

#include "calib/leg_calibration.h"
#include "datasets/synthetic_session.h"

namespace legible {

struct SyntheticTagOptions {
  double corner_sigma_px = 0.05;  // 0: exact
  double translation_sigma_m = 0.002,
         rotation_sigma_rad = 0.0175;  // of the drawn placements; 0 error where exact
  double misread_fraction = 0;         // of the tags on the platform: their corners lie somewhere else
  std::uint64_t noise_seed = 1;
};

// A board of three tags beside the base and one tag on the platform, seen in every image. The drawn
// placements are off by what is known of them. Corners behind plates or outside the image are seen all the
// same: no image is drawn.
std::vector<ObservedTagGroup> DrawTags(const SyntheticSession& session, const SyntheticTagOptions& options);

// Adds the tags to a problem that stands at the session's truth, as CalibrateLegs would, their placements
// where the drawing has them.
void AddTagsToProblem(const std::vector<ObservedTagGroup>& tags, double corner_sigma_px,
                      EstimationProblem& problem);

}  // namespace legible
