// The 3-UPU: three extensible legs, each between two universal joints whose outer axes are parallel, so that
// the platform translates (Tsai 1996) as long as the legs' constraints hold its orientation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "core/geometry/rigid3.h"
#include "core/robots/full_inverse_jacobian.h"

namespace legible {

inline constexpr int kUpuLegCount = 3;

struct UpuLeg {
  Eigen::Vector3d base_joint_m = Eigen::Vector3d::Zero();      // A, in base
  Eigen::Vector3d platform_joint_m = Eigen::Vector3d::Zero();  // B, in platform
  // u, unit: of the axis fixed in the base, in base; the one fixed in the platform is the same in platform.
  Eigen::Vector3d outer_axis = Eigen::Vector3d::UnitX();
  double radius_m = 0;
  double joint_offset_m = 0;                     // leg length = joint reading + joint_offset_m
  std::array<double, 2> joint_range_m = {0, 0};  // shortest and longest joint reading
};

struct ThreeUpu {
  std::string name;
  Rigid3 home;  // base_from_platform, a translation
  std::array<UpuLeg, kUpuLegCount> legs;
};

// Joint readings |B_i - A_i| - offset_i (m) with the platform, parallel to the base, at translation_m.
Eigen::Vector3d InverseKinematics(const ThreeUpu& robot, const Eigen::Vector3d& translation_m);

// Its 6 x 6 matrix (Merlet 2006, eq. 9): three rows (n, CB x n) of the legs' speeds, and three rows (0, s), s
// = u x v the unit normal of both axes of the universal joint: no leg lets the platform turn about its s. v,
// the inner axis, lies across u and the leg. A leg along its own outer axis leaves v open: its row is zero,
// the matrix singular.
FullInverseJacobian FullInverseJacobianOf(const ThreeUpu& robot, const Eigen::Vector3d& translation_m);

}  // namespace legible
