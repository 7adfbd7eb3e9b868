// The geometric conditions of Type 2 singularities, for doubles and for balls alike.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "core/hidden/singularity_conditions.h"

namespace legible::singularity_geometry {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

// A platform joint, how it stands off the platform's origin, and the direction that belongs to it: t of the
// hidden robot, u of the real one.
template <typename T>
struct Joint {
  Vector3<T> platform_joint_m, from_origin_m, direction;
};

template <typename T>
T Determinant3(const Vector3<T>& a, const Vector3<T>& b, const Vector3<T>& c) {
  return a.dot(b.cross(c));
}

// Lines in the plane through the joints along d meet in a point, or are parallel.
template <typename T>
T LinesMeet(const std::vector<Joint<T>>& joints, const T& size_m, bool along_normal) {
  std::vector<Vector3<T>> lines;
  for (const Joint<T>& joint : joints) {
    const T dx = along_normal ? -joint.direction[1] : joint.direction[0];
    const T dy = along_normal ? joint.direction[0] : joint.direction[1];
    lines.push_back({dx, dy, (joint.from_origin_m[0] * dy - joint.from_origin_m[1] * dx) / size_m});
  }
  return Determinant3(lines[0], lines[1], lines[2]);
}

// Four planes (n, -n p) share a point; lengths from the first joint, in the robot's size.
template <typename T>
T PlanesMeet(const std::vector<Joint<T>>& joints, const T& size_m) {
  const Vector3<T>& origin = joints[0].platform_joint_m;
  const Vector3<T> second = (joints[1].platform_joint_m - origin) / size_m;
  const Vector3<T> third = (joints[2].platform_joint_m - origin) / size_m;
  const Vector3<T> normal = second.cross(third);
  // Planes through the first joint have no constant part: of the determinant by its last column two terms
  // stay.
  const T of_second = joints[1].direction.dot(second), of_third = joints[2].direction.dot(third);
  return of_third * Determinant3(joints[0].direction, joints[1].direction, normal) -
         of_second * Determinant3(joints[0].direction, joints[2].direction, normal);
}

// What translates along both t, or turns C_1 about C_2 as well.
template <typename T>
T Schoenflies(const std::vector<Joint<T>>& joints, const T& size_m) {
  const Vector3<T> apart = (joints[0].from_origin_m - joints[1].from_origin_m) / size_m;
  const Vector3<T> turning(-apart[1], apart[0], T(0));
  return Determinant3(joints[0].direction, joints[1].direction, turning);
}

}  // namespace legible::singularity_geometry
