// The noise of corners: their own covariances, and what robust weights leave of it.
#pragma once

#include <Eigen/Core>

namespace legible {

// Takes an error in px to one in the corner's own sigmas: the inverse of the covariance's Cholesky factor.
// Throws std::invalid_argument unless it is positive definite.
Eigen::Matrix2d WhiteningOf(const Eigen::Matrix2d& covariance_px2);

// Of normal noise in the plane in sigmas: the median of the squared distance, and by which factor the mean
// of the squares weighted by RobustWeight of the distance falls short.
inline constexpr double kMedianSquareInPlane = 2 * 0.6931471805599453;
double CutOffInPlane();

}  // namespace legible
