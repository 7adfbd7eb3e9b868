// robot.yaml: the drawing of a Gough-Stewart robot.
#pragma once

#include <filesystem>
#include <string>

#include "core/robots/gough_stewart.h"

namespace legible {

class YamlValue;

// Throws InputError for what is no Gough-Stewart robot: a missing or unknown key, other than six legs, a
// radius that is not positive or not less than the shortest leg, a joint range reversed, one leg given twice.
// `name` and joint_offset_m may be left out (empty, 0).
GoughStewart ReadRobot(const std::filesystem::path& file);

// Writes so that ReadRobot gives back the same bits. Throws InputError if the file cannot be written and
// std::invalid_argument if a number is not finite.
void WriteRobot(const std::filesystem::path& file, const GoughStewart& robot);

// The same as a section of another file.
GoughStewart RobotFromYaml(const YamlValue& section);
std::string RobotToYaml(const GoughStewart& robot);

}  // namespace legible
