// The camera with OpenCV's lens models, pinhole and fisheye, both ways, with derivatives.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>

namespace legible {

// By how many distortion coefficients each has. The fisheye's are others than those of the pinhole family.
enum class LensModel {
  kPinhole = 0,       // none
  kFisheye = 4,       // k1 k2 k3 k4, ROS "equidistant"
  kBrownConrady = 5,  // k1 k2 p1 p2 k3, ROS "plumb_bob"
  kRational = 8,      // k1 k2 p1 p2 k3 k4 k5 k6, ROS "rational_polynomial"
};

using Distortion = Eigen::Matrix<double, 8, 1>;  // the lens's coefficients in that order, then zeros

// Pixel (0, 0) is the centre of the top-left pixel; the camera frame is x right, y down, z forward.
struct Camera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  LensModel lens = LensModel::kBrownConrady;
  Distortion distortion = Distortion::Zero();
};

// arctan(r) / r by r2 = r^2: its Taylor series where the quotient and its derivatives would lose digits.
template <typename T>
T ArctanRatio(const T& r2) {
  using std::atan;
  using std::sqrt;
  constexpr double kSeriesUpTo = 1.0 / 16;  // 13 terms leave 1e-17
  if (r2 > kSeriesUpTo) {
    const T r = sqrt(r2);
    return atan(r) / r;
  }
  T sum(0.0);
  for (int n = 12; n >= 0; --n) sum = T((n % 2 == 0 ? 1.0 : -1.0) / (2 * n + 1)) + r2 * sum;
  return sum;
}

// Normalised (z = 1) coordinates to distorted normalised coordinates, OpenCV's definitions:
//   pinhole family: radial = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
//     x_d = x radial + 2 p1 x y + p2 (r2 + 2 x^2),  y_d = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
//   fisheye: (x_d, y_d) = (x, y) theta_d / r,  theta = arctan(r),
//     theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
// K is any indexable set of eight coefficients.
template <typename T, typename K>
Eigen::Matrix<T, 2, 1> Distort(LensModel lens, const K& k, const Eigen::Matrix<T, 2, 1>& x) {
  const T r2 = x.squaredNorm();
  if (lens == LensModel::kFisheye) {
    const T ratio = ArctanRatio<T>(r2);
    const T theta2 = r2 * ratio * ratio;
    const T radial = ratio * (T(1.0) + theta2 * (k[0] + theta2 * (k[1] + theta2 * (k[2] + theta2 * k[3]))));
    return {x[0] * radial, x[1] * radial};
  }
  const T xy2 = T(2.0) * x[0] * x[1];
  const T radial =
      (T(1.0) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (T(1.0) + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x[0] * radial + k[2] * xy2 + k[3] * (r2 + T(2.0) * x[0] * x[0]),
          x[1] * radial + k[2] * (r2 + T(2.0) * x[1] * x[1]) + k[3] * xy2};
}

// Distort with its derivatives.
struct DistortedPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d d_point_d_undistorted;
  Eigen::Matrix<double, 2, 8> d_point_d_coefficients;
};
DistortedPoint DistortWithJacobians(LensModel lens, const Distortion& k, const Eigen::Vector2d& undistorted);

// Inverse of Distort by Newton: the only point within MonotonicRadius (here not limited to 10) that Distort
// takes to `distorted`; nothing where there is none.
std::optional<Eigen::Vector2d> Undistort(LensModel lens, const Distortion& k,
                                         const Eigen::Vector2d& distorted);

// Inverse of Distort with all coefficients 0: where iterations begin. The fisheye's is cut off at a radius
// of 10.
Eigen::Vector2d UndistortIdeally(LensModel lens, const Eigen::Vector2d& distorted);

// Camera-frame point (m) to pixels, and normalised coordinates to pixels.
// Project throws std::invalid_argument unless z > 0.
Eigen::Vector2d Project(const Camera& camera, const Eigen::Vector3d& x_in_camera);
Eigen::Vector2d ProjectNormalised(const Camera& camera, const Eigen::Vector2d& x);

// Pixel to undistorted normalised coordinates; nothing where the lens model has no inverse.
std::optional<Eigen::Vector2d> Unproject(const Camera& camera, const Eigen::Vector2d& pixel);

// Undistorted radius (normalised) of the disk about the image centre in which the lens model is one-to-one,
// searched up to 10 (84 degrees from the axis). Without tangential terms it ends exactly where the radial
// part folds over or has a pole; with them, where the slope of the radial part falls to 6.4 |(p1, p2)| r, a
// hair before the fold.
double MonotonicRadius(LensModel lens, const Distortion& k);

}  // namespace legible
