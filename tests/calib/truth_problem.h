// The estimation problem of a synthetic session, standing at its truth in the estimator's gauge.
#pragma once

#include <vector>

#include "calib/estimation_problem.h"
#include "datasets/synthetic_session.h"

namespace legible {

// Three images through a lens, five samples an edge that share an error: small enough for dense derivatives.
SyntheticSession SmallSession();

// platform' from platform, where platform' is the rigid fit of the true B to the drawn ones.
Rigid3 GaugeFromPlatform(const SyntheticSession& session);

// A in the camera frame, B in the frame that fits them to the drawing best.
SharedParameters TrueParameters(const SyntheticSession& session);

struct TruthProblemOptions {
  bool rigid_platform = true;
  bool joint_readings = true;
  double joint_reading_sigma_m = 2e-5;
  double lasting_shading_px = 0;  // 0: none is estimated
  EdgeNoise noise = {};
};

// What CalibrateLegs would solve for these observations of the session (Brown-Conrady lens, nothing else
// known, no lasting shading), with every unknown at its true value. Points into `observations`, which must
// outlive it.
EstimationProblem ProblemAtTruth(const SyntheticSession& session,
                                 const std::vector<ImageObservation>& observations,
                                 const TruthProblemOptions& options);

// Indices of the free shared parameters, ascending.
std::vector<int> FreeIndices(const EstimationProblem& problem);

}  // namespace legible
