// Two directions across a third.
#pragma once

#include <Eigen/Geometry>

namespace legible {

// Two unit vectors across `direction` (any length but 0) and each other: small changes of where it points.
inline Eigen::Matrix<double, 3, 2> TangentsOf(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = direction.unitOrthogonal();
  tangents.col(1) = direction.normalized().cross(tangents.col(0));
  return tangents;
}

}  // namespace legible
