// What all observations together tell of the shared parameters.
#pragma once

#include <Eigen/Core>

#include "calib/estimation_problem.h"

namespace legible {

// Information of the shared parameters (kSharedParameterCount square) after elimination of every unit's pose
// and of the tags' placements: data and priors, without the gauge; rows of parameters that are not free are
// zero. Throws std::runtime_error where the model cannot be evaluated where the problem stands.
Eigen::MatrixXd SharedInformation(const EstimationProblem& problem);

}  // namespace legible
