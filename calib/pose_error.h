// How uncertain the poses are that a calibrated model predicts from joint readings, by its geometry alone.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/leg_model.h"

namespace legible {

// With P the derivative of the predicted poses by the parameters, means over the poses of P^T P:
// trace(position C), given the parameters' covariance C, is the mean squared distance (m2) of the platform's
// origin from where the model puts it, trace(rotation C) the mean squared angle (rad2).
struct PoseErrorForms {
  Eigen::MatrixXd position, rotation;  // square, one row a parameter
};

// Forms in the shared parameters (kSharedParameterCount square). by_shared is ModelBySharedParameters: A in
// base and B in platform in their gauges, so that moving either frame is no error. The readings' own noise is
// left out: it is no matter of calibration. Throws std::invalid_argument without poses, or where one is
// singular.
PoseErrorForms PoseErrorOf(const GoughStewart& robot, const std::vector<Rigid3>& base_from_platform,
                           const Eigen::MatrixXd& by_shared);

}  // namespace legible
