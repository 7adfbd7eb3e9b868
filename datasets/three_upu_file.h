// robot.yaml of a 3-UPU.
#pragma once

#include <filesystem>

#include "core/robots/three_upu.h"

namespace legible {

class YamlValue;

// Whether a file's "robot" is "3-upu". Throws InputError where it cannot be read at all.
bool HoldsThreeUpu(const std::filesystem::path& file);

// Throws InputError for what is no 3-UPU: a missing or unknown key, other than three legs, an axis without
// direction, a joint range reversed.
ThreeUpu ReadThreeUpu(const std::filesystem::path& file);

}  // namespace legible
