// A robot for LinuxCNC's kinematics genhexkins.
#pragma once

#include <string>

#include "core/robots/gough_stewart.h"

namespace legible {

enum class LengthUnit { kMillimetre, kInch };

// A HAL file: `setp genhexkins.base.N.x ...` and `genhexkins.platform.N.x ...` of the six legs, which HAL
// counts from 0, in the machine's unit of length, and in comments the legs' HOME_OFFSET for the machine's ini
// file with what they mean. What genhexkins has no place for is said in comments as well. Throws
// std::invalid_argument for a number that is not finite.
std::string LinuxCncText(const GoughStewart& robot, LengthUnit unit);

}  // namespace legible
