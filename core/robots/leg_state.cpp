#include "core/robots/leg_state.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/robots/leg_geometry.h"

namespace legible {
namespace {

// Sine below which a direction is along what it has to cross.
constexpr double kLeastSine = 1e-12;

using Row6 = Eigen::Matrix<double, 1, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

Matrix36 PlatformJointVelocity(const RobotLeg& leg, const Rigid3& base_from_platform) {
  return PlatformPointVelocity(base_from_platform.rotation * leg.platform_joint_m);
}

// Angle of a direction about an axis, from where it is zero.
double Angle_rad(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis, const Eigen::Vector3d& zero) {
  return std::atan2(direction.dot(axis.cross(zero)), direction.dot(zero));
}

// About what a leg's angles count. A planar leg's second R turns about the same axis as its first.
Eigen::Vector3d AxisOfAngles(const RobotLeg& leg) {
  return leg.chain[0].type == JointType::kRevolute ? leg.first_axis : Eigen::Vector3d::UnitZ();
}

// PPR: C = A + first d1 + second d2 in the plane.
std::optional<LegState> StateOfTwoRails(const RobotLeg& leg, const Eigen::Vector3d& c) {
  Eigen::Matrix2d rails;
  rails << leg.first_axis.head<2>(), leg.second_axis.head<2>();
  if (std::abs(rails.determinant()) < kLeastSine) return std::nullopt;
  const Eigen::Vector2d positions = rails.inverse() * (c - leg.base_joint_m).head<2>();
  const Eigen::Vector3d start = leg.base_joint_m + positions[0] * leg.first_axis;
  const double reading = leg.chain[0].is_actuated ? positions[0] : positions[1];
  return LegState{start, c, leg.second_axis, 0, leg.first_axis, reading - leg.joint_offset};
}

// Where the line through C along the platform's rail passes the leg's circle or rail; PRP, RRP.
std::optional<Eigen::Vector3d> StartOnPlatformRail(const RobotLeg& leg, Carrier carrier,
                                                   const Eigen::Vector3d& c,
                                                   const Eigen::Vector3d& across_rail) {
  const Eigen::Vector3d& a = leg.base_joint_m;
  const double distance_m = across_rail.dot(c - a);
  if (carrier == Carrier::kLine) {
    const double sine = across_rail.dot(leg.first_axis);
    if (std::abs(sine) < kLeastSine) return std::nullopt;
    return a + distance_m / sine * leg.first_axis;
  }
  const double reach = leg.arm_m * leg.arm_m - distance_m * distance_m;
  if (!(reach > 0)) return std::nullopt;
  return a + distance_m * across_rail +
         leg.working_mode * std::sqrt(reach) * leg.first_axis.cross(across_rail);
}

std::optional<LegState> StateOnPlatformRail(const RobotLeg& leg, Carrier carrier, const Eigen::Vector3d& c,
                                            const Rigid3& base_from_platform) {
  const Eigen::Vector3d axis = AxisOfAngles(leg);
  const Eigen::Vector3d direction = base_from_platform.rotation * leg.second_axis;
  const auto start = StartOnPlatformRail(leg, carrier, c, Eigen::Vector3d::UnitZ().cross(direction));
  if (!start) return std::nullopt;
  const Eigen::Vector3d from_a = *start - leg.base_joint_m;
  const bool is_first = leg.chain[0].is_actuated;
  double reading = Angle_rad(direction, axis, leg.zero_direction);
  if (carrier == Carrier::kLine && is_first) reading = from_a.dot(leg.first_axis);
  if (carrier == Carrier::kCircle) {
    const double arm_angle = Angle_rad(from_a, axis, leg.zero_direction);
    reading = is_first ? arm_angle : reading - arm_angle;
  }
  return LegState{*start, c, direction, 0, direction, reading - leg.joint_offset};
}

// Of the actuated joint of a leg whose direction is its own.
double ReadingOf(const RobotLeg& leg, Carrier carrier, const LegState& state) {
  const Eigen::Vector3d from_a = state.start_m - leg.base_joint_m;
  const bool is_first = leg.chain[0].is_actuated;
  const Eigen::Vector3d axis = AxisOfAngles(leg);
  if (carrier == Carrier::kFixed)
    return is_first ? Angle_rad(state.direction, axis, leg.zero_direction) : state.length_m;
  if (carrier == Carrier::kLine)
    return is_first ? from_a.dot(leg.first_axis) : Angle_rad(state.direction, axis, leg.zero_direction);
  const double arm_angle = Angle_rad(from_a, axis, leg.zero_direction);
  return is_first ? arm_angle : Angle_rad(state.direction, axis, leg.zero_direction) - arm_angle;
}

// Speed of B along its circle (rad/s) or rail (m/s) from the velocity of C, u held by nothing:
// u . dC = (u . dB/dq) dq.
Row6 CarrierRow(const RobotLeg& leg, Carrier carrier, const LegState& state, const Matrix36& dc) {
  const double arm_m = carrier == Carrier::kCircle ? leg.arm_m : 1;
  return state.direction.transpose() * dc / (arm_m * state.direction.dot(state.free_direction));
}

// Of the rate at which a direction across the axis turns about it.
Row6 TurningRow(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction,
                const Matrix36& direction_rate) {
  return axis.cross(direction).transpose() * direction_rate;
}

// PRP, RRP: the point of the platform that is now at B keeps to the rail: across it, B moves as that point.
Row6 PlatformRailRow(const RobotLeg& leg, Carrier carrier, const LegState& state,
                     const Rigid3& base_from_platform) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(state.direction);
  const Eigen::Vector3d from_a = state.start_m - leg.base_joint_m;
  const Eigen::Vector3d start_by_joint =
      carrier == Carrier::kLine ? leg.first_axis : leg.first_axis.cross(from_a);
  Row6 carrier_row =
      across.transpose() *
      PlatformPointVelocity(state.start_m - leg.carried_offset_m - base_from_platform.translation) /
      across.dot(start_by_joint);
  if (leg.chain[0].is_actuated) return carrier_row;
  Row6 platform_turn = AxisOfAngles(leg).z() * Row6::Unit(5);
  if (carrier == Carrier::kLine) return platform_turn;
  return platform_turn - carrier_row;
}

Row6 TwoRailsRow(const RobotLeg& leg, const Matrix36& dc) {
  Eigen::Matrix2d rails;
  rails << leg.first_axis.head<2>(), leg.second_axis.head<2>();
  return rails.inverse().row(leg.chain[0].is_actuated ? 0 : 1) * dc.topRows<2>();
}

}  // namespace

Eigen::Matrix<double, 3, 6> PlatformPointVelocity(const Eigen::Vector3d& from_origin_m) {
  Matrix36 velocity;
  velocity << Eigen::Matrix3d::Identity(), -Skew(from_origin_m);
  return velocity;
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
  const Eigen::Vector3d c = base_from_platform * leg.platform_joint_m + leg.carried_offset_m;
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction == DirectionOf::kConstant) return StateOfTwoRails(leg, c);
  if (segment.direction == DirectionOf::kPlatform)
    return StateOnPlatformRail(leg, segment.carrier, c, base_from_platform);
  const auto reached = leg_geometry::Reach<double>(leg, segment, c);
  if (!(reached.reach > 0)) return std::nullopt;
  LegState state{reached.start_m,
                 c,
                 reached.along_m.normalized(),
                 reached.along_m.norm(),
                 reached.free_direction.normalized(),
                 0};
  if (std::abs(state.direction.dot(state.free_direction)) < kLeastSine) return std::nullopt;
  state.reading = ReadingOf(leg, segment.carrier, state) - leg.joint_offset;
  return state;
}

Eigen::Matrix<double, 3, 6> DirectionInteraction(const RobotLeg& leg, const LegState& state,
                                                 const Rigid3& base_from_platform) {
  Matrix36 interaction = Matrix36::Zero();
  switch (SeenSegmentOf(leg.chain).direction) {
    case DirectionOf::kConstant:
      break;
    case DirectionOf::kPlatform:
      interaction.rightCols<3>() = -Skew(state.direction);
      break;
    case DirectionOf::kLeg:
      interaction = leg_geometry::DirectionByPlatformJoint<double>(state.length_m * state.direction,
                                                                   state.free_direction) *
                    PlatformJointVelocity(leg, base_from_platform);
      break;
  }
  return interaction;
}

Eigen::Matrix<double, 1, 6> ReadingRow(const RobotLeg& leg, const LegState& state,
                                       const Rigid3& base_from_platform) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  const Matrix36 dc = PlatformJointVelocity(leg, base_from_platform);
  if (segment.direction == DirectionOf::kConstant) return TwoRailsRow(leg, dc);
  if (segment.direction == DirectionOf::kPlatform)
    return PlatformRailRow(leg, segment.carrier, state, base_from_platform);
  const bool is_first = leg.chain[0].is_actuated;
  if (segment.carrier == Carrier::kFixed && !is_first) return state.direction.transpose() * dc;
  if (segment.carrier != Carrier::kFixed && is_first) return CarrierRow(leg, segment.carrier, state, dc);
  Row6 turning =
      TurningRow(AxisOfAngles(leg), state.direction, DirectionInteraction(leg, state, base_from_platform));
  if (segment.carrier == Carrier::kCircle) return turning - CarrierRow(leg, segment.carrier, state, dc);
  return turning;
}

}  // namespace legible
