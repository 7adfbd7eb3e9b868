// DistanceToEdge for any scalar, by another road: no derivative is written by hand. Links Ceres.
#pragma once

#include <ceres/jet.h>

#include <Eigen/LU>

#include "core/geometry/camera.h"
#include "core/geometry/edge_distance.h"
#include "tests/testing/derivatives.h"

namespace legible {

template <typename T>
Eigen::Matrix<T, 2, 1> PixelOf(LensModel lens, const Eigen::Matrix<T, kCameraParameterCount, 1>& camera,
                               const Eigen::Matrix<T, 2, 1>& undistorted) {
  const Eigen::Matrix<T, 8, 1> k = camera.template tail<8>();
  const Eigen::Matrix<T, 2, 1> distorted = Distort<T>(lens, k, undistorted);
  return camera.template head<2>().cwiseProduct(distorted) + camera.template segment<2>(2);
}

// Zero where x lies on the undistorted edge and its pixel on the line through point_px along direction_px.
template <typename T>
Eigen::Matrix<T, 2, 1> FootEquations(LensModel lens, const Eigen::Matrix<T, kCameraParameterCount, 1>& camera,
                                     const Eigen::Matrix<T, 3, 1>& normal, const Eigen::Vector2d& point_px,
                                     const Eigen::Vector2d& direction_px, const Eigen::Matrix<T, 2, 1>& x) {
  const Eigen::Matrix<T, 2, 1> offset = PixelOf<T>(lens, camera, x) - point_px.cast<T>();
  return {normal.template head<2>().dot(x) + normal[2],
          T(direction_px.x()) * offset[1] - T(direction_px.y()) * offset[0]};
}

// Newton in double with the derivatives of Jets; then, since the derivative there is exact, one step in T
// carries the derivatives of T through the implicit function (two are taken). `lens` and normal_value have
// the values of `camera` and `normal`.
template <typename T>
T DistanceByNewton(const Camera& lens, const Eigen::Matrix<T, kCameraParameterCount, 1>& camera,
                   const Eigen::Matrix<T, 3, 1>& normal, const Eigen::Vector2d& point_px,
                   const Eigen::Vector2d& direction_px, const Eigen::Vector3d& normal_value) {
  const CameraParameters camera_value = ParametersOf(lens);
  Eigen::Vector2d x = Unproject(lens, point_px).value();
  Eigen::Matrix2d inverse;
  for (int i = 0; i < 12; ++i) {
    const auto equations = [&](const auto& at) {
      using S = typename std::decay_t<decltype(at)>::Scalar;
      return FootEquations<S>(lens.lens, camera_value.cast<S>(), normal_value.cast<S>(), point_px,
                              direction_px, at);
    };
    inverse = JetJacobian(equations, x).inverse();
    x -= inverse * equations(x);
  }
  Eigen::Matrix<T, 2, 1> foot = x.cast<T>();
  for (int i = 0; i < 2; ++i)
    foot -= inverse.cast<T>() * FootEquations<T>(lens.lens, camera, normal, point_px, direction_px, foot);
  return direction_px.cast<T>().dot(point_px.cast<T>() - PixelOf<T>(lens.lens, camera, foot));
}

}  // namespace legible
