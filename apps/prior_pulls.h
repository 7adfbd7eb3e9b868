// What was said beforehand of the parameters, against what was found.
#pragma once

#include <string>
#include <vector>

#include "apps/calibration_run.h"
#include "apps/found_parameters.h"

namespace legible {

struct PriorPull {
  std::string name;  // "legs[1].radius_m", "camera.fx_px"
  double value, sigma;
  double found;
  // (found - value) / sqrt(sigma^2 - sigma of found^2): standard normal where all sigmas are right, for the
  // difference of an estimate from what went into it has the difference of their variances. Of joints, whose
  // frame is fitted to the values, sigma^2 stands for what that fit leaves of it.
  double pull;
};

// Of the parameters that were estimated and of which something was said.
std::vector<PriorPull> PriorPulls(const CalibrationRun& run, const FoundParameters& found);

}  // namespace legible
