// What is held, against what the observations would have it be.
#pragma once

#include <string>
#include <vector>

#include "calib/leg_calibration.h"

namespace legible {

struct HeldDifference {
  std::string parameter;  // as ModelCovariance names it
  double sigmas = 0;      // held less found once it is free, in the sigma that it then has
};

// Calibrates again from the solution with each of the things that are held set free, one after the other, and
// lists the parameters that move by more than `least_sigmas`, the largest first. What the observations leave
// open once it is free says nothing.
std::vector<HeldDifference> DifferencesOfHeld(const LegCalibrationInput& input,
                                              const LegCalibration& solution,
                                              const LegCalibrationOptions& options, double least_sigmas);

}  // namespace legible
