// The geometric conditions of Type 2 singularities, for doubles and for balls alike.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/algebra/ball.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/leg_geometry.h"
#include "core/robots/platform_motion.h"

namespace legible::singularity_geometry {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <typename T>
using Line = Eigen::Matrix<T, 1, 6>;  // its force and moment about the platform's origin

// A platform joint, how it stands off the platform's origin, and the direction t in which it moves with its
// leg's direction held.
template <typename T>
struct Joint {
  Vector3<T> platform_joint_m, from_origin_m, direction;
};

template <typename T>
T Determinant3(const Vector3<T>& a, const Vector3<T>& b, const Vector3<T>& c) {
  return a.dot(b.cross(c));
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
    if ((matrix.col(k).tail(matrix.rows() - k).array() == T(0.0)).all()) return T(0.0);
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

// Lines are dependent in the coordinates that the motion has, of as many lines: in a plane they meet in a
// point or are parallel. Lengths in the robot's size.
template <typename T>
std::optional<T> LinesDependent(PlatformMotion motion, const std::vector<Line<T>>& lines, const T& size_m) {
  const std::vector<int> coordinates = FreeCoordinates(motion);
  if (lines.size() != coordinates.size()) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(lines.size());
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> matrix(count, count);
  using std::sqrt;
  for (Eigen::Index i = 0; i < count; ++i) {
    Line<T> line = lines[static_cast<size_t>(i)];
    line.template tail<3>() /= size_m;
    line /= sqrt(line.dot(line));
    for (Eigen::Index k = 0; k < count; ++k) matrix(i, k) = line[coordinates[static_cast<size_t>(k)]];
  }
  return DeterminantOf<T>(matrix);
}

// Along which a leg of a planar robot holds its platform joint with its direction held: across t, or where
// its direction is the platform's a couple. Nothing where its direction is constant.
template <typename T>
std::optional<Line<T>> LineHeldByDirection(const RobotLeg& leg, const leg_geometry::PlacedLeg<T>& placed) {
  const DirectionOf direction = SeenSegmentOf(leg.chain).direction;
  if (direction == DirectionOf::kConstant) return std::nullopt;
  if (direction == DirectionOf::kPlatform) return Line<T>(Line<T>::Unit(5));
  const Vector3<T> across = leg_geometry::AcrossInPlane<T>(placed.reached.free_direction);
  return leg_geometry::LineThrough<T>(placed.from_origin_m, across);
}

// Of the legs' own joints and of the R of RPS legs, or of a planar robot's legs with their directions held.
template <typename T>
std::optional<T> ConditionOfLines(const ParallelRobot& robot, RobotKind kind,
                                  const std::vector<const RobotLeg*>& legs,
                                  const std::vector<leg_geometry::PlacedLeg<T>>& placed,
                                  const leg_geometry::PlatformPose<T>& pose, const T& size_m) {
  std::vector<Line<T>> lines;
  for (size_t k = 0; k < legs.size(); ++k) {
    const auto line = kind == RobotKind::kReal ? leg_geometry::HeldByJoint<T>(*legs[k], placed[k]).line
                                               : LineHeldByDirection<T>(*legs[k], placed[k]);
    if (!line) return std::nullopt;
    lines.push_back(*line);
  }
  for (const RobotLeg* leg : LegsKeptInPlanes(robot))
    lines.push_back(leg_geometry::SidewaysLine<T>(*leg, pose.rotation * leg->platform_joint_m.cast<T>()));
  return LinesDependent<T>(robot.motion, lines, size_m);
}

// Of legs of a hidden robot that is not planar. A direction of an RPS leg tells what its R forbids too: all
// of these have to be seen.
template <typename T>
std::optional<T> ConditionOfTangents(const ParallelRobot& robot, const std::vector<const RobotLeg*>& legs,
                                     const std::vector<leg_geometry::PlacedLeg<T>>& placed, const T& size_m) {
  using std::sqrt;
  std::vector<Joint<T>> joints;
  for (const auto& leg : placed) {
    const Vector3<T>& t = leg.reached.free_direction;
    joints.push_back({leg.platform_joint_m, leg.from_origin_m, t / sqrt(t.dot(t))});
  }
  if (robot.motion == PlatformMotion::kSchoenflies && joints.size() == 2) return Schoenflies(joints, size_m);
  const auto kept_in_planes = LegsKeptInPlanes(robot);
  const bool sees_these = std::all_of(kept_in_planes.begin(), kept_in_planes.end(), [&](const RobotLeg* leg) {
    return std::find(legs.begin(), legs.end(), leg) != legs.end();
  });
  if (robot.motion == PlatformMotion::kSpatial && joints.size() == 3 && sees_these)
    return PlanesMeet(joints, size_m);
  return std::nullopt;
}

// The condition that changes its sign in a Type 2 singularity, of as many legs (from 0) as the platform
// needs; nothing for another number of them, where one does not reach the pose, or may not, and for two
// directions of a translation, whose condition has no sign.
template <typename T>
std::optional<T> SignedCondition(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                                 const leg_geometry::PlatformPose<T>& pose, const T& size_m) {
  std::vector<const RobotLeg*> of_robot;
  std::vector<leg_geometry::PlacedLeg<T>> placed;
  for (const int leg : legs) {
    of_robot.push_back(&robot.legs[static_cast<size_t>(leg)]);
    placed.push_back(leg_geometry::Placed<T>(*of_robot.back(), pose));
    if (!(placed.back().reached.reach > T(0))) return std::nullopt;
  }
  const bool is_planar =
      robot.motion == PlatformMotion::kPlanarPoint || robot.motion == PlatformMotion::kPlanar;
  if (kind == RobotKind::kReal || is_planar)
    return ConditionOfLines<T>(robot, kind, of_robot, placed, pose, size_m);
  return ConditionOfTangents<T>(robot, of_robot, placed, size_m);
}

}  // namespace legible::singularity_geometry
