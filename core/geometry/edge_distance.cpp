#include "core/geometry/edge_distance.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace legible {
namespace {

constexpr int kMaxIterations = 20;
constexpr double kTolerance = 1e-13;  // of the foot's normalised coordinates

struct Foot {
  Eigen::Vector2d undistorted;
  DistortedPoint distorted;
  Eigen::Matrix2d d_pixel_d_undistorted;
};

Eigen::Vector2d FocalLengths(const Camera& camera) { return {camera.fx_px, camera.fy_px}; }
Eigen::Vector2d Centre(const Camera& camera) { return {camera.cx_px, camera.cy_px}; }

Foot EvaluateFoot(const Camera& camera, const Eigen::Vector2d& undistorted) {
  Foot foot{undistorted, DistortWithJacobians(camera.lens, camera.distortion, undistorted), {}};
  foot.d_pixel_d_undistorted = FocalLengths(camera).asDiagonal() * foot.distorted.d_point_d_undistorted;
  return foot;
}

Eigen::Vector2d Pixel(const Camera& camera, const Foot& foot) {
  return FocalLengths(camera).cwiseProduct(foot.distorted.point) + Centre(camera);
}

// Two equations for x: it lies on the line, and its pixel lies on the ray through the point.
std::optional<Foot> FindFoot(const Camera& camera, const Eigen::Vector3d& normal,
                             const Eigen::Vector2d& point_px, const Eigen::Vector2d& across_px) {
  const Eigen::Vector2d line = normal.head<2>();
  Eigen::Vector2d x =
      UndistortIdeally(camera.lens, (point_px - Centre(camera)).cwiseQuotient(FocalLengths(camera)));
  x -= line * (line.dot(x) + normal.z()) / line.squaredNorm();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Foot foot = EvaluateFoot(camera, x);
    Eigen::Matrix2d equations;
    equations << line.transpose(), across_px.transpose() * foot.d_pixel_d_undistorted;
    const Eigen::Vector2d error(line.dot(x) + normal.z(), across_px.dot(Pixel(camera, foot) - point_px));
    const Eigen::Vector2d step = equations.inverse() * error;
    if (!step.allFinite()) return std::nullopt;
    if (step.norm() < kTolerance) return foot;
    x -= step;
  }
  return std::nullopt;
}

}  // namespace

std::optional<EdgeDistance> DistanceToEdge(const Camera& camera, const Eigen::Vector3d& normal,
                                           const Eigen::Vector2d& point_px,
                                           const Eigen::Vector2d& direction_px) {
  const Eigen::Vector2d across_px(-direction_px.y(), direction_px.x());
  const std::optional<Foot> foot = FindFoot(camera, normal, point_px, across_px);
  if (!foot) return std::nullopt;

  EdgeDistance result;
  result.foot_undistorted = foot->undistorted;
  result.distance_px = direction_px.dot(point_px - Pixel(camera, *foot));

  // Differentiate both equations: the pixel moves by -dr along direction_px only, and the foot stays on the
  // line. With w = G^-T (normal's xy), G = d pixel / d x:  dr = (x.dn - w.(d pixel / d camera) dcamera) /
  // (w.direction).
  const Eigen::Vector2d w = foot->d_pixel_d_undistorted.transpose().inverse() * normal.head<2>();
  const double scale = 1 / w.dot(direction_px);
  result.d_distance_d_normal = scale * foot->undistorted.homogeneous().transpose();
  result.d_distance_d_camera.head<2>() = -scale * w.cwiseProduct(foot->distorted.point).transpose();
  result.d_distance_d_camera.segment<2>(2) = -scale * w.transpose();
  result.d_distance_d_camera.tail<8>() =
      -scale * w.cwiseProduct(FocalLengths(camera)).transpose() * foot->distorted.d_point_d_coefficients;
  if (!result.d_distance_d_camera.allFinite()) return std::nullopt;
  return result;
}

}  // namespace legible
