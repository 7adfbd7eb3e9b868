#include "core/robots/leg_interaction.h"

#include "core/geometry/cylinder_outline.h"
#include "core/geometry/edge_distance.h"

namespace legible {
namespace {

// A leg in front of the camera.
struct SeenLeg {
  std::array<Eigen::Vector3d, 2> joints_in_camera;  // A, B
  std::array<Eigen::Vector3d, 2> normals;           // of both edges
  Eigen::Matrix<double, 3, 6> d_platform_joint;     // by the platform's twist in base
  double radius_m = 0;

  // Where the outline touches the cylinder beside a joint P: P + R n, for P.n = -R.
  Eigen::Vector3d EndInCamera(const EdgeEnd& end) const {
    return joints_in_camera[end.is_at_platform] + radius_m * normals[end.edge];
  }
};

std::optional<SeenLeg> SeeLeg(const Leg& leg, const Rigid3& camera_from_base,
                              const Rigid3& base_from_platform) {
  const Rigid3 camera_from_platform = camera_from_base * base_from_platform;
  SeenLeg seen;
  seen.radius_m = leg.radius_m;
  seen.joints_in_camera = {camera_from_base * leg.base_joint_m, camera_from_platform * leg.platform_joint_m};
  const auto axis = LineThrough<double>(seen.joints_in_camera[0], seen.joints_in_camera[1]);
  if (!CameraIsOutside(axis, leg.radius_m)) return std::nullopt;
  seen.normals = CylinderOutline(axis, leg.radius_m);
  const Eigen::Matrix3d camera_rotation_base = camera_from_base.rotation.toRotationMatrix();
  const Eigen::Vector3d arm_in_base = base_from_platform.rotation * leg.platform_joint_m;
  seen.d_platform_joint << camera_rotation_base, -camera_rotation_base * Skew(arm_in_base);
  return seen;
}

std::optional<Eigen::Vector2d> Image(const Camera& camera, const Eigen::Vector3d& x_in_camera) {
  if (x_in_camera.z() <= 0) return std::nullopt;
  const Eigen::Vector2d x = x_in_camera.hnormalized();
  if (x.norm() >= MonotonicRadius(camera.lens, camera.distortion)) return std::nullopt;
  return ProjectNormalised(camera, x);
}

// Across the edge in the image, outward: along the gradient of n.(x, 1) in pixels.
Eigen::Vector2d OutwardInImage(const Camera& camera, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& x_in_camera) {
  const Eigen::Matrix2d d_pixel =
      Eigen::Vector2d(camera.fx_px, camera.fy_px).asDiagonal() *
      DistortWithJacobians(camera.lens, camera.distortion, x_in_camera.hnormalized()).d_point_d_undistorted;
  return (d_pixel.transpose().inverse() * normal.head<2>()).normalized();
}

// One row; nothing without an image.
std::optional<Eigen::Matrix<double, 1, 6>> ShiftByTwist(const Camera& camera, const SeenLeg& leg,
                                                        const EdgeEnd& end) {
  const Eigen::Vector3d& normal = leg.normals[end.edge];
  const Eigen::Vector3d end_in_camera = leg.EndInCamera(end);
  const std::optional<Eigen::Vector2d> point_px = Image(camera, end_in_camera);
  if (!point_px) return std::nullopt;
  const auto distance =
      DistanceToEdge(camera, normal, *point_px, OutwardInImage(camera, normal, end_in_camera));
  if (!distance) return std::nullopt;
  const Eigen::Matrix3d d_normal =
      OutlineJacobian(leg.joints_in_camera[0], leg.joints_in_camera[1], normal).middleCols<3>(3);
  // The point's distance from the edge shrinks as the edge moves outward.
  return -distance->d_distance_d_normal * d_normal * leg.d_platform_joint;
}

}  // namespace

std::vector<EdgeEnd> EdgeEnds(const std::vector<int>& legs) {
  std::vector<EdgeEnd> ends;
  for (const int leg : legs)
    for (const int edge : {0, 1})
      for (const bool is_at_platform : {false, true}) ends.push_back({leg, edge, is_at_platform});
  return ends;
}

std::optional<Eigen::Matrix<double, Eigen::Dynamic, 6>> EdgeInteraction(const GoughStewart& robot,
                                                                        const Camera& camera,
                                                                        const Rigid3& camera_from_base,
                                                                        const Rigid3& base_from_platform,
                                                                        const std::vector<int>& legs) {
  const std::vector<EdgeEnd> ends = EdgeEnds(legs);
  Eigen::Matrix<double, Eigen::Dynamic, 6> interaction(ends.size(), 6);
  for (size_t i = 0; i < ends.size(); ++i) {
    const auto leg =
        SeeLeg(robot.legs.at(static_cast<size_t>(ends[i].leg)), camera_from_base, base_from_platform);
    const auto row = leg ? ShiftByTwist(camera, *leg, ends[i]) : std::nullopt;
    if (!row) return std::nullopt;
    interaction.row(static_cast<Eigen::Index>(i)) = *row;
  }
  return interaction;
}

}  // namespace legible
