// How a leg reaches a pose, for doubles and for balls alike: what leg_state.cpp computes, and what
// certificates along a path enclose.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/robots/parallel_robot.h"

namespace legible::leg_geometry {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

// Where the seen segment is and how its far end moves with its direction held. `reach` is positive where the
// leg reaches the pose and zero where it does so only just (Type 1); all else is of use only where it is
// positive.
template <typename T>
struct Reached {
  Vector3<T> start_m, along_m, free_direction;  // B, C - B, t (not a unit vector)
  T reach;
};

// B on a circle about A, |BC| = rod: with x, y the coordinates of C - A in the arm's plane, the arm's
// direction v solves (x, y) v = g, g = (|AC|^2 + arm^2 - rod^2) / (2 arm) (Briot et al. 2016, eq. B.4).
template <typename T>
Reached<T> OnArm(const RobotLeg& leg, const Vector3<T>& from_base_joint_m) {
  using std::sqrt;
  const Vector3<T> ex = leg.zero_direction.cast<T>();
  const Vector3<T> ey = leg.first_axis.cross(leg.zero_direction).template cast<T>();
  const T arm(leg.arm_m), rod(leg.rod_m);
  const T x = from_base_joint_m.dot(ex), y = from_base_joint_m.dot(ey);
  const T in_plane = x * x + y * y;
  const T g = (from_base_joint_m.dot(from_base_joint_m) + arm * arm - rod * rod) / (T(2) * arm);
  const T reach = in_plane - g * g;
  if (!(reach > T(0))) return {{}, {}, {}, reach};
  const T h = T(leg.working_mode) * sqrt(reach);
  const Vector3<T> v = ((g * x - h * y) / in_plane) * ex + ((g * y + h * x) / in_plane) * ey;
  const Vector3<T> turned = ((g * x - h * y) / in_plane) * ey - ((g * y + h * x) / in_plane) * ex;
  const Vector3<T> start = leg.base_joint_m.cast<T>() + arm * v;
  return {start, from_base_joint_m - arm * v, turned, reach};
}

// B on a rail through A, |BC| = rod.
template <typename T>
Reached<T> OnRail(const RobotLeg& leg, const Vector3<T>& from_base_joint_m) {
  using std::sqrt;
  const Vector3<T> rail = leg.first_axis.cast<T>();
  const T rod(leg.rod_m);
  const T along = from_base_joint_m.dot(rail);
  const T reach = along * along - from_base_joint_m.dot(from_base_joint_m) + rod * rod;
  if (!(reach > T(0))) return {{}, {}, {}, reach};
  const T position = along + T(leg.working_mode) * sqrt(reach);
  return {leg.base_joint_m.cast<T>() + position * rail, from_base_joint_m - position * rail, rail, reach};
}

// B = A: the segment extends.
template <typename T>
Reached<T> Extended(const RobotLeg& leg, const Vector3<T>& from_base_joint_m) {
  return {leg.base_joint_m.cast<T>(), from_base_joint_m, from_base_joint_m,
          from_base_joint_m.dot(from_base_joint_m)};
}

// A leg whose direction is its own.
template <typename T>
Reached<T> Reach(const RobotLeg& leg, const SeenSegment& segment, const Vector3<T>& platform_joint_m) {
  const Vector3<T> from_base_joint_m = platform_joint_m - leg.base_joint_m.cast<T>();
  if (segment.carrier == Carrier::kCircle) return OnArm<T>(leg, from_base_joint_m);
  if (segment.carrier == Carrier::kLine) return OnRail<T>(leg, from_base_joint_m);
  return Extended<T>(leg, from_base_joint_m);
}

// M_i^T without the factor |u|: (I - t d^T / (d^T t)) / |d|, d = C - B: how u moves with C.
template <typename T>
Eigen::Matrix<T, 3, 3> DirectionByPlatformJoint(const Vector3<T>& along_m, const Vector3<T>& free_direction) {
  using std::sqrt;
  Eigen::Matrix<T, 3, 3> matrix = -(free_direction * along_m.transpose()) / along_m.dot(free_direction);
  for (int i = 0; i < 3; ++i) matrix(i, i) = matrix(i, i) + T(1);
  return matrix / sqrt(along_m.dot(along_m));
}

}  // namespace legible::leg_geometry
