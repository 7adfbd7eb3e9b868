#include "datasets/three_upu_file.h"

#include <fmt/format.h>

#include "datasets/leg_yaml.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

constexpr char kKind[] = "3-upu";

UpuLeg LegFromYaml(const YamlValue& section) {
  section.AllowKeys(
      {"base_joint_m", "platform_joint_m", "outer_axis", "radius_m", "joint_offset_m", "joint_range_m"});
  UpuLeg leg;
  leg.base_joint_m = JointFromYaml(section.Get("base_joint_m"));
  leg.platform_joint_m = JointFromYaml(section.Get("platform_joint_m"));
  leg.outer_axis = AxisFromYaml(section.Get("outer_axis"));
  leg.radius_m = section.Get("radius_m").PositiveNumber();
  if (const auto offset = section.Find("joint_offset_m")) leg.joint_offset_m = offset->Number();
  leg.joint_range_m = JointRangeFromYaml(section.Get("joint_range_m"));
  DemandLongerThanThick(section, leg.joint_range_m[0] + leg.joint_offset_m, leg.radius_m);
  return leg;
}

}  // namespace

bool HoldsThreeUpu(const std::filesystem::path& file) {
  const std::optional<YamlValue> kind = YamlValue::LoadFile(file).Find("robot");
  return kind && !kind->IsMap() && !kind->IsNull() && kind->Text() == kKind;
}

ThreeUpu ReadThreeUpu(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::LoadFile(file);
  root.AllowKeys({"robot", "name", "home", "legs"});
  ThreeUpu robot;
  if (const auto name = root.Find("name")) robot.name = name->Text();
  const YamlValue home = root.Get("home");
  robot.home = home.Rigid();
  if (VectorFromRotation(robot.home.rotation).norm() > 1e-9)
    home.Fail("is turned", "give a 3-UPU's home as a translation: rotation_xyzw: [0, 0, 0, 1]");
  const std::vector<YamlValue> legs = root.Get("legs").List(kUpuLegCount);
  for (size_t i = 0; i < kUpuLegCount; ++i) robot.legs[i] = LegFromYaml(legs[i]);
  return robot;
}

}  // namespace legible
