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

// Signed or, of two directions of a translation, a length.
std::optional<double> ConditionOf(PlatformMotion motion, RobotKind kind,
                                  const std::vector<Joint<double>>& joints, double size_m) {
  if (motion == PlatformMotion::kTranslation && kind == RobotKind::kHidden && joints.size() == 2)
    return joints[0].direction.cross(joints[1].direction).norm();
  return singularity_geometry::SignedCondition(motion, kind, joints, size_m);
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
    const bool is_known = kind == RobotKind::kReal ? HoldsAlongSegment(leg.chain)
                                                   : SeenSegmentOf(leg.chain).direction == DirectionOf::kLeg;
    if (!is_known) return measure;
    const LegState& state = (*states)[k];
    joints.push_back({state.platform_joint_m, base_from_platform.rotation * leg.platform_joint_m,
                      kind == RobotKind::kReal ? state.direction : state.free_direction});
  }
  const double size_m = SizeOf_m(robot, base_from_platform);
  measure.geometric = ConditionOf(robot.motion, kind, joints, size_m);
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
