// robot.yaml of parallel robots of every family: legs by their chains of joints.
#pragma once

#include <filesystem>

#include "core/robots/parallel_robot.h"

namespace legible {

// Reads a file whose "robot" is "parallel", and every robot.yaml and model.yaml of a Gough-Stewart robot or a
// 3-UPU as what ParallelRobotOf makes of it. Axes may be given in any length.
// Throws InputError for what is none of these: a missing or unknown key, one that the leg's chain does not
// have, what core's Check refuses, fewer legs than the platform has freedoms, a home that a leg does not
// reach.
ParallelRobot ReadParallelRobot(const std::filesystem::path& file);

}  // namespace legible
