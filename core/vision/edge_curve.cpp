#include "core/vision/edge_curve.h"

#include <algorithm>
#include <map>

namespace legible {
namespace {

// The outline normal of the edge through two image points, on the side of `like`; nothing where the lens
// folds.
std::optional<Eigen::Vector3d> NormalThrough(const Camera& camera, const Eigen::Vector2d& a_px,
                                             const Eigen::Vector2d& b_px, const Eigen::Vector3d& like) {
  const auto a = Unproject(camera, a_px), b = Unproject(camera, b_px);
  if (!a || !b) return std::nullopt;
  const Eigen::Vector3d normal = a->homogeneous().cross(b->homogeneous()).normalized();
  return normal.dot(like) < 0 ? Eigen::Vector3d(-normal) : normal;
}

// To a new outline normal.
void MoveTo(const Camera& camera, const LegInCamera& leg, const Eigen::Vector3d& normal,
            PredictedEdge& edge) {
  edge.normal = normal;
  for (PredictedEdgePoint& point : edge.points) {
    const auto moved = EdgePointNear(camera, normal, leg.AxisPoint(point.share) + leg.radius_m * normal);
    if (!moved) {
      point.obstacle = EdgeObstacle::kImageBorder;
      continue;
    }
    point.point_px = moved->point_px;
    point.normal_px = moved->normal_px;
  }
}

}  // namespace

void ShiftEnds(const Camera& camera, const LegInCamera& leg, double at_a_px, double at_b_px,
               PredictedEdge& edge) {
  const PredictedEdgePoint &a = edge.points.front(), &b = edge.points.back();
  const auto normal = NormalThrough(camera, a.point_px + at_a_px * a.normal_px,
                                    b.point_px + at_b_px * b.normal_px, edge.normal);
  if (normal) MoveTo(camera, leg, *normal, edge);
}

double VisibleLength(const PredictedEdge& edge) {
  double length = 0;
  for (size_t i = 0; i + 1 < edge.points.size(); ++i)
    if (edge.points[i].obstacle == EdgeObstacle::kNone && edge.points[i + 1].obstacle == EdgeObstacle::kNone)
      length += (edge.points[i + 1].point_px - edge.points[i].point_px).norm();
  return length;
}

std::string MainObstacle(const PredictedEdge& edge) {
  std::map<std::string, int> reasons;
  for (const PredictedEdgePoint& point : edge.points)
    if (point.obstacle != EdgeObstacle::kNone) ++reasons[Describe(point)];
  const auto most = std::max_element(reasons.begin(), reasons.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == reasons.end() ? "too short in the image" : most->first;
}

}  // namespace legible
