// Texts of options taken apart, for several commands. All throw std::invalid_argument with a message for the
// user.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"

namespace legible {

std::vector<std::string> Split(const std::string& text, char separator);  // trimmed
double ParseNumber(const std::string& text);                              // finite
double ParsePositive(const std::string& text);

// "x", "y", "z", "rx", "ry", "rz": of poses, boxes and maps.
const std::vector<std::string>& CoordinateNames();

// Least and largest value by coordinate (0 to 5, SI).
using CoordinateRanges = std::map<int, std::array<double, 2>>;

// Of texts like "rz=-0.1:0.1"; `also` is a word that the user could have given instead of one.
CoordinateRanges ParseRanges(const std::vector<std::string>& texts, const std::string& also = "");

// Six numbers between blanks or commas; `what` names them in the message.
Vector6d ParseSix(const std::string& text, const std::string& what);
Vector6d ParsePose(const std::string& text);  // "x y z rx ry rz"
// As ParsePose reads it, to 1e-9 m and rad where the robot is of some metres.
std::string PoseText(const Rigid3& base_from_platform);
// "1,3,5", from 1 to `most`; result from 0.
std::vector<int> ParseLegs(const std::string& text, int most = kLegCount);

}  // namespace legible
