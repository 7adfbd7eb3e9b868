// Where the platform of a parallel robot can go.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

// Of the six coordinates (v, omega) of a twist in base, from 0, those that the motion has.
std::vector<int> FreeCoordinates(PlatformMotion motion);

// The robot's RPS legs, each of which keeps its platform joint in the plane through A across the axis of its
// R.
std::vector<const RobotLeg*> LegsKeptInPlanes(const ParallelRobot& robot);

// Twists of the platform's origin that the motion allows at the pose, orthonormal columns (v, omega) in base,
// 6 x dof. Of RPS legs each takes one away.
Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasis(const ParallelRobot& robot,
                                                     const Rigid3& base_from_platform);

// The same motion by twists that are orthonormal with lengths in units of size_m.
Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasisInSize(const ParallelRobot& robot,
                                                           const Rigid3& base_from_platform, double size_m);

// Whether the pose is one that the motion allows, to so many m and rad.
bool CanTake(const ParallelRobot& robot, const Rigid3& base_from_platform, double tolerance = 1e-9);

// A pose that RPS legs allow near to the given one, the nearest in first order; any other robot's is left as
// it is.
Rigid3 BackToMotion(const ParallelRobot& robot, const Rigid3& base_from_platform);

}  // namespace legible
