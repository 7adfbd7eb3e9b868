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

}  // namespace

SquaredError EdgeError(const ServoModel& model, const SeenEdge& seen, const SeenEdge& goal) {
  const double scale = model.focal_px / seen.normal.head<2>().norm();
  SquaredError error;
  for (const Eigen::Vector2d& end : goal.ends) {
    const Eigen::Vector3d x = end.homogeneous();
    const double offset_px = scale * seen.normal.dot(x);
    error.squares += offset_px * offset_px / 2;
    error.noise_squares += scale * scale * std::max(0.0, x.dot(seen.normal_covariance * x)) / 2;
  }
  return error;
}

SquaredError DirectionError(const SeenEdge& edge_1, const SeenEdge& edge_2, const Eigen::Vector3d& goal) {
  const Eigen::Vector3d u = DirectionFromEdges(edge_1.normal, edge_2.normal);
  const double angle = std::atan2(u.cross(goal).norm(), u.dot(goal));
  return {angle * angle, DirectionCovariance(edge_1, edge_2).trace()};
}

ImageErrors MeasureImageErrors(const ServoModel& model, const EdgesByLeg& seen, const ServoGoal& goal) {
  MeanSquares edges, directions;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    for (size_t edge = 0; edge < 2; ++edge)
      if (seen[leg][edge] && goal.edges[leg][edge])
        edges.Add(EdgeError(model, *seen[leg][edge], *goal.edges[leg][edge]));
    if (seen[leg][0] && seen[leg][1] && goal.directions[leg])
      directions.Add(DirectionError(*seen[leg][0], *seen[leg][1], *goal.directions[leg]));
  }
  return {edges.Rms(), edges.NoiseRms(), directions.Rms(), directions.NoiseRms()};
}

}  // namespace legible
