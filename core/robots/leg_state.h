// A leg of a parallel robot at a pose, and how it moves with the platform.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

// A leg at a pose.
struct LegState {
  Eigen::Vector3d start_m;           // B, in base
  Eigen::Vector3d platform_joint_m;  // C, in base
  Eigen::Vector3d direction;         // u, unit, of the seen segment towards the platform, in base
  double length_m = 0;               // |BC|; 0 where the segment's direction is not the leg's (PPR, PRP, RRP)
  // Unit, in base: along it C moves while u is held: the tangent of the leg's vertex space. Along u itself
  // where the segment only extends. Unused where the direction is not the leg's.
  Eigen::Vector3d free_direction;
  double reading = 0;  // of the actuated joint, m or rad
};

// Nothing where the leg does not reach the pose, or reaches it only stretched, folded or otherwise singular
// (Type 1).
std::optional<LegState> StateOf(const RobotLeg& leg, const Rigid3& base_from_platform);

// Of these legs (from 0), in this order; nothing where one does not reach the pose.
std::optional<std::vector<LegState>> StatesOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                              const Rigid3& base_from_platform);

// Velocity of a point that turns with the platform, 3 x 6, by the twist (v, omega) of the platform's origin;
// all in base, the point from the origin.
Eigen::Matrix<double, 3, 6> PlatformPointVelocity(const Eigen::Vector3d& from_origin_m);

// du/dt = matrix * twist, the leg's interaction matrix M_i^T (Briot et al. 2016, eq. 7, B.14), 3 x 6, twist
// (v, omega) of the platform's origin, all in base. With t the free direction:
//   M_i^T = (I - t u^T / (u^T t)) dC / |BC|.
Eigen::Matrix<double, 3, 6> DirectionInteraction(const RobotLeg& leg, const LegState& state,
                                                 const Rigid3& base_from_platform);

// Speed of the actuated joint, m/s or rad/s, from the twist as above.
Eigen::Matrix<double, 1, 6> ReadingRow(const RobotLeg& leg, const LegState& state,
                                       const Rigid3& base_from_platform);

}  // namespace legible
