#include "apps/option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "core/geometry/pose_coordinates.h"
#include "datasets/text.h"

namespace legible {
namespace {

int ParseCoordinate(const std::string& name, const std::string& also) {
  const auto found = std::find(CoordinateNames().begin(), CoordinateNames().end(), name);
  if (found == CoordinateNames().end())
    throw std::invalid_argument(fmt::format("\"{}\" is none of {}{}{}", name,
                                            fmt::join(CoordinateNames(), ", "), also.empty() ? "" : ", ",
                                            also));
  return static_cast<int>(found - CoordinateNames().begin());
}

std::array<double, 2> ParseRange(const std::string& text) {
  const std::vector<std::string> ends = Split(text, ':');
  if (ends.size() != 2) throw std::invalid_argument(fmt::format("\"{}\" is not LOW:HIGH", text));
  const std::array<double, 2> range = {ParseNumber(ends[0]), ParseNumber(ends[1])};
  if (range[0] > range[1]) throw std::invalid_argument(fmt::format("the range {} is reversed", text));
  constexpr double kFarthest = 1000;  // m or rad
  if (range[0] < -kFarthest || range[1] > kFarthest)
    throw std::invalid_argument(
        fmt::format("the range {} is beyond any robot; give metres and radians", text));
  return range;
}

}  // namespace

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(Trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

double ParseNumber(const std::string& text) {
  const std::optional<double> value = ParseFinite(text);
  if (!value) throw std::invalid_argument(fmt::format("\"{}\" is not a finite number", text));
  return *value;
}

double ParsePositive(const std::string& text) {
  const double value = ParseNumber(text);
  if (!(value > 0)) throw std::invalid_argument(fmt::format("{} is not more than 0", text));
  return value;
}

const std::vector<std::string>& CoordinateNames() {
  static const std::vector<std::string> names = {"x", "y", "z", "rx", "ry", "rz"};
  return names;
}

CoordinateRanges ParseRanges(const std::vector<std::string>& texts, const std::string& also) {
  CoordinateRanges ranges;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("\"{}\" is {}", text,
                      also.empty() ? "not NAME=LOW:HIGH" : "neither " + also + " nor NAME=LOW:HIGH"));
    const int coordinate = ParseCoordinate(std::string(Trimmed(text.substr(0, equals))), also);
    if (!ranges.emplace(coordinate, ParseRange(text.substr(equals + 1))).second)
      throw std::invalid_argument(
          fmt::format("{} has two ranges", CoordinateNames()[static_cast<size_t>(coordinate)]));
  }
  return ranges;
}

Vector6d ParseSix(const std::string& text, const std::string& what) {
  std::string blanks = text;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::istringstream stream(blanks);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != 6)
    throw std::invalid_argument(
        fmt::format("\"{}\" has {} numbers, not the six {}", text, words.size(), what));
  Vector6d pose;
  for (size_t i = 0; i < 6; ++i) pose[static_cast<Eigen::Index>(i)] = ParseNumber(words[i]);
  return pose;
}

Vector6d ParsePose(const std::string& text) { return ParseSix(text, "x y z rx ry rz"); }

std::string PoseText(const Rigid3& base_from_platform) {
  constexpr double kNothing = 1e-10;
  Vector6d pose = CoordinatesOf(base_from_platform);
  pose = (pose.array().abs() < kNothing).select(0, pose);
  return fmt::format("{:.10g}", fmt::join(pose, " "));
}

std::vector<int> ParseLegs(const std::string& text, int most) {
  std::vector<int> legs;
  for (const std::string& part : Split(text, ',')) {
    const std::optional<int> leg = ParseInteger(part);
    if (!leg || *leg < 1 || *leg > most)
      throw std::invalid_argument(fmt::format("\"{}\" is no leg: legs count from 1 to {}", part, most));
    if (std::find(legs.begin(), legs.end(), *leg - 1) != legs.end())
      throw std::invalid_argument(fmt::format("leg {} is named twice", *leg));
    legs.push_back(*leg - 1);
  }
  return legs;
}

}  // namespace legible
