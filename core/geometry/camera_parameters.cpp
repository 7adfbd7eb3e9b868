#include "core/geometry/camera_parameters.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace legible {

const std::string& CameraParameterName(LensModel lens, int index) {
  using Names = std::array<std::string, kCameraParameterCount>;
  static const Names pinhole = {"fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2",
                                "p1",    "p2",    "k3",    "k4",    "k5", "k6"};
  static const Names fisheye = {"fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2",
                                "k3",    "k4",    "k5",    "k6",    "k7", "k8"};
  return (lens == LensModel::kFisheye ? fisheye : pinhole).at(static_cast<size_t>(index));
}

CameraParameters ParametersOf(const Camera& camera) {
  CameraParameters parameters;
  parameters << camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.distortion;
  return parameters;
}

Camera WithParameters(const Camera& camera, const CameraParameters& parameters) {
  Camera result = camera;
  result.fx_px = parameters[0];
  result.fy_px = parameters[1];
  result.cx_px = parameters[2];
  result.cy_px = parameters[3];
  result.distortion = parameters.tail<8>();
  return result;
}

Distortion CoefficientSizes(const Camera& camera) {
  const double r2 = Eigen::Vector2d(camera.cx_px / camera.fx_px, camera.cy_px / camera.fy_px).squaredNorm();
  const double r = std::sqrt(r2), r4 = r2 * r2;
  Distortion sizes;
  if (camera.lens == LensModel::kFisheye)  // there r is the angle
    sizes << 1 / r2, 1 / r4, 1 / (r2 * r4), 1 / (r4 * r4), Eigen::Vector4d::Ones();
  else
    sizes << 1 / r2, 1 / r4, 1 / r, 1 / r, 1 / (r2 * r4), 1 / r2, 1 / r4, 1 / (r2 * r4);
  return sizes;
}

ProjectedPoint ProjectWithJacobians(const Camera& camera, const Eigen::Vector3d& x_in_camera) {
  const Eigen::Vector2d normalised = x_in_camera.hnormalized();
  const DistortedPoint lens = DistortWithJacobians(camera.lens, camera.distortion, normalised);
  const Eigen::Vector2d focal(camera.fx_px, camera.fy_px);
  Eigen::Matrix<double, 2, 3> d_normalised;
  d_normalised << Eigen::Matrix2d::Identity(), -normalised;
  ProjectedPoint result;
  result.pixel = focal.cwiseProduct(lens.point) + Eigen::Vector2d(camera.cx_px, camera.cy_px);
  result.d_x = focal.asDiagonal() * lens.d_point_d_undistorted * d_normalised / x_in_camera.z();
  result.d_camera << Eigen::Matrix2d(lens.point.asDiagonal()), Eigen::Matrix2d::Identity(),
      focal.asDiagonal() * lens.d_point_d_coefficients;
  return result;
}

}  // namespace legible
