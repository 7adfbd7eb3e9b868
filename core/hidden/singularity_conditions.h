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
  // held as the platform needs and their chains have a known condition; else nothing.
  std::optional<double> geometric;
  // Smallest singular value of what is held by the platform's twist, lengths in the robot's size, of the
  // largest.
  double matrix = 0;
};

// Hidden robot (Briot et al. 2016, section 4), t_i the direction in which C_i moves with u_i held:
//   planar: the normals of the t_i in the C_i meet in a point; two legs: t_1 is parallel to t_2;
//   translation: t_1 is parallel to t_2;
//   Schoenflies: t_1, t_2 and the way that C_1 - C_2 turns are in one plane (the paper names the part of this
//     where t_1 and t_2 are parallel);
//   spatial: the three planes through C_i normal to t_i and the plane of the C_i meet in a point.
// Real robot, held along u_i, for legs whose first joint, or whose leg's length, is actuated: planar: the
// lines along u_i meet; translation: the u_i are in one plane; otherwise the lines' coordinates are
// dependent. Nothing where a leg does not reach the pose. Legs from 0; those of the real robot are all of
// them.
std::optional<Type2Measure> Type2MeasureOf(const ParallelRobot& robot, RobotKind kind,
                                           const std::vector<int>& legs, const Rigid3& base_from_platform);

// Type 1, of the real and the hidden robot alike: |u . t| of the leg least far from being stretched or
// folded, 0 where it is; 1 for legs that only extend. Nothing where a leg does not reach the pose.
std::optional<double> Type1MeasureOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                     const Rigid3& base_from_platform);

// Mean distance of the base joints from the platform's origin, m.
double SizeOf_m(const ParallelRobot& robot, const Rigid3& base_from_platform);

}  // namespace legible
