#include "datasets/robot_file.h"

#include <fmt/format.h>

#include "datasets/atomic_file.h"
#include "datasets/leg_yaml.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

Leg LegFromYaml(const YamlValue& section) {
  section.AllowKeys({"base_joint_m", "platform_joint_m", "radius_m", "joint_offset_m", "joint_range_m"});
  Leg leg;
  leg.base_joint_m = JointFromYaml(section.Get("base_joint_m"));
  leg.platform_joint_m = JointFromYaml(section.Get("platform_joint_m"));
  leg.radius_m = section.Get("radius_m").PositiveNumber();
  if (const auto offset = section.Find("joint_offset_m")) leg.joint_offset_m = offset->Number();
  leg.joint_range_m = JointRangeFromYaml(section.Get("joint_range_m"));
  DemandLongerThanThick(section, leg.joint_range_m[0] + leg.joint_offset_m, leg.radius_m);
  return leg;
}

void DemandDistinctLegs(const std::array<Leg, kLegCount>& legs, const std::vector<YamlValue>& sections) {
  for (int i = 0; i < kLegCount; ++i) {
    for (int j = 0; j < i; ++j) {
      if (legs[i].base_joint_m == legs[j].base_joint_m &&
          legs[i].platform_joint_m == legs[j].platform_joint_m) {
        sections[i].Fail(fmt::format("has the same joints as legs[{}]", j + 1), "give each leg its own");
      }
    }
  }
}

std::string LegToYaml(const Leg& leg) {
  return fmt::format(
      "  - {{base_joint_m: {}, platform_joint_m: {},\n"
      "     radius_m: {}, joint_offset_m: {}, joint_range_m: {}}}\n",
      ListText(leg.base_joint_m), ListText(leg.platform_joint_m), NumberText(leg.radius_m),
      NumberText(leg.joint_offset_m), ListText(leg.joint_range_m.data(), 2));
}

}  // namespace

GoughStewart RobotFromYaml(const YamlValue& section) {
  section.AllowKeys({"robot", "name", "home", "legs"});
  const YamlValue kind = section.Get("robot");
  if (kind.Text() != "gough-stewart") {
    kind.Fail(fmt::format("is \"{}\", a mechanism not known here", kind.Text()), "give gough-stewart");
  }
  GoughStewart robot;
  if (const auto name = section.Find("name")) robot.name = name->Text();
  robot.home = section.Get("home").Rigid();
  const std::vector<YamlValue> legs = section.Get("legs").List(kLegCount);
  for (int i = 0; i < kLegCount; ++i) robot.legs[i] = LegFromYaml(legs[i]);
  DemandDistinctLegs(robot.legs, legs);
  return robot;
}

std::string RobotToYaml(const GoughStewart& robot) {
  std::string text = fmt::format(
      "robot: gough-stewart\n"
      "name: {}\n"
      "home: {}  # base_from_platform, where forward kinematics starts\n"
      "legs:  # leg length = joint reading + joint_offset_m\n",
      QuotedText(robot.name), RigidText(robot.home));
  for (const Leg& leg : robot.legs) text += LegToYaml(leg);
  return text;
}

GoughStewart ReadRobot(const std::filesystem::path& file) { return RobotFromYaml(YamlValue::LoadFile(file)); }

void WriteRobot(const std::filesystem::path& file, const GoughStewart& robot) {
  WriteFileAtomically(file, RobotToYaml(robot));
}

}  // namespace legible
