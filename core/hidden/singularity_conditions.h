// Where a robot is singular, by geometry (lines that meet, planes that share a point) and by its matrices.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

enum class RobotKind {
  kReal,    // its actuated joints are held
  kHidden,  // the directions of the seen legs are held
};

// Type 2: the platform moves though everything actuated is held.
struct Type2Measure {
  // Zero in a singularity and of another sign on its other side; dimensionless. Only where as many legs are
  // held as the platform needs; else nothing.
  std::optional<double> geometric;
  // Smallest singular value of what is held by the platform's twist, lengths in the robot's size, of the
  // largest.
  double matrix = 0;
};

// Hidden robot (Briot et al. 2016, section 4), t_i the direction in which C_i moves with u_i held:
//   planar: the normals of the t_i in the C_i meet in a point; two legs: t_1 is parallel to t_2. A leg whose
//     direction is the platform's (PRP, RRP) has the line at infinity for a normal;
//   translation: t_1 is parallel to t_2;
//   Schoenflies: t_1, t_2 and the way that C_1 - C_2 turns are in one plane (the paper names the part of this
//     where t_1 and t_2 are parallel);
//   spatial: the three planes through C_i normal to t_i and the plane of the C_i meet in a point. All RPS
//     legs have to be seen.
// Real robot: the lines along which the actuated joints hold the platform, and those along the axes of RPS
// legs' R through C_i, are dependent: planar: they meet in a point; translation: they are in one plane.
// Of these lines (leg_geometry.h, HeldByJoint):
//   along u_i where the first joint that moves B, or the leg's length, is actuated;
//   through C_i across the leg where its first R is (RPR, RPS), across the rail of P_RR, along A_i C_i of
//     R_RR, across the passive rail of PPR;
//   across the platform's rail, through B_i of _PRP and _RRP and through A_i of R_RP; at infinity of P_RP.
// Nothing where a leg does not reach the pose. Legs from 0; those of the real robot are all of them.
std::optional<Type2Measure> Type2MeasureOf(const ParallelRobot& robot, RobotKind kind,
                                           const std::vector<int>& legs, const Rigid3& base_from_platform);

// Type 1, of the real and the hidden robot alike: |u . t| of the leg least far from being stretched or
// folded, 0 where it is; 1 for legs that only extend. Of a rail that is fixed in the platform the sine with
// the first joint's rail or the cosine with its arm, of two rails the sine between them. Nothing where a leg
// does not reach the pose.
std::optional<double> Type1MeasureOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                     const Rigid3& base_from_platform);

// Mean distance of the base joints from the platform's origin, m.
double SizeOf_m(const ParallelRobot& robot, const Rigid3& base_from_platform);

}  // namespace legible
