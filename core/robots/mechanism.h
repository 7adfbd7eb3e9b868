// The robots that a file can describe, behind what accuracy asks of them.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/robots/gough_stewart.h"
#include "core/robots/three_upu.h"

namespace legible {

using Mechanism = std::variant<GoughStewart, ThreeUpu>;

const std::string& NameOf(const Mechanism& mechanism);
const Rigid3& HomeOf(const Mechanism& mechanism);
int JointCountOf(const Mechanism& mechanism);

// Whether its platform can be there at all: that of a 3-UPU only translates.
bool CanTake(const Mechanism& mechanism, const Rigid3& base_from_platform);

// Both need a pose that the mechanism can take.
Eigen::VectorXd JointReadingsOf(const Mechanism& mechanism, const Rigid3& base_from_platform);  // m
FullInverseJacobian FullInverseJacobianOf(const Mechanism& mechanism, const Rigid3& base_from_platform);

std::vector<std::array<double, 2>> JointRangesOf(const Mechanism& mechanism);  // m

// Joints, from 0, whose readings (m) lie outside their ranges.
std::vector<int> JointsOutOfRange(const Mechanism& mechanism, const Eigen::VectorXd& readings_m);

// Whether the mechanism can take the pose with all joints in their ranges.
bool IsReachable(const Mechanism& mechanism, const Rigid3& base_from_platform);

// Joints and radii of the legs, to draw them and to bound where the platform can go.
struct LegShape {
  Eigen::Vector3d base_joint_m, platform_joint_m;
  double radius_m, joint_offset_m;
};
std::vector<LegShape> LegShapesOf(const Mechanism& mechanism);

}  // namespace legible
