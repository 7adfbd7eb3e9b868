// The geometric conditions of Type 2 singularities, for doubles and for balls alike.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "core/algebra/ball.h"
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

inline double MiddleOf(double x) { return x; }
inline double MiddleOf(const RealBall& x) { return MidpointOf(x); }

// By elimination with the pivots of the largest middles; of balls not a number where one of these may be 0.
template <typename T>
T DeterminantOf(Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> matrix) {
  T determinant(1.0);
  for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < matrix.rows(); ++i)
      if (std::abs(MiddleOf(matrix(i, k))) > std::abs(MiddleOf(matrix(pivot, k)))) pivot = i;
    if (MiddleOf(matrix(pivot, k)) == 0) return T(0.0) * matrix(pivot, k);
    if (pivot != k) {
      matrix.row(pivot).swap(matrix.row(k));
      determinant = -determinant;
    }
    determinant *= matrix(k, k);
    for (Eigen::Index i = k + 1; i < matrix.rows(); ++i)
      matrix.row(i) -= matrix.row(k) * (matrix(i, k) / matrix(k, k));
  }
  return determinant;
}

// Lines through the joints are dependent; a Schoenflies motion has four of their coordinates.
template <typename T>
T LinesDependent(const std::vector<Joint<T>>& joints, const T& size_m) {
  const auto count = static_cast<Eigen::Index>(joints.size());
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> lines(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Joint<T>& joint = joints[static_cast<size_t>(i)];
    const Vector3<T> moment = joint.from_origin_m.cross(joint.direction) / size_m;
    for (Eigen::Index k = 0; k < 3; ++k) lines(i, k) = joint.direction[k];
    for (Eigen::Index k = 3; k < count; ++k) lines(i, k) = moment[count == 4 ? 2 : k - 3];
  }
  return DeterminantOf<T>(lines);
}

// The condition that changes its sign in a Type 2 singularity, of as many legs as the platform needs; nothing
// for another number of them, and for two directions of a translation, whose condition has no sign.
template <typename T>
std::optional<T> SignedCondition(PlatformMotion motion, RobotKind kind, const std::vector<Joint<T>>& joints,
                                 const T& size_m) {
  const size_t count = joints.size();
  const bool is_hidden = kind == RobotKind::kHidden;
  if (motion == PlatformMotion::kPlanarPoint && count == 2)
    return joints[0].direction.cross(joints[1].direction)[2];
  if (motion == PlatformMotion::kPlanar && count == 3) return LinesMeet(joints, size_m, is_hidden);
  if (is_hidden) {
    if (motion == PlatformMotion::kSchoenflies && count == 2) return Schoenflies(joints, size_m);
    if (motion == PlatformMotion::kSpatial && count == 3) return PlanesMeet(joints, size_m);
    return std::nullopt;
  }
  if (motion == PlatformMotion::kTranslation && count == 3)
    return Determinant3(joints[0].direction, joints[1].direction, joints[2].direction);
  const bool has_all = (motion == PlatformMotion::kSpatial && count == 6) ||
                       (motion == PlatformMotion::kSchoenflies && count == 4);
  return has_all ? std::optional<T>(LinesDependent(joints, size_m)) : std::nullopt;
}

}  // namespace legible::singularity_geometry
