// A pose as six numbers: x y z (m) and the rotation vector (rad).
#pragma once

#include "core/geometry/rigid3.h"

namespace legible {

inline Vector6d CoordinatesOf(const Rigid3& b_from_a) {
  Vector6d coordinates;
  coordinates << b_from_a.translation, VectorFromRotation(b_from_a.rotation);
  return coordinates;
}

inline Rigid3 PoseAt(const Vector6d& coordinates) {
  return {RotationFromVector(coordinates.tail<3>()), coordinates.head<3>()};
}

}  // namespace legible
