#include "datasets/parallel_robot_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "datasets/leg_yaml.h"
#include "datasets/model_file.h"
#include "datasets/three_upu_file.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

PlatformMotion MotionFromYaml(const YamlValue& section) {
  const std::string name = section.Text();
  using enum PlatformMotion;
  for (const PlatformMotion motion : {kPlanarPoint, kPlanar, kTranslation, kSchoenflies, kSpatial})
    if (name == ToString(motion)) return motion;
  section.Fail(fmt::format("is \"{}\", no motion of a platform", name),
               "give planar-point, planar, translation, schoenflies or spatial");
}

LegChain ChainFromYaml(const YamlValue& section) {
  try {
    LegChain chain = ChainFromText(section.Text());
    SeenSegmentOf(chain);
    return chain;
  } catch (const std::invalid_argument& error) {
    section.Fail(fmt::format("cannot be: {}", error.what()), "write it as \"R_PR\" or \"_R-{2-US}\"");
  }
}

std::string WithUnit(const std::string& reading_key, bool is_angle) {
  return reading_key + (is_angle ? "_rad" : "_m");
}

// The keys that not every chain has, and whether this one has them.
std::vector<std::pair<std::string, bool>> KeysOfSomeChains(const LegChain& chain) {
  const LegFields fields = FieldsOf(chain);
  std::vector<std::pair<std::string, bool>> keys = {{"first_axis", fields.first_axis},
                                                    {"zero_direction", fields.zero_direction},
                                                    {"second_axis", fields.second_axis},
                                                    {"arm_m", fields.arm_m},
                                                    {"rod_m", fields.rod_m},
                                                    {"working_mode", fields.working_mode}};
  for (const char* key : {"joint_offset", "joint_range"})
    for (const bool is_angle : {false, true})
      keys.emplace_back(WithUnit(key, is_angle), is_angle == ReadsAngle(chain));
  return keys;
}

void DemandKeysOf(const LegChain& chain, const YamlValue& section) {
  std::vector<std::string> known = {"chain", "base_joint_m", "platform_joint_m", "carried_offset_m",
                                    "radius_m"};
  std::vector<std::string> own;
  const auto keys = KeysOfSomeChains(chain);
  for (const auto& [key, is_own] : keys) {
    known.push_back(key);
    if (is_own) own.push_back(key);
  }
  section.AllowKeys(known);
  for (const auto& [key, is_own] : keys) {
    const auto value = section.Find(key);
    if (value && !is_own)
      value->Fail(fmt::format("is nothing that a leg {} has", ToText(chain)),
                  fmt::format("take it out, or give one of {}", fmt::join(own, ", ")));
  }
}

void DemandThin(const YamlValue& section, const RobotLeg& leg) {
  if (leg.rod_m > 0 && leg.radius_m >= leg.rod_m)
    section.Get("radius_m")
        .Fail(fmt::format("is {}, not less than rod_m", leg.radius_m),
              "give lengths in metres, with the rod longer than it is thick");
  const bool reads_length = SeenSegmentOf(leg.chain).carrier == Carrier::kFixed && !ReadsAngle(leg.chain);
  if (reads_length && leg.joint_range)
    DemandLongerThanThick(section, (*leg.joint_range)[0] + leg.joint_offset, leg.radius_m);
}

RobotLeg LegFromYaml(const YamlValue& section) {
  RobotLeg leg;
  leg.chain = ChainFromYaml(section.Get("chain"));
  DemandKeysOf(leg.chain, section);
  const LegFields fields = FieldsOf(leg.chain);
  leg.base_joint_m = JointFromYaml(section.Get("base_joint_m"));
  if (const auto joint = section.Find("platform_joint_m")) leg.platform_joint_m = JointFromYaml(*joint);
  if (const auto offset = section.Find("carried_offset_m")) leg.carried_offset_m = JointFromYaml(*offset);
  if (fields.first_axis) leg.first_axis = AxisFromYaml(section.Get("first_axis"));
  if (fields.zero_direction) leg.zero_direction = AxisFromYaml(section.Get("zero_direction"));
  if (fields.second_axis) leg.second_axis = AxisFromYaml(section.Get("second_axis"));
  if (fields.arm_m) leg.arm_m = section.Get("arm_m").PositiveNumber();
  if (fields.rod_m) leg.rod_m = section.Get("rod_m").PositiveNumber();
  if (const auto mode = section.Find("working_mode")) leg.working_mode = mode->Integer();
  const bool is_angle = ReadsAngle(leg.chain);
  if (const auto offset = section.Find(WithUnit("joint_offset", is_angle)))
    leg.joint_offset = offset->Number();
  if (const auto range = section.Find(WithUnit("joint_range", is_angle)))
    leg.joint_range = JointRangeFromYaml(*range);
  if (const auto radius = section.Find("radius_m")) leg.radius_m = radius->PositiveNumber();
  DemandThin(section, leg);
  return leg;
}

void DemandLegOf(const ParallelRobot& robot, const RobotLeg& leg, const YamlValue& section) {
  try {
    CheckLeg(robot, leg);
  } catch (const std::invalid_argument& error) {
    section.Fail(fmt::format("is no leg of this robot: {}", error.what()),
                 "mend that field, or the robot's platform and home");
  }
}

// Before there are legs, of which DemandLegOf says what is wrong.
void DemandUprightHome(const ParallelRobot& robot, const YamlValue& home) {
  try {
    Check(robot);
  } catch (const std::invalid_argument& error) {
    home.Fail(fmt::format("cannot be: {}", error.what()), "give a rotation_xyzw whose x and y are 0");
  }
}

void DemandReachedHome(const ParallelRobot& robot, const YamlValue& home) {
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    if (!StateOf(robot.legs[i], robot.home))
      home.Fail(fmt::format("is a pose that legs[{}] does not reach", i + 1),
                "give one that every leg reaches, or mend that leg");
  }
  if (!CanTake(robot, robot.home))
    home.Fail("is a pose that the R joints of its legs do not allow",
              "give one with every platform joint in the plane through its base joint across first_axis");
}

void DemandEnoughLegs(const ParallelRobot& robot, const YamlValue& legs) {
  const auto freedoms = static_cast<size_t>(MotionBasis(robot, robot.home).cols());
  if (freedoms == 0)
    legs.Fail("leave the platform no freedom: every RPS leg takes one of six", "give fewer RPS legs");
  if (robot.legs.size() < freedoms)
    legs.Fail(fmt::format("has {} values for the {} freedoms of the platform", robot.legs.size(), freedoms),
              "give at least one leg a freedom");
}

ParallelRobot RobotFromLegs(const YamlValue& root) {
  root.AllowKeys({"robot", "name", "platform", "home", "legs"});
  ParallelRobot robot;
  if (const auto name = root.Find("name")) robot.name = name->Text();
  robot.motion = MotionFromYaml(root.Get("platform"));
  robot.home = root.Get("home").Rigid();
  DemandUprightHome(robot, root.Get("home"));
  const YamlValue legs = root.Get("legs");
  for (const YamlValue& section : legs.List()) {
    robot.legs.push_back(LegFromYaml(section));
    DemandLegOf(robot, robot.legs.back(), section);
  }
  DemandReachedHome(robot, root.Get("home"));
  DemandEnoughLegs(robot, legs);
  return robot;
}

}  // namespace

ParallelRobot ReadParallelRobot(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::LoadFile(file);
  const YamlValue kind = root.Get("robot");
  if (HoldsModel(file)) return ParallelRobotOf(ReadModel(file).robot);
  if (HoldsThreeUpu(file)) return ParallelRobotOf(ReadThreeUpu(file));
  if (kind.Text() != "parallel")
    kind.Fail(fmt::format("is \"{}\", a mechanism not known here", kind.Text()),
              "give parallel, gough-stewart or 3-upu");
  return RobotFromLegs(root);
}

}  // namespace legible
