#include "datasets/leg_yaml.h"

#include <fmt/format.h>

namespace legible {

namespace {

constexpr double kFarthestJoint_m = 30;  // from its frame's origin: beyond any hexapod; a small one's in mm

}  // namespace

Eigen::Vector3d JointFromYaml(const YamlValue& section) {
  Eigen::Vector3d joint = section.Vector3();
  if (joint.norm() > kFarthestJoint_m)
    section.Fail(fmt::format("is {:.4g} m from the origin of its frame", joint.norm()),
                 "give lengths in metres, not in millimetres");
  return joint;
}

Eigen::Vector3d AxisFromYaml(const YamlValue& section) {
  const Eigen::Vector3d axis = section.Vector3();
  if (!(axis.norm() > 0)) section.Fail("has no direction", "give the axis as [x, y, z]");
  return axis.normalized();
}

std::array<double, 2> JointRangeFromYaml(const YamlValue& section) {
  const std::vector<double> range = section.Numbers(2);
  if (range[0] >= range[1]) {
    section.Fail(fmt::format("is [{}, {}], reversed or empty", range[0], range[1]), "give [least, largest]");
  }
  return {range[0], range[1]};
}

void DemandLongerThanThick(const YamlValue& section, double shortest_m, double radius_m) {
  if (shortest_m > radius_m) return;
  section.Fail(
      fmt::format("has a shortest length (joint_range_m[1] + joint_offset_m) of {} m and a radius of {} m",
                  shortest_m, radius_m),
      "give lengths in metres, with the leg longer than it is thick");
}

}  // namespace legible
