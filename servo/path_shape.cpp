#include "servo/path_shape.h"

#include <algorithm>

namespace legible {

PathShape ShapeOfPath(const std::vector<Eigen::Vector3d>& places_m, const Eigen::Vector3d& goal_m) {
  const Eigen::Vector3d& start = places_m.front();
  const Eigen::Vector3d along = (goal_m - start).normalized();  // zero where they are the same
  PathShape shape;
  for (size_t i = 0; i < places_m.size(); ++i) {
    if (i > 0) shape.length_m += (places_m[i] - places_m[i - 1]).norm();
    const Eigen::Vector3d way = places_m[i] - start;
    shape.deviation_m = std::max(shape.deviation_m, (way - along * along.dot(way)).norm());
  }
  return shape;
}

}  // namespace legible
