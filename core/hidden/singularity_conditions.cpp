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

// Signed or, of two directions of a translation, a length.
std::optional<double> ConditionOf(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                                  const std::vector<LegState>& states, const Rigid3& pose) {
  if (robot.motion == PlatformMotion::kTranslation && kind == RobotKind::kHidden && states.size() == 2)
    return states[0].free_direction.cross(states[1].free_direction).norm();
  return singularity_geometry::SignedCondition<double>(
      robot, kind, legs, {pose.translation, pose.rotation.toRotationMatrix()}, SizeOf_m(robot, pose));
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

// Of a leg's direction with what it has to cross.
double SineOf(const RobotLeg& leg, const LegState& state) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction == DirectionOf::kLeg) return std::abs(state.direction.dot(state.free_direction));
  if (segment.carrier == Carrier::kLine) return state.direction.cross(leg.first_axis).norm();
  return std::abs(state.direction.dot(state.start_m - leg.base_joint_m)) / leg.arm_m;
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
  measure.geometric = ConditionOf(robot, kind, legs, *states, base_from_platform);
  return measure;
}

std::optional<double> Type1MeasureOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                     const Rigid3& base_from_platform) {
  const auto states = StatesOf(robot, legs, base_from_platform);
  if (!states) return std::nullopt;
  double least = 1;
  for (size_t k = 0; k < legs.size(); ++k)
    least = std::min(least, SineOf(robot.legs[static_cast<size_t>(legs[k])], (*states)[k]));
  return least;
}

}  // namespace legible
