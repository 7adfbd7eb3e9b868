#include "core/robots/mechanism.h"

namespace legible {
namespace {

constexpr double kNoTurn_rad = 1e-9;

}  // namespace

const std::string& NameOf(const Mechanism& mechanism) {
  return std::visit([](const auto& robot) -> const std::string& { return robot.name; }, mechanism);
}

const Rigid3& HomeOf(const Mechanism& mechanism) {
  return std::visit([](const auto& robot) -> const Rigid3& { return robot.home; }, mechanism);
}

int JointCountOf(const Mechanism& mechanism) {
  return std::visit([](const auto& robot) { return static_cast<int>(robot.legs.size()); }, mechanism);
}

bool CanTake(const Mechanism& mechanism, const Rigid3& base_from_platform) {
  return std::holds_alternative<GoughStewart>(mechanism) ||
         VectorFromRotation(base_from_platform.rotation).norm() < kNoTurn_rad;
}

Eigen::VectorXd JointReadingsOf(const Mechanism& mechanism, const Rigid3& base_from_platform) {
  if (const auto* hexapod = std::get_if<GoughStewart>(&mechanism))
    return InverseKinematics(*hexapod, base_from_platform);
  return InverseKinematics(std::get<ThreeUpu>(mechanism), base_from_platform.translation);
}

FullInverseJacobian FullInverseJacobianOf(const Mechanism& mechanism, const Rigid3& base_from_platform) {
  if (const auto* hexapod = std::get_if<GoughStewart>(&mechanism))
    return FullInverseJacobianOf(*hexapod, base_from_platform);
  return FullInverseJacobianOf(std::get<ThreeUpu>(mechanism), base_from_platform.translation);
}

std::vector<std::array<double, 2>> JointRangesOf(const Mechanism& mechanism) {
  return std::visit(
      [](const auto& robot) {
        std::vector<std::array<double, 2>> ranges;
        for (const auto& leg : robot.legs) ranges.push_back(leg.joint_range_m);
        return ranges;
      },
      mechanism);
}

std::vector<int> JointsOutOfRange(const Mechanism& mechanism, const Eigen::VectorXd& readings_m) {
  std::vector<int> joints;
  const auto ranges = JointRangesOf(mechanism);
  for (size_t i = 0; i < ranges.size(); ++i) {
    const double reading_m = readings_m[static_cast<Eigen::Index>(i)];
    if (reading_m < ranges[i][0] || reading_m > ranges[i][1]) joints.push_back(static_cast<int>(i));
  }
  return joints;
}

bool IsReachable(const Mechanism& mechanism, const Rigid3& base_from_platform) {
  return CanTake(mechanism, base_from_platform) &&
         JointsOutOfRange(mechanism, JointReadingsOf(mechanism, base_from_platform)).empty();
}

std::vector<LegShape> LegShapesOf(const Mechanism& mechanism) {
  return std::visit(
      [](const auto& robot) {
        std::vector<LegShape> shapes;
        for (const auto& leg : robot.legs)
          shapes.push_back({leg.base_joint_m, leg.platform_joint_m, leg.radius_m, leg.joint_offset_m});
        return shapes;
      },
      mechanism);
}

}  // namespace legible
