#include "servo/image_errors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace legible {
namespace {

class MeanSquares {
 public:
  void Add(const SquaredError& error) {
    sum_.squares += error.squares;
    sum_.noise_squares += error.noise_squares;
    ++count_;
  }
  double Rms() const { return Root(sum_.squares); }
  double NoiseRms() const { return Root(sum_.noise_squares); }

 private:
  double Root(double sum) const {
    return count_ > 0 ? std::sqrt(sum / count_) : std::numeric_limits<double>::quiet_NaN();
  }
  SquaredError sum_;
  int count_ = 0;
};

// Of the distance of an edge from the image point x, px^2.
double OffsetVariance(const ServoModel& model, const SeenEdge& edge, const Eigen::Vector3d& x) {
  const double scale = model.focal_px / edge.normal.head<2>().norm();
  return scale * scale * std::max(0.0, x.dot(edge.normal_covariance * x));
}

}  // namespace

SquaredError EdgeError(const ServoModel& model, const SeenEdge& seen, const SeenEdge& goal) {
  const double scale = model.focal_px / seen.normal.head<2>().norm();
  SquaredError error;
  for (const Eigen::Vector2d& end : goal.ends) {
    const Eigen::Vector3d x = end.homogeneous();
    const double offset_px = scale * seen.normal.dot(x);
    error.squares += offset_px * offset_px / 2;
    error.noise_squares += OffsetVariance(model, seen, x) / 2 + OffsetVariance(model, goal, x) / 2;
  }
  return error;
}

SquaredError DirectionError(const ServoGoal& goal, const SeenEdge& edge_1, const SeenEdge& edge_2) {
  const auto leg = static_cast<size_t>(edge_1.leg);
  const Eigen::Vector3d u = DirectionFromEdges(edge_1.normal, edge_2.normal);
  const Eigen::Vector3d& wanted = goal.directions[leg].value();
  const double angle = std::atan2(u.cross(wanted).norm(), u.dot(wanted));
  SquaredError error{angle * angle, DirectionCovariance(edge_1, edge_2).trace()};
  const auto& [goal_1, goal_2] = goal.edges[leg];
  if (goal_1 && goal_2) error.noise_squares += DirectionCovariance(*goal_1, *goal_2).trace();
  return error;
}

ImageErrors MeasureImageErrors(const ServoModel& model, const EdgesByLeg& seen, const ServoGoal& goal) {
  MeanSquares edges, directions;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    for (size_t edge = 0; edge < 2; ++edge)
      if (seen[leg][edge] && goal.edges[leg][edge])
        edges.Add(EdgeError(model, *seen[leg][edge], *goal.edges[leg][edge]));
    if (seen[leg][0] && seen[leg][1] && goal.directions[leg])
      directions.Add(DirectionError(goal, *seen[leg][0], *seen[leg][1]));
  }
  return {edges.Rms(), edges.NoiseRms(), directions.Rms(), directions.NoiseRms()};
}

}  // namespace legible
