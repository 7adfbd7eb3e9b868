#include "core/robots/leg_state.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/robots/leg_geometry.h"

namespace legible {
namespace {

// Angle of a direction about an axis, from where it is zero.
double Angle_rad(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis, const Eigen::Vector3d& zero) {
  return std::atan2(direction.dot(axis.cross(zero)), direction.dot(zero));
}

// Of the actuated joint.
double ReadingOf(const RobotLeg& leg, const SeenSegment& segment, const LegState& state) {
  const Eigen::Vector3d from_a = state.start_m - leg.base_joint_m;
  const bool is_first = leg.chain[0].is_actuated;
  if (segment.direction == DirectionOf::kConstant && !is_first)
    return (state.platform_joint_m - state.start_m).dot(leg.second_axis);
  if (segment.carrier == Carrier::kLine && is_first) return from_a.dot(leg.first_axis);
  if (segment.carrier == Carrier::kFixed && !is_first) return state.length_m;
  const Eigen::Vector3d axis = leg_geometry::AxisOfAngles(leg);
  const auto angle_rad = [&](const Eigen::Vector3d& direction) {
    return Angle_rad(direction, axis, leg.zero_direction);
  };
  if (segment.carrier != Carrier::kCircle) return angle_rad(state.direction);
  return is_first ? angle_rad(from_a) : angle_rad(state.direction) - angle_rad(from_a);
}

// As it was reached.
leg_geometry::PlacedLeg<double> PlacedOf(const RobotLeg& leg, const LegState& state,
                                         const Rigid3& base_from_platform) {
  const double length_m = state.length_m > 0 ? state.length_m : 1;
  return {state.platform_joint_m,
          base_from_platform.rotation * leg.platform_joint_m,
          {state.start_m, length_m * state.direction, state.free_direction, 0}};
}

}  // namespace

Eigen::Matrix<double, 3, 6> PlatformPointVelocity(const Eigen::Vector3d& from_origin_m) {
  return leg_geometry::PointVelocity<double>(from_origin_m);
}

std::optional<std::vector<LegState>> StatesOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                              const Rigid3& base_from_platform) {
  std::vector<LegState> states;
  for (const int leg : legs) {
    const auto state = StateOf(robot.legs[static_cast<size_t>(leg)], base_from_platform);
    if (!state) return std::nullopt;
    states.push_back(*state);
  }
  return states;
}

std::optional<LegState> StateOf(const RobotLeg& leg, const Rigid3& base_from_platform) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  const auto placed = leg_geometry::Placed<double>(
      leg, {base_from_platform.translation, base_from_platform.rotation.toRotationMatrix()});
  const leg_geometry::Reached<double>& reached = placed.reached;
  if (!(reached.reach > 0)) return std::nullopt;
  const double length_m = segment.direction == DirectionOf::kLeg ? reached.along_m.norm() : 0;
  LegState state{reached.start_m,
                 placed.platform_joint_m,
                 reached.along_m.normalized(),
                 length_m,
                 reached.free_direction.normalized(),
                 0};
  if (segment.direction == DirectionOf::kLeg &&
      std::abs(state.direction.dot(state.free_direction)) < leg_geometry::kLeastSine)
    return std::nullopt;
  state.reading = ReadingOf(leg, segment, state) - leg.joint_offset;
  return state;
}

Eigen::Matrix<double, 3, 6> DirectionInteraction(const RobotLeg& leg, const LegState& state,
                                                 const Rigid3& base_from_platform) {
  return leg_geometry::DirectionRate<double>(leg, PlacedOf(leg, state, base_from_platform));
}

Eigen::Matrix<double, 1, 6> ReadingRow(const RobotLeg& leg, const LegState& state,
                                       const Rigid3& base_from_platform) {
  const auto held = leg_geometry::HeldByJoint<double>(leg, PlacedOf(leg, state, base_from_platform));
  return held.line / held.power;
}

}  // namespace legible
