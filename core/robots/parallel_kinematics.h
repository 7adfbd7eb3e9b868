// Inverse and forward kinematics of parallel robots of all families.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/robots/parallel_robot.h"

namespace legible {

// Readings of all actuated joints at the pose; nothing where one leg does not reach it.
std::optional<Eigen::VectorXd> InverseKinematics(const ParallelRobot& robot,
                                                 const Rigid3& base_from_platform);

// Whether every joint that has a range reads within it, angles by any number of whole turns.
bool AreWithinJointRanges(const ParallelRobot& robot, const Eigen::VectorXd& readings);

// The same of one joint; true where it has no range.
bool IsWithinJointRange(const RobotLeg& leg, double reading);

struct ForwardResult {
  ForwardKinematicsStatus status = ForwardKinematicsStatus::kNotConverged;
  Rigid3 base_from_platform;
  double largest_error = 0;  // of a joint reading there, m or rad
};

// The pose of the given readings to which Gauss-Newton on them converges from the guess.
ForwardResult ForwardKinematics(const ParallelRobot& robot, const Eigen::VectorXd& readings,
                                const Rigid3& guess_base_from_platform);

}  // namespace legible
