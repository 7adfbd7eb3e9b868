// How many poses give the seen legs of a robot the same directions, counted exactly.
#pragma once

#include <optional>
#include <vector>

#include "core/robots/parallel_robot.h"
#include "tests/core/algebra/rational.h"

namespace legible {

// Of as many legs as the robot's platform needs, on whose lines the platform joints may be on either side.
// From the loop equations of the robot, whose doubles are rational numbers, all unknowns but one are
// eliminated in rational numbers; `degree` is that of what is left. Directions are as they are computed at
// the pose, though rounded; two of them over-determine a translation, for which there is no such count.
// Nothing where the poses are not distinct.
std::optional<RealRoots> ExactPoseCount(const ParallelRobot& robot, const std::vector<int>& legs,
                                        const Rigid3& pose);

}  // namespace legible
