// A calibration's input as a least-squares problem, and where its iterations begin.
#pragma once

#include <vector>

#include "calib/estimation_problem.h"
#include "calib/leg_calibration.h"

namespace legible {

// Throws std::invalid_argument where the input contradicts itself or the options.
void CheckInput(const LegCalibrationInput& input, const LegCalibrationOptions& options);

// The input's start; without one the drawing, the guessed camera and the forward kinematics of the readings.
CalibrationStart StartOf(const LegCalibrationInput& input);

// Unknowns, readings, tags (of sigma 1) and what is known beforehand, from the start; the edges are left to
// the caller. Units come in the order of the images that have edges: one an image, or, where the platform is
// not rigid, one a leg.
EstimationProblem ProblemOf(const LegCalibrationInput& input, const LegCalibrationOptions& options,
                            const CalibrationStart& start);

// Adds the groups' placements, as drawn, and their tags, of sigma 1, to a problem that has its units.
void AddTags(const std::vector<ObservedTagGroup>& groups, const Rigid3& camera_from_base,
             EstimationProblem& problem);

}  // namespace legible
