// Parallel robots of many families by one description: a leg is a chain of joints with its lengths, the
// platform moves in one of five groups.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"
#include "core/robots/leg_chain.h"
#include "core/robots/three_upu.h"

namespace legible {

// Where the platform can go.
enum class PlatformMotion {
  kPlanarPoint,  // x, y: the legs meet in one point (five-bar)
  kPlanar,       // x, y and rotation about z
  kTranslation,  // x, y, z (Delta)
  kSchoenflies,  // x, y, z and rotation about z (Quattro)
  kSpatial,      // all six, less what RPS legs forbid
};

// "planar-point", "planar", "translation", "schoenflies", "spatial": as files have it.
const char* ToString(PlatformMotion motion);

// A leg from its base joint A over the start B of its seen segment to its platform joint C.
struct RobotLeg {
  LegChain chain;
  Eigen::Vector3d base_joint_m = Eigen::Vector3d::Zero();  // A, in base

  // Of the first joint where it is R (its axis) or P (its rail), unit, in base.
  Eigen::Vector3d first_axis = Eigen::Vector3d::UnitZ();
  // Unit, in base, where an R's angle is zero; across first_axis. RPR: the leg's direction then.
  Eigen::Vector3d zero_direction = Eigen::Vector3d::UnitX();
  // Of a second P, unit: PPR in base, PRP and RRP in platform.
  Eigen::Vector3d second_axis = Eigen::Vector3d::UnitY();

  double arm_m = 0;  // |AB| where the first joint is R
  double rod_m = 0;  // |BC| where the seen segment's length is constant
  // Which of the two solutions of the inverse kinematics: that with the arm turned further about first_axis
  // than towards C, or with B further along the rail, is 1; the other -1.
  int working_mode = 1;

  Eigen::Vector3d platform_joint_m = Eigen::Vector3d::Zero();  // C, in platform: what turns with it
  // An articulated platform carries the rest of C without turning it, in base.
  Eigen::Vector3d carried_offset_m = Eigen::Vector3d::Zero();
  double joint_offset = 0;  // m or rad: length, position or angle = joint reading + joint_offset
  std::optional<std::array<double, 2>> joint_range;  // least and largest reading, m or rad
  double radius_m = 0;                               // of the seen segment
};

// Which of its fields a RobotLeg of a chain has; the others mean nothing.
struct LegFields {
  bool first_axis = false;  // else an R that comes first turns about z or -z
  bool zero_direction = false;
  bool second_axis = false;
  bool arm_m = false;
  bool rod_m = false;
  bool working_mode = false;
};

// Throws as SeenSegmentOf does.
LegFields FieldsOf(const LegChain& chain);

struct ParallelRobot {
  std::string name;
  PlatformMotion motion = PlatformMotion::kSpatial;
  Rigid3 home;  // base_from_platform where forward kinematics starts
  std::vector<RobotLeg> legs;
};

// Throws std::invalid_argument, which names the leg and the field, where an axis is not a unit vector, a
// length not positive, a chain not of the kinds known or not one that the platform's motion allows, where a
// planar robot's leg leaves the plane z = constant, and where the home of a platform that turns about z alone
// is tilted.
void Check(const ParallelRobot& robot);

// The same of one leg of a robot with this motion and home; names the field alone.
void CheckLeg(const ParallelRobot& robot, const RobotLeg& leg);

// The same robots, for what is said of robots of every family.
ParallelRobot ParallelRobotOf(const GoughStewart& robot);
ParallelRobot ParallelRobotOf(const ThreeUpu& robot);

// The other way round, where the robot has six UPS legs whose lengths are actuated and moves in space. Joints
// without a range get an empty one.
std::optional<GoughStewart> GoughStewartOf(const ParallelRobot& robot);

}  // namespace legible
