// How a leg reaches a pose, for doubles and for balls alike: what leg_state.cpp computes, and what
// certificates along a path enclose.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/robots/parallel_robot.h"

namespace legible::leg_geometry {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <typename T>
struct PlatformPose {
  Vector3<T> translation_m;  // base_from_platform
  Eigen::Matrix<T, 3, 3> rotation;
};

// A rail whose sine with what it has to cross is smaller is along it, and the leg reaches nothing.
inline constexpr double kLeastSine = 1e-12;

// Where the seen segment is and how its far end moves with its direction held. `reach` is positive where the
// leg reaches the pose and zero where it does so only just (Type 1); all else is of use only where it is
// positive.
template <typename T>
struct Reached {
  // B, the segment's way and t (neither a unit vector): C - B, or where the segment's direction is not the
  // leg's the direction of its rail; t is then along it, or of two rails along the first.
  Vector3<T> start_m, along_m, free_direction;
  T reach;
};

// About what a leg's angles count. A planar leg's second R turns about the same axis as its first.
inline Eigen::Vector3d AxisOfAngles(const RobotLeg& leg) {
  return leg.chain[0].type == JointType::kRevolute ? leg.first_axis : Eigen::Vector3d::UnitZ();
}

// A quarter turn in the plane of a planar robot.
template <typename T>
Vector3<T> AcrossInPlane(const Vector3<T>& x) {
  return {-x[1], x[0], T(0)};
}

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

// PPR: C = A + first d1 + second d2 in the plane.
template <typename T>
Reached<T> OnTwoRails(const RobotLeg& leg, const Vector3<T>& from_base_joint_m) {
  const Vector3<T> first = leg.first_axis.cast<T>(), second = leg.second_axis.cast<T>();
  const Vector3<T> across_second = AcrossInPlane<T>(second);
  const T sine = across_second.dot(first);
  const T reach = sine * sine - T(kLeastSine * kLeastSine);
  if (!(reach > T(0))) return {{}, {}, {}, reach};
  const T position = across_second.dot(from_base_joint_m) / sine;
  return {leg.base_joint_m.cast<T>() + position * first, second, first, reach};
}

// Where the line through C along the platform's rail passes the leg's rail or circle; PRP, RRP.
template <typename T>
Reached<T> OnPlatformRail(const RobotLeg& leg, Carrier carrier, const Vector3<T>& from_base_joint_m,
                          const Vector3<T>& rail) {
  using std::sqrt;
  const Vector3<T> across = AcrossInPlane<T>(rail), first = leg.first_axis.cast<T>();
  const Vector3<T> base_joint_m = leg.base_joint_m.cast<T>();
  const T distance = across.dot(from_base_joint_m);
  if (carrier == Carrier::kLine) {
    const T sine = across.dot(first);
    const T reach = sine * sine - T(kLeastSine * kLeastSine);
    if (!(reach > T(0))) return {{}, {}, {}, reach};
    return {base_joint_m + (distance / sine) * first, rail, rail, reach};
  }
  const T reach = T(leg.arm_m) * T(leg.arm_m) - distance * distance;
  if (!(reach > T(0))) return {{}, {}, {}, reach};
  const T along = T(leg.working_mode) * sqrt(reach);
  return {base_joint_m + distance * across + along * first.cross(across), rail, rail, reach};
}

// A leg to its platform joint; `rail` is its second_axis turned with the platform, of use to PRP and RRP.
template <typename T>
Reached<T> Reach(const RobotLeg& leg, const SeenSegment& segment, const Vector3<T>& platform_joint_m,
                 const Vector3<T>& rail) {
  const Vector3<T> from_base_joint_m = platform_joint_m - leg.base_joint_m.cast<T>();
  if (segment.direction == DirectionOf::kConstant) return OnTwoRails<T>(leg, from_base_joint_m);
  if (segment.direction == DirectionOf::kPlatform)
    return OnPlatformRail<T>(leg, segment.carrier, from_base_joint_m, rail);
  if (segment.carrier == Carrier::kCircle) return OnArm<T>(leg, from_base_joint_m);
  if (segment.carrier == Carrier::kLine) return OnRail<T>(leg, from_base_joint_m);
  return Extended<T>(leg, from_base_joint_m);
}

// A leg at a pose of the platform.
template <typename T>
struct PlacedLeg {
  Vector3<T> platform_joint_m;  // C
  Vector3<T> from_origin_m;     // what of C turns with the platform, from its origin
  Reached<T> reached;
};

template <typename T>
PlacedLeg<T> Placed(const RobotLeg& leg, const PlatformPose<T>& pose) {
  const Vector3<T> from_origin_m = pose.rotation * leg.platform_joint_m.cast<T>();
  const Vector3<T> c = pose.translation_m + from_origin_m + leg.carried_offset_m.cast<T>();
  const Vector3<T> rail = pose.rotation * leg.second_axis.cast<T>();
  return {c, from_origin_m, Reach<T>(leg, SeenSegmentOf(leg.chain), c, rail)};
}

// -[x]x
template <typename T>
Eigen::Matrix<T, 3, 3> MinusSkew(const Vector3<T>& x) {
  Eigen::Matrix<T, 3, 3> matrix;
  matrix << T(0), x[2], -x[1], -x[2], T(0), x[0], x[1], -x[0], T(0);
  return matrix;
}

// Velocity of a point that turns with the platform, by the twist (v, omega) of the platform's origin:
// [I, -[p]x], the point p from that origin.
template <typename T>
Eigen::Matrix<T, 3, 6> PointVelocity(const Vector3<T>& from_origin_m) {
  Eigen::Matrix<T, 3, 6> velocity;
  velocity << Eigen::Matrix<T, 3, 3>::Identity(), MinusSkew<T>(from_origin_m);
  return velocity;
}

// M_i^T without the factor |u|: (I - t d^T / (d^T t)) / |d|, d = C - B: how u moves with C.
template <typename T>
Eigen::Matrix<T, 3, 3> DirectionByPlatformJoint(const Vector3<T>& along_m, const Vector3<T>& free_direction) {
  using std::sqrt;
  Eigen::Matrix<T, 3, 3> matrix = -(free_direction * along_m.transpose()) / along_m.dot(free_direction);
  for (int i = 0; i < 3; ++i) matrix(i, i) = matrix(i, i) + T(1);
  return matrix / sqrt(along_m.dot(along_m));
}

// du/dt by the twist of the platform: what is held of the leg in a servo of its direction.
template <typename T>
Eigen::Matrix<T, 3, 6> DirectionRate(const RobotLeg& leg, const PlacedLeg<T>& placed) {
  Eigen::Matrix<T, 3, 6> rate = Eigen::Matrix<T, 3, 6>::Zero();
  const DirectionOf direction = SeenSegmentOf(leg.chain).direction;
  const Reached<T>& reached = placed.reached;
  if (direction == DirectionOf::kPlatform) rate.template rightCols<3>() = MinusSkew<T>(reached.along_m);
  if (direction == DirectionOf::kLeg)
    rate = DirectionByPlatformJoint<T>(reached.along_m, reached.free_direction) *
           PointVelocity<T>(placed.from_origin_m);
  return rate;
}

// What an actuated joint holds: the line along which it pushes the platform, its coordinates (force, moment
// about the platform's origin); of a joint that only turns the platform a couple (0, axis). The joint's speed
// is line . twist / power, `power` the work of that force for a unit of the joint's speed: zero in Type 1.
template <typename T>
struct HeldLine {
  Eigen::Matrix<T, 1, 6> line;
  T power;
};

template <typename T>
Eigen::Matrix<T, 1, 6> LineThrough(const Vector3<T>& from_origin_m, const Vector3<T>& force) {
  Eigen::Matrix<T, 1, 6> line;
  line << force.transpose(), from_origin_m.cross(force).transpose();
  return line;
}

// Of a leg whose direction is its own, through C: along the segment where the joint moves its start or
// its length. A joint that turns the segment about B pushes C across what else moves it: across the leg's
// own extension (RPR, RPS), across the rail (PRR), along A C for an arm (RRR).
template <typename T>
HeldLine<T> HeldThroughPlatformJoint(const RobotLeg& leg, Carrier carrier, const PlacedLeg<T>& placed) {
  using std::sqrt;
  const bool is_first = leg.chain[0].is_actuated;
  const Vector3<T> axis = AxisOfAngles(leg).cast<T>();
  const auto held = [&](const Vector3<T>& force, const Vector3<T>& by_joint) {
    return HeldLine<T>{LineThrough<T>(placed.from_origin_m, force), force.dot(by_joint)};
  };
  const Reached<T>& reached = placed.reached;
  const Vector3<T>& along_m = reached.along_m;
  if (carrier == Carrier::kFixed && !is_first) return held(along_m, along_m / sqrt(along_m.dot(along_m)));
  if (carrier == Carrier::kLine && is_first) return held(along_m, reached.free_direction);
  if (carrier == Carrier::kCircle && is_first) return held(along_m, T(leg.arm_m) * reached.free_direction);
  const Vector3<T> by_turning = axis.cross(along_m);
  if (carrier == Carrier::kFixed) return held(by_turning, by_turning);
  if (carrier == Carrier::kLine) return held(axis.cross(reached.free_direction), by_turning);
  return held(reached.start_m - leg.base_joint_m.cast<T>() + along_m, by_turning);
}

// PPR: through C across the rail that is not actuated.
template <typename T>
HeldLine<T> HeldAcrossRail(const RobotLeg& leg, const Vector3<T>& from_origin_m) {
  const bool is_first = leg.chain[0].is_actuated;
  const Vector3<T> held = (is_first ? leg.first_axis : leg.second_axis).cast<T>();
  const Vector3<T> force = AcrossInPlane<T>((is_first ? leg.second_axis : leg.first_axis).cast<T>());
  return {LineThrough<T>(from_origin_m, force), force.dot(held)};
}

// PRP, RRP: across the platform's rail, at B where B is held, at A where the rail is held to the arm; where
// its direction is held a couple.
template <typename T>
HeldLine<T> HeldByPlatformRail(const RobotLeg& leg, Carrier carrier, const PlacedLeg<T>& placed) {
  const bool is_first = leg.chain[0].is_actuated, is_on_rail = carrier == Carrier::kLine;
  const Vector3<T> axis = AxisOfAngles(leg).cast<T>();
  if (is_on_rail && !is_first) {
    Eigen::Matrix<T, 1, 6> couple = Eigen::Matrix<T, 1, 6>::Zero();
    couple.template tail<3>() = axis.transpose();
    return {couple, T(1)};
  }
  const Vector3<T> force = AcrossInPlane<T>(placed.reached.along_m);
  const Vector3<T> base_joint_m = leg.base_joint_m.cast<T>();
  const Vector3<T> from_a = placed.reached.start_m - base_joint_m;
  const Vector3<T>& at_m = is_first ? placed.reached.start_m : base_joint_m;
  const T power = is_on_rail ? force.dot(leg.first_axis.cast<T>()) : force.dot(axis.cross(from_a));
  return {LineThrough<T>(placed.from_origin_m + (at_m - placed.platform_joint_m), force),
          is_first ? power : -power};
}

// Of any leg that reaches the pose.
template <typename T>
HeldLine<T> HeldByJoint(const RobotLeg& leg, const PlacedLeg<T>& placed) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction == DirectionOf::kConstant) return HeldAcrossRail<T>(leg, placed.from_origin_m);
  if (segment.direction == DirectionOf::kPlatform) return HeldByPlatformRail<T>(leg, segment.carrier, placed);
  return HeldThroughPlatformJoint<T>(leg, segment.carrier, placed);
}

// The line along which an R that carries no other joint holds its leg's platform joint in a plane (RPS).
template <typename T>
Eigen::Matrix<T, 1, 6> SidewaysLine(const RobotLeg& leg, const Vector3<T>& from_origin_m) {
  return LineThrough<T>(from_origin_m, leg.first_axis.cast<T>());
}

}  // namespace legible::leg_geometry
