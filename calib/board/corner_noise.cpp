#include "calib/board/corner_noise.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "calib/robust_weights.h"

namespace legible {

Eigen::Matrix2d WhiteningOf(const Eigen::Matrix2d& covariance_px2) {
  const Eigen::LLT<Eigen::Matrix2d> factor(covariance_px2);
  if (factor.info() != Eigen::Success || !covariance_px2.allFinite())
    throw std::invalid_argument("a corner's covariance is not positive definite");
  return factor.matrixL().solve(Eigen::Matrix2d::Identity());
}

double CutOffInPlane() {
  static const double value = [] {
    double weights = 0, weighted_squares = 0;
    for (double m = 0; m <= 7; m += 1e-3) {
      const double density = m * std::exp(-m * m / 2);
      weights += RobustWeight(m) * density;
      weighted_squares += RobustWeight(m) * m * m * density;
    }
    return weighted_squares / weights / 2;
  }();
  return value;
}

}  // namespace legible
