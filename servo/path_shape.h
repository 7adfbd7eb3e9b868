// How straight a path was.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace legible {

struct PathShape {
  double length_m = 0;
  double deviation_m = 0;  // the farthest from the straight line through the first place and the goal
};
// Of a point's places in order, at least one.
PathShape ShapeOfPath(const std::vector<Eigen::Vector3d>& places_m, const Eigen::Vector3d& goal_m);

}  // namespace legible
