// What one more image tells of the shared parameters, and what that gains.
#pragma once

#include <Eigen/Core>

#include "calib/estimation_problem.h"
#include "core/vision/edge_observation.h"

namespace legible {

// What an image adds to SharedInformation of any problem with the shared parameters of `problem`, whatever
// other images that holds: its data with its own pose eliminated, kSharedParameterCount square. Readings of
// sigma reading_sigma_m; without a number they take no part. Throws as SharedInformation.
Eigen::MatrixXd ImageInformation(const EstimationProblem& problem, const ImageObservation& image,
                                 const Rigid3& camera_from_platform,
                                 const std::optional<double>& reading_sigma_m, const EdgeNoise& noise);

// J with J^T J = the matrix, which is symmetric and positive semi-definite; as many rows as its rank.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& matrix);

// By how much an image of information J^T J lowers trace(M C), M = Q^T Q, from where the covariance of the
// parameters is C: trace(M (C - (C^-1 + J^T J)^-1)) = |L^-1 J C Q^T|^2 with L L^T = I + J C J^T (Woodbury's
// identity; |.| the Frobenius norm). root: J; q_covariance: Q C.
double GainOf(const Eigen::MatrixXd& root, const Eigen::MatrixXd& covariance,
              const Eigen::MatrixXd& q_covariance);

}  // namespace legible
