#include "servo/edge_motion.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/geometry/tangents.h"
#include "servo/servo_goal.h"

namespace legible {

bool SameEdges(const SeenEdges& a, const SeenEdges& b) {
  return std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(),
                    [](const SeenEdge& one, const SeenEdge& other) {
                      return one.leg == other.leg && one.edge == other.edge && one.normal == other.normal;
                    });
}

bool HasNoise(const SeenEdges& seen) {
  constexpr double kLeastNoise_rad = 3e-6;
  const auto has_noise = [](const SeenEdge& edge) {
    return edge.normal_covariance.trace() > kLeastNoise_rad * kLeastNoise_rad;
  };
  return !seen.edges.empty() && std::all_of(seen.edges.begin(), seen.edges.end(), has_noise);
}

bool HaveMoved(const SeenEdges& before, const SeenEdges& now) {
  constexpr double kMostMeanSquare = 2.5;
  constexpr double kNoMotion_rad = 3e-5;
  const EdgesByLeg edges_before = ByLeg(before);
  double squares = 0;
  int count = 0;
  for (const SeenEdge& edge : now.edges) {
    const auto& same = edges_before[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
    if (!same) continue;
    const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(edge.normal);
    const Eigen::Matrix2d covariance =
        kNoMotion_rad * kNoMotion_rad * Eigen::Matrix2d::Identity() +
        tangents.transpose() * (edge.normal_covariance + same->normal_covariance) * tangents;
    const Eigen::Vector2d moved = tangents.transpose() * (edge.normal - same->normal);
    squares += moved.dot(covariance.inverse() * moved);
    count += 2;
  }
  return count > 0 && !(squares <= kMostMeanSquare * count);
}

}  // namespace legible
