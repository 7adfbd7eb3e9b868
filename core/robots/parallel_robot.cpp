#include "core/robots/parallel_robot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace legible {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kSamePlane_m = 1e-9;

[[noreturn]] void Throw(const std::string& what) { throw std::invalid_argument(what); }

void CheckUnit(const std::string& name, const Eigen::Vector3d& axis) {
  if (!(std::abs(axis.norm() - 1) < kUnitTolerance)) Throw(name + " is no unit vector");
}

void CheckInPlane(const std::string& name, const Eigen::Vector3d& axis) {
  if (!(std::abs(axis.z()) < kUnitTolerance)) Throw(name + " leaves the plane that the platform moves in");
}

bool IsPlanar(PlatformMotion motion) {
  return motion == PlatformMotion::kPlanarPoint || motion == PlatformMotion::kPlanar;
}

LegFields FieldsOfLeg(const RobotLeg& leg) {
  try {
    return FieldsOf(leg.chain);
  } catch (const std::invalid_argument& error) {
    Throw(std::string("chain: ") + error.what());
  }
}

void CheckChain(PlatformMotion motion, const LegChain& chain) {
  const bool is_planar = IsPlanar(chain);
  if (IsPlanar(motion) == is_planar) return;
  Throw("chain: a leg " + ToText(chain) +
        (is_planar ? " belongs to a planar robot" : " does not move in a plane"));
}

// What a leg takes from the platform has to be what the platform's motion leaves out.
void CheckEnds(PlatformMotion motion, const LegChain& chain) {
  if (motion == PlatformMotion::kSpatial && chain.back().type != JointType::kSpherical)
    Throw("chain: a leg " + ToText(chain) + " takes a rotation from a spatial platform: it has to end in S");
  const bool is_in_plane =
      chain.front().type == JointType::kRevolute && SeenSegmentOf(chain).carrier == Carrier::kFixed;
  if (motion != PlatformMotion::kSpatial && !IsPlanar(motion) && is_in_plane)
    Throw("chain: a leg " + ToText(chain) +
          " keeps its platform joint in a plane, which this platform's motion does not");
}

void CheckAxes(const RobotLeg& leg, const LegFields& fields) {
  if (fields.first_axis) CheckUnit("first_axis", leg.first_axis);
  if (fields.second_axis) CheckUnit("second_axis", leg.second_axis);
  if (!fields.zero_direction) return;
  CheckUnit("zero_direction", leg.zero_direction);
  const bool turns_about_first_axis = !IsPlanar(leg.chain);
  if (turns_about_first_axis && !(std::abs(leg.first_axis.dot(leg.zero_direction)) < kUnitTolerance))
    Throw("zero_direction does not lie across first_axis");
}

void CheckPlanar(const Rigid3& home, const RobotLeg& leg, const LegFields& fields) {
  if (fields.first_axis) CheckInPlane("first_axis", leg.first_axis);
  if (fields.second_axis) CheckInPlane("second_axis", leg.second_axis);
  if (fields.zero_direction) CheckInPlane("zero_direction", leg.zero_direction);
  const bool turns_first = leg.chain.front().type == JointType::kRevolute;
  const Eigen::Vector3d z(0, 0, leg.first_axis.z() > 0 ? 1 : -1);
  if (turns_first && !((leg.first_axis - z).norm() < kUnitTolerance))
    Throw("first_axis has to be z or -z where a planar leg begins with an R");
  const Eigen::Vector3d platform_joint_m = home * leg.platform_joint_m + leg.carried_offset_m;
  if (!(std::abs(platform_joint_m.z() - leg.base_joint_m.z()) < kSamePlane_m))
    Throw("base_joint_m is not in the plane of the platform's joint, which has z = " +
          std::to_string(platform_joint_m.z()) + " m");
}

// What turns about z alone is not tilted at home either.
void CheckHome(const ParallelRobot& robot) {
  if (robot.motion == PlatformMotion::kTranslation || robot.motion == PlatformMotion::kSpatial) return;
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if (!((robot.home.rotation * z - z).norm() < kUnitTolerance))
    Throw("home is tilted: this platform turns about z alone");
}

void CheckLengths(const RobotLeg& leg, const LegFields& fields) {
  if (fields.arm_m && !(leg.arm_m > 0)) Throw("arm_m has to be positive");
  if (fields.rod_m && !(leg.rod_m > 0)) Throw("rod_m has to be positive");
  if (leg.working_mode != 1 && leg.working_mode != -1) Throw("working_mode has to be 1 or -1");
}

// Of a robot whose legs extend between two joints.
template <typename LegOfRobot>
RobotLeg ExtensibleLeg(const char* chain, const LegOfRobot& leg) {
  RobotLeg it;
  it.chain = ChainFromText(chain);
  it.base_joint_m = leg.base_joint_m;
  it.platform_joint_m = leg.platform_joint_m;
  it.joint_offset = leg.joint_offset_m;
  it.joint_range = leg.joint_range_m;
  it.radius_m = leg.radius_m;
  return it;
}

}  // namespace

const char* ToString(PlatformMotion motion) {
  switch (motion) {
    case PlatformMotion::kPlanarPoint:
      return "planar-point";
    case PlatformMotion::kPlanar:
      return "planar";
    case PlatformMotion::kTranslation:
      return "translation";
    case PlatformMotion::kSchoenflies:
      return "schoenflies";
    case PlatformMotion::kSpatial:
      break;
  }
  return "spatial";
}

LegFields FieldsOf(const LegChain& chain) {
  const SeenSegment segment = SeenSegmentOf(chain);
  const bool has_arm = segment.carrier == Carrier::kCircle;
  const bool starts_on_rail = chain.front().type == JointType::kPrismatic;
  const bool starts_with_revolute = chain.front().type == JointType::kRevolute;
  LegFields fields;
  fields.first_axis = starts_on_rail || (starts_with_revolute && !IsPlanar(chain));
  fields.zero_direction = has_arm || ReadsAngle(chain);
  fields.second_axis = segment.direction != DirectionOf::kLeg;
  fields.arm_m = has_arm;
  fields.rod_m = !segment.extends;
  fields.working_mode = has_arm || fields.rod_m;
  return fields;
}

void CheckLeg(const ParallelRobot& robot, const RobotLeg& leg) {
  const LegFields fields = FieldsOfLeg(leg);
  CheckChain(robot.motion, leg.chain);
  CheckEnds(robot.motion, leg.chain);
  CheckAxes(leg, fields);
  if (IsPlanar(robot.motion)) CheckPlanar(robot.home, leg, fields);
  CheckLengths(leg, fields);
}

void Check(const ParallelRobot& robot) {
  CheckHome(robot);
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    try {
      CheckLeg(robot, robot.legs[i]);
    } catch (const std::invalid_argument& error) {
      Throw("legs[" + std::to_string(i + 1) + "]." + error.what());
    }
  }
}

ParallelRobot ParallelRobotOf(const GoughStewart& robot) {
  ParallelRobot general{robot.name, PlatformMotion::kSpatial, robot.home, {}};
  for (const Leg& leg : robot.legs) general.legs.push_back(ExtensibleLeg("U_PS", leg));
  return general;
}

ParallelRobot ParallelRobotOf(const ThreeUpu& robot) {
  ParallelRobot general{robot.name, PlatformMotion::kTranslation, robot.home, {}};
  for (const UpuLeg& leg : robot.legs) general.legs.push_back(ExtensibleLeg("U_PU", leg));
  return general;
}

std::optional<GoughStewart> GoughStewartOf(const ParallelRobot& robot) {
  const LegChain ups = ChainFromText("U_PS");
  const bool has_ups = std::all_of(robot.legs.begin(), robot.legs.end(),
                                   [&](const RobotLeg& leg) { return leg.chain == ups; });
  if (robot.motion != PlatformMotion::kSpatial || robot.legs.size() != kLegCount || !has_ups)
    return std::nullopt;
  GoughStewart hexapod{robot.name, robot.home, {}};
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    const RobotLeg& leg = robot.legs[i];
    hexapod.legs[i] = {leg.base_joint_m - leg.carried_offset_m, leg.platform_joint_m, leg.radius_m,
                       leg.joint_offset, leg.joint_range.value_or(std::array<double, 2>{})};
  }
  return hexapod;
}

}  // namespace legible
