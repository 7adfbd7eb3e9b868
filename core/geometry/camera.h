// The pinhole camera with OpenCV's lens distortion, both ways, with derivatives.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace legible {

// How many of the distortion coefficients k1 k2 p1 p2 k3 k4 k5 k6 a lens has.
enum class LensModel {
  kPinhole = 0,       // none
  kFisheye = 4,  // k1 k2 k3 k4 of OpenCV's fisheye
  kBrownConrady = 5,  // k1 k2 p1 p2 k3, ROS "plumb_bob"
  kRational = 8,      // all eight, ROS "rational_polynomial"
};

using Distortion = Eigen::Matrix<double, 8, 1>;  // k1 k2 p1 p2 k3 k4 k5 k6; those a model lacks are 0

// Pixel (0, 0) is the centre of the top-left pixel; the camera frame is x right, y down, z forward.
struct Camera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  LensModel lens = LensModel::kBrownConrady;
  Distortion distortion = Distortion::Zero();
};

// Normalised (z = 1) coordinates to distorted normalised coordinates, OpenCV's definition:
//   radial = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
//   x_d = x radial + 2 p1 x y + p2 (r2 + 2 x^2),  y_d = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
// K is any indexable set of eight coefficients.
template <typename T, typename K>
Eigen::Matrix<T, 2, 1> Distort(const K& k, const Eigen::Matrix<T, 2, 1>& x) {
  const T r2 = x.squaredNorm();
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
DistortedPoint DistortWithJacobians(const Distortion& k, const Eigen::Vector2d& undistorted);

// Inverse of Distort by Newton: the only point within MonotonicRadius (here not limited to 10) that Distort
// takes to `distorted`; nothing where there is none.
std::optional<Eigen::Vector2d> Undistort(const Distortion& k, const Eigen::Vector2d& distorted);

// Camera-frame point (m) to pixels, and normalised coordinates to pixels.
// Project throws std::invalid_argument unless z > 0.
Eigen::Vector2d Project(const Camera& camera, const Eigen::Vector3d& x_in_camera);
Eigen::Vector2d ProjectNormalised(const Camera& camera, const Eigen::Vector2d& x);

// Pixel to undistorted normalised coordinates; nothing where the lens model has no inverse.
std::optional<Eigen::Vector2d> Unproject(const Camera& camera, const Eigen::Vector2d& pixel);

// Undistorted radius (normalised) of the disk about the image centre in which the lens model is one-to-one,
// searched up to 10. Without tangential terms it ends exactly where the radial part folds over or has a pole;
// with them, where the slope of the radial part falls to 6.4 |(p1, p2)| r, a hair before the fold.
double MonotonicRadius(const Distortion& k);

}  // namespace legible
