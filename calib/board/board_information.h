// What views of a board tell of the camera.
#pragma once

#include <Eigen/Core>

#include "calib/board/board_problem.h"

namespace legible {

struct BoardInformation {
  // Of the camera's unknowns (CameraUnknowns()), the poses and the warp eliminated.
  Eigen::MatrixXd information;
  // Of the camera's unknowns, then of the motion (v, omega) in the camera frame, about the camera's centre,
  // that all boards make together on average as the camera's unknowns change: a point that stands still
  // before the boards moves by v + omega x X before the camera. CameraUnknowns() + 6 square.
  Eigen::MatrixXd covariance;

  Eigen::MatrixXd CameraCovariance() const {
    return covariance.topLeftCorner(covariance.rows() - 6, covariance.cols() - 6);
  }
};

// At the problem's solution, with its whitening.
BoardInformation InformationOf(const BoardProblem& problem);

// The inverse of an information whose parameters differ by many orders: scaled to a unit diagonal first.
// Combinations that rounding hides, as of the coefficients of a lens that needs fewer, get the sigma at which
// it does.
Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& information);

// The information that one view adds, its pose eliminated, of the camera's unknowns alone.
Eigen::MatrixXd ViewInformation(const BoardProblem& problem, const ViewObservation& view);

}  // namespace legible
