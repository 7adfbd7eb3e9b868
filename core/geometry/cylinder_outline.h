// The two edges that a camera sees of a cylinder.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/geometry/plucker_line.h"

namespace legible {

// Both outline normals of a cylinder of radius_m about `axis_in_camera`: unit n1, n2 of the planes through
// the camera centre that touch the cylinder, pointing away from it, so that P.n = -R for every P on the axis
// (Andreff et al., eq. 11, 12). An image point with normalised coordinates x is on edge j where n_j.(x, 1) =
// 0 and outside the leg where that is positive. Needs |moment| > radius_m: the camera centre lies outside the
// cylinder (see CameraIsOutside).
template <typename T>
std::array<Eigen::Matrix<T, 3, 1>, 2> CylinderOutline(const PluckerLine<T>& axis_in_camera,
                                                      const T& radius_m) {
  using std::sqrt;
  const T distance2 = axis_in_camera.moment.squaredNorm();
  const T distance = sqrt(distance2);
  const T sin_theta = radius_m / distance;
  const T cos_theta = sqrt(distance2 - radius_m * radius_m) / distance;
  const Eigen::Matrix<T, 3, 1> h = axis_in_camera.moment / distance;
  const Eigen::Matrix<T, 3, 1> inward = axis_in_camera.direction.cross(h) * sin_theta;
  return {Eigen::Matrix<T, 3, 1>(-cos_theta * h - inward), Eigen::Matrix<T, 3, 1>(cos_theta * h - inward)};
}

// Whether the camera centre lies outside the cylinder, so that it has two edges.
inline bool CameraIsOutside(const PluckerLine<double>& axis_in_camera, double radius_m) {
  return axis_in_camera.moment.squaredNorm() > radius_m * radius_m;
}

// How an outline normal moves with the leg that makes it: 3 x 7, columns A (3, m), B (3, m), R (m); A and B
// are two axis points in the camera frame. From A.n = -R, n.n = 1, u.n = 0 (Andreff et al., eq. 14-16, 21-26,
// with A and R free as well). The camera centre must lie outside the cylinder.
Eigen::Matrix<double, 3, 7> OutlineJacobian(const Eigen::Vector3d& a_in_camera,
                                            const Eigen::Vector3d& b_in_camera,
                                            const Eigen::Vector3d& normal);

}  // namespace legible
