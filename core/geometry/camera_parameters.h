// The camera as a vector of unknowns, and how a point's pixel changes with them.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/geometry/camera.h"

namespace legible {

// fx fy cx cy (px), then the lens's coefficients as in Distortion: the order of every derivative with respect
// to a camera.
inline constexpr int kCameraParameterCount = 12;
using CameraParameters = Eigen::Matrix<double, kCameraParameterCount, 1>;

// "fx_px", ..., "k1", ...; coefficients that the lens does not have have names too.
const std::string& CameraParameterName(LensModel lens, int index);

CameraParameters ParametersOf(const Camera& camera);
// With the lens and the size of `camera`.
Camera WithParameters(const Camera& camera, const CameraParameters& parameters);

// What of each coefficient of the lens moves the image corner by its whole distance from the centre; of
// no meaning for those that the lens does not have.
Distortion CoefficientSizes(const Camera& camera);

// A point's pixel with its derivatives by the point and by the camera's parameters.
struct ProjectedPoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> d_x;
  Eigen::Matrix<double, 2, kCameraParameterCount> d_camera;
};

// Of a point in front of the camera (z > 0, which is not checked).
ProjectedPoint ProjectWithJacobians(const Camera& camera, const Eigen::Vector3d& x_in_camera);

}  // namespace legible
