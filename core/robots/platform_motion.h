// Where the platform of a parallel robot can go.
#pragma once

#include <Eigen/Core>

#include "core/robots/parallel_robot.h"

namespace legible {

// Twists of the platform's origin that the motion allows at the pose, orthonormal columns (v, omega) in base,
// 6 x dof. Of RPS legs each takes one away.
Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasis(const ParallelRobot& robot,
                                                     const Rigid3& base_from_platform);

// The same motion by twists that are orthonormal with lengths in units of size_m.
Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasisInSize(const ParallelRobot& robot,
                                                           const Rigid3& base_from_platform, double size_m);

// Whether the pose is one that the motion allows, to 1e-9 m and rad.
bool CanTake(const ParallelRobot& robot, const Rigid3& base_from_platform);

// A pose that RPS legs allow near to the given one, the nearest in first order; any other robot's is left as
// it is.
Rigid3 BackToMotion(const ParallelRobot& robot, const Rigid3& base_from_platform);

}  // namespace legible
