// Texts of options taken apart, for several commands. All throw std::invalid_argument with a message for the
// user.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"

namespace legible {

std::vector<std::string> Split(const std::string& text, char separator);  // trimmed
double ParseNumber(const std::string& text);                              // finite
double ParsePositive(const std::string& text);

// Six numbers between blanks or commas; `what` names them in the message.
Vector6d ParseSix(const std::string& text, const std::string& what);
Vector6d ParsePose(const std::string& text);  // "x y z rx ry rz"
// "1,3,5", from 1 to `most`; result from 0.
std::vector<int> ParseLegs(const std::string& text, int most = kLegCount);

}  // namespace legible
