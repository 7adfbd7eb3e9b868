#include "core/vision/predicted_legs.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace legible {
namespace {

// The nearest that the segment from the camera centre to `target` comes to the leg's axis.
struct Approach {
  double distance_m;
  double share_of_axis;
  double depth_m;  // along the sight line
};

Approach NearestApproach(const Eigen::Vector3d& sight, const LegInCamera& leg) {
  const Eigen::Vector3d axis = leg.b_in_camera - leg.a_in_camera;
  const Eigen::Vector3d across = axis - axis.dot(sight) * sight;
  const Eigen::Vector3d from_sight = leg.a_in_camera - leg.a_in_camera.dot(sight) * sight;
  const double share = std::clamp(-from_sight.dot(across) / across.squaredNorm(), 0.0, 1.0);
  const Eigen::Vector3d nearest = leg.AxisPoint(share);
  const double depth = nearest.dot(sight);
  return {(nearest - depth * sight).norm(), share, depth};
}

// The convex hull of the platform joints about their mean plane, widened, as something that hides what is
// behind.
class Plate {
 public:
  Plate(const LegsInCamera& legs, double margin_m) {
    centre_.setZero();
    for (const LegInCamera& leg : legs) centre_ += leg.b_in_camera / kLegCount;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const LegInCamera& leg : legs) {
      const Eigen::Vector3d from_centre = leg.b_in_camera - centre_;
      scatter += from_centre * from_centre.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
    normal_ = axes.eigenvectors().col(0);
    along_ = axes.eigenvectors().rightCols<2>();
    for (const LegInCamera& leg : legs) {
      const Eigen::Vector2d corner = along_.transpose() * (leg.b_in_camera - centre_);
      corners_.push_back(corner + margin_m * corner.normalized());
    }
    std::sort(corners_.begin(), corners_.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
    });
  }

  bool Hides(const Eigen::Vector3d& target) const {
    const double share = normal_.dot(centre_) / normal_.dot(target);
    if (!(share > 0 && share < 1)) return false;
    const Eigen::Vector2d crossing = along_.transpose() * (share * target - centre_);
    // Inside the star-shaped outline through the corners in angular order.
    for (size_t i = 0; i < corners_.size(); ++i) {
      const Eigen::Vector2d& a = corners_[i];
      const Eigen::Vector2d& b = corners_[(i + 1) % corners_.size()];
      Eigen::Matrix2d sector;
      sector << a, b;
      const Eigen::Vector2d weights = sector.inverse() * crossing;
      if (weights.minCoeff() >= 0) return weights.sum() <= 1;
    }
    return false;
  }

 private:
  Eigen::Vector3d centre_, normal_;
  Eigen::Matrix<double, 3, 2> along_;
  std::vector<Eigen::Vector2d> corners_;
};

// Decides what stands between the camera and the edges of one leg.
class Obstacles {
 public:
  Obstacles(const LegsInCamera& legs, const Camera& camera, const VisibilityOptions& options)
      : legs_(legs), camera_(camera), options_(options), plate_(legs, options.platform_margin_m) {}

  void Mark(int leg, const Eigen::Vector3d& on_edge, PredictedEdgePoint& point) const {
    const LegInCamera& own = legs_[static_cast<size_t>(leg)];
    const double joint_share =
        options_.joint_radii * own.radius_m / (own.b_in_camera - own.a_in_camera).norm();
    if (point.share < joint_share || point.share > 1 - joint_share)
      point.obstacle = EdgeObstacle::kJoint;
    else if (NearBorder(point.point_px))
      point.obstacle = EdgeObstacle::kImageBorder;
    else if (plate_.Hides(on_edge))
      point.obstacle = EdgeObstacle::kPlatform;
    else if (const int other = LegInTheWay(leg, on_edge); other >= 0) {
      point.obstacle = EdgeObstacle::kOtherLeg;
      point.obstacle_leg = other;
    }
  }

 private:
  bool NearBorder(const Eigen::Vector2d& p) const {
    const double m = options_.margin_px;
    return p.x() < m || p.y() < m || p.x() > camera_.width_px - 1 - m || p.y() > camera_.height_px - 1 - m;
  }

  int LegInTheWay(int leg, const Eigen::Vector3d& on_edge) const {
    const Eigen::Vector3d sight = on_edge.normalized();
    for (int other = 0; other < kLegCount; ++other) {
      if (other == leg) continue;
      const LegInCamera& cylinder = legs_[static_cast<size_t>(other)];
      const Approach approach = NearestApproach(sight, cylinder);
      const bool at_end = approach.share_of_axis < 0.05 || approach.share_of_axis > 0.95;
      const double covered_m = cylinder.radius_m * (at_end ? options_.joint_radii : 1) +
                               options_.margin_px * approach.depth_m / camera_.fx_px;
      if (approach.distance_m < covered_m) return other;
    }
    return -1;
  }

  const LegsInCamera& legs_;
  const Camera& camera_;
  const VisibilityOptions& options_;
  Plate plate_;
};

PredictedEdge PredictEdge(const LegInCamera& leg, int leg_index, const Eigen::Vector3d& normal,
                          const Camera& camera, const Obstacles& obstacles,
                          const VisibilityOptions& options) {
  PredictedEdge edge{normal, 0, {}};
  if (leg.a_in_camera.z() <= 0 || leg.b_in_camera.z() <= 0) return edge;
  const double length_px = (Project(camera, leg.a_in_camera) - Project(camera, leg.b_in_camera)).norm();
  const int count = std::max(2, static_cast<int>(std::ceil(length_px / options.step_px)) + 1);
  for (int i = 0; i < count; ++i) {
    PredictedEdgePoint point;
    point.share = static_cast<double>(i) / (count - 1);
    // The sight plane of the edge touches the cylinder at P + R n.
    const Eigen::Vector3d on_edge = leg.AxisPoint(point.share) + leg.radius_m * normal;
    const auto image_point = EdgePointNear(camera, normal, on_edge);
    if (!image_point) return {normal, 0, {}};
    point.point_px = image_point->point_px;
    point.normal_px = image_point->normal_px;
    obstacles.Mark(leg_index, on_edge, point);
    edge.points.push_back(point);
  }
  const PredictedEdgePoint& middle = edge.points[edge.points.size() / 2];
  edge.half_width_px =
      std::abs(middle.normal_px.dot(middle.point_px - Project(camera, leg.AxisPoint(middle.share))));
  return edge;
}

}  // namespace

LegsInCamera PlaceLegs(const GoughStewart& robot, const Rigid3& camera_from_base,
                       const Rigid3& base_from_platform) {
  LegsInCamera legs;
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    legs[i] = {camera_from_base * leg.base_joint_m,
               camera_from_base * (base_from_platform * leg.platform_joint_m), leg.radius_m};
  }
  return legs;
}

std::optional<ImagePointOnEdge> EdgePointNear(const Camera& camera, const Eigen::Vector3d& normal,
                                              const Eigen::Vector3d& x_in_camera) {
  if (x_in_camera.z() <= 0) return std::nullopt;
  const Eigen::Vector2d line = normal.head<2>();
  Eigen::Vector2d x = x_in_camera.hnormalized();
  x -= line * (line.dot(x) + normal.z()) / line.squaredNorm();
  const DistortedPoint distorted = DistortWithJacobians(camera.lens, camera.distortion, x);
  const Eigen::Vector2d focal(camera.fx_px, camera.fy_px);
  const Eigen::Matrix2d d_pixel = focal.asDiagonal() * distorted.d_point_d_undistorted;
  if (!(d_pixel.determinant() > 0)) return std::nullopt;
  const Eigen::Vector2d normal_px = d_pixel.transpose().inverse() * line;
  return ImagePointOnEdge{focal.cwiseProduct(distorted.point) + Eigen::Vector2d(camera.cx_px, camera.cy_px),
                          normal_px.normalized()};
}

PredictedEdges PredictEdges(const LegsInCamera& legs, const Camera& camera,
                            const VisibilityOptions& options) {
  const Obstacles obstacles(legs, camera, options);
  PredictedEdges edges;
  for (int i = 0; i < kLegCount; ++i) {
    const LegInCamera& leg = legs[static_cast<size_t>(i)];
    const PluckerLine<double> axis = LineThrough<double>(leg.a_in_camera, leg.b_in_camera);
    if (!CameraIsOutside(axis, leg.radius_m)) continue;
    const auto normals = CylinderOutline(axis, leg.radius_m);
    for (size_t j = 0; j < 2; ++j)
      edges[static_cast<size_t>(i)][j] = PredictEdge(leg, i, normals[j], camera, obstacles, options);
  }
  return edges;
}

std::string Describe(const PredictedEdgePoint& point) {
  switch (point.obstacle) {
    case EdgeObstacle::kNone:
      return "visible";
    case EdgeObstacle::kOtherLeg:
      return "hidden or crossed by leg " + std::to_string(point.obstacle_leg + 1);
    case EdgeObstacle::kPlatform:
      return "behind the platform";
    case EdgeObstacle::kJoint:
      return "at a joint";
    case EdgeObstacle::kImageBorder:
      return "outside the image";
  }
  return "";
}

}  // namespace legible
