#include "core/hidden/singularity_conditions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/hidden/seen_features.h"
#include "core/hidden/singularity_geometry.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

using singularity_geometry::Joint;

// The condition of the hidden robot with as many legs as the platform needs.
std::optional<double> HiddenCondition(PlatformMotion motion, const std::vector<Joint<double>>& joints,
                                      double size_m) {
  switch (motion) {
    case PlatformMotion::kPlanarPoint:
      if (joints.size() == 2) return joints[0].direction.cross(joints[1].direction).z();
      break;
    case PlatformMotion::kPlanar:
      if (joints.size() == 3) return singularity_geometry::LinesMeet(joints, size_m, true);
      break;
    case PlatformMotion::kTranslation:
      if (joints.size() == 2) return joints[0].direction.cross(joints[1].direction).norm();
      break;
    case PlatformMotion::kSchoenflies:
      if (joints.size() == 2) return singularity_geometry::Schoenflies(joints, size_m);
      break;
    case PlatformMotion::kSpatial:
      if (joints.size() == 3) return singularity_geometry::PlanesMeet(joints, size_m);
      break;
  }
  return std::nullopt;
}

// Of the lines along u through the platform joints, of which the real robot holds the lengths.
std::optional<double> RealCondition(PlatformMotion motion, const std::vector<Joint<double>>& joints,
                                    double size_m) {
  const size_t count = joints.size();
  if (motion == PlatformMotion::kPlanarPoint && count == 2)
    return joints[0].direction.cross(joints[1].direction).z();
  if (motion == PlatformMotion::kPlanar && count == 3)
    return singularity_geometry::LinesMeet(joints, size_m, false);
  if (motion == PlatformMotion::kTranslation && count == 3)
    return singularity_geometry::Determinant3(joints[0].direction, joints[1].direction, joints[2].direction);
  if ((motion == PlatformMotion::kSpatial && count == 6) ||
      (motion == PlatformMotion::kSchoenflies && count == 4)) {
    Eigen::MatrixXd lines(count, 6);
    for (size_t i = 0; i < count; ++i)
      lines.row(static_cast<Eigen::Index>(i)) << joints[i].direction.transpose(),
          joints[i].from_origin_m.cross(joints[i].direction).transpose() / size_m;
    if (count == 6) return lines.determinant();
    Eigen::Matrix4d square;
    square << lines.leftCols<3>(), lines.col(5);
    return square.determinant();
  }
  return std::nullopt;
}

// Whether the actuated joint holds the platform joint's place along u.
bool HoldsAlongLeg(const RobotLeg& leg) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction != DirectionOf::kLeg) return false;
  return leg.chain[0].is_actuated == (segment.carrier != Carrier::kFixed);
}

Eigen::MatrixXd HeldRows(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                         const std::vector<LegState>& states, const Rigid3& pose) {
  const Eigen::Index rows = kind == RobotKind::kReal ? 1 : 3;
  Eigen::MatrixXd matrix(rows * static_cast<Eigen::Index>(legs.size()), 6);
  for (size_t k = 0; k < legs.size(); ++k) {
    const RobotLeg& leg = robot.legs[static_cast<size_t>(legs[k])];
    const auto at = rows * static_cast<Eigen::Index>(k);
    if (kind == RobotKind::kReal) {
      const auto row = ReadingRow(leg, states[k], pose);
      matrix.row(at) = row / row.norm();
    } else {
      matrix.middleRows(at, 3) = DirectionInteraction(leg, states[k], pose);
    }
  }
  return matrix;
}

double SmallestOfLargest(const ParallelRobot& robot, const Rigid3& pose, const Eigen::MatrixXd& held) {
  const auto basis = MotionBasisInSize(robot, pose, SizeOf_m(robot, pose));
  if (held.rows() < basis.cols()) return 0;
  const auto values = (held * basis).jacobiSvd().singularValues();
  return values[0] > 0 ? values[basis.cols() - 1] / values[0] : 0;
}

}  // namespace

double SizeOf_m(const ParallelRobot& robot, const Rigid3& base_from_platform) {
  double sum_m = 0;
  for (const RobotLeg& leg : robot.legs) sum_m += (base_from_platform.translation - leg.base_joint_m).norm();
  return sum_m / static_cast<double>(robot.legs.size());
}

std::optional<Type2Measure> Type2MeasureOf(const ParallelRobot& robot, RobotKind kind,
                                           const std::vector<int>& legs, const Rigid3& base_from_platform) {
  const auto states = StatesOf(robot, legs, base_from_platform);
  if (!states) return std::nullopt;
  Type2Measure measure;
  measure.matrix =
      SmallestOfLargest(robot, base_from_platform, HeldRows(robot, kind, legs, *states, base_from_platform));
  std::vector<Joint<double>> joints;
  for (size_t k = 0; k < legs.size(); ++k) {
    const RobotLeg& leg = robot.legs[static_cast<size_t>(legs[k])];
    const bool is_known = kind == RobotKind::kReal ? HoldsAlongLeg(leg)
                                                   : SeenSegmentOf(leg.chain).direction == DirectionOf::kLeg;
    if (!is_known) return measure;
    const LegState& state = (*states)[k];
    joints.push_back({state.platform_joint_m, base_from_platform.rotation * leg.platform_joint_m,
                      kind == RobotKind::kReal ? state.direction : state.free_direction});
  }
  const double size_m = SizeOf_m(robot, base_from_platform);
  measure.geometric = kind == RobotKind::kReal ? RealCondition(robot.motion, joints, size_m)
                                               : HiddenCondition(robot.motion, joints, size_m);
  return measure;
}

std::optional<double> Type1MeasureOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                     const Rigid3& base_from_platform) {
  const auto states = StatesOf(robot, legs, base_from_platform);
  if (!states) return std::nullopt;
  double least = 1;
  for (const LegState& state : *states)
    least = std::min(least, std::abs(state.direction.dot(state.free_direction)));
  return least;
}

}  // namespace legible
