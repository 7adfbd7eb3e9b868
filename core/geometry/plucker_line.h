// Lines in space by normalised Plücker coordinates.
#pragma once

#include <Eigen/Geometry>

namespace legible {

// A line with unit direction u through P: moment = P x u (m), the normal of the plane through the line and
// the origin; |moment| is the line's distance from the origin. (Andreff et al., eq. 1, with h = |h| h-bar.)
template <typename T>
struct PluckerLine {
  Eigen::Matrix<T, 3, 1> direction;
  Eigen::Matrix<T, 3, 1> moment;
};

// The line from `start` towards `end`, both in m in the same frame; undefined direction if they coincide.
template <typename T>
PluckerLine<T> LineThrough(const Eigen::Matrix<T, 3, 1>& start, const Eigen::Matrix<T, 3, 1>& end) {
  const Eigen::Matrix<T, 3, 1> direction = (end - start).normalized();
  return {direction, start.cross(direction)};
}

}  // namespace legible
