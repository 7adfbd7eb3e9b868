#include "apps/accuracy_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "apps/option_values.h"
#include "datasets/text.h"

namespace legible {
namespace {

constexpr char kReachable[] = "reachable";

int ParseCoordinate(const std::string& name) {
  const auto found = std::find(CoordinateNames().begin(), CoordinateNames().end(), name);
  if (found == CoordinateNames().end())
    throw std::invalid_argument(
        fmt::format("\"{}\" is none of {}, {}", name, fmt::join(CoordinateNames(), ", "), kReachable));
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

OutputUnit UnitOf(const std::vector<OutputUnit>& units, const std::optional<std::string>& asked,
                  const std::string& for_people, AccuracyFormat format) {
  const bool people_read = format == AccuracyFormat::kTable || format == AccuracyFormat::kHtml;
  const std::string name = asked.value_or(people_read ? for_people : units.front().name);
  return *std::find_if(units.begin(), units.end(), [&](const OutputUnit& unit) { return unit.name == name; });
}

}  // namespace

const std::vector<OutputUnit>& LengthUnits() {
  static const std::vector<OutputUnit> units = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}};
  return units;
}

const std::vector<OutputUnit>& AngleUnits() {
  static const std::vector<OutputUnit> units = {{"rad", 1}, {"deg", std::numbers::pi / 180}};
  return units;
}

const std::vector<std::string>& CoordinateNames() {
  static const std::vector<std::string> names = {"x", "y", "z", "rx", "ry", "rz"};
  return names;
}

OutputUnit LengthUnitOf(const AccuracySettings& settings) {
  return UnitOf(LengthUnits(), settings.length_unit, "mm", settings.format);
}

OutputUnit AngleUnitOf(const AccuracySettings& settings) {
  return UnitOf(AngleUnits(), settings.angle_unit, "deg", settings.format);
}

BoxSetting ParseBox(const std::string& text) {
  BoxSetting box;
  for (const std::string& part : Split(text, ',')) {
    if (part == kReachable) {
      box.is_reachable = true;
      continue;
    }
    const size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(fmt::format("\"{}\" is neither {} nor NAME=LOW:HIGH", part, kReachable));
    const int coordinate = ParseCoordinate(std::string(Trimmed(part.substr(0, equals))));
    if (!box.ranges.emplace(coordinate, ParseRange(part.substr(equals + 1))).second)
      throw std::invalid_argument(
          fmt::format("{} has two ranges", CoordinateNames()[static_cast<size_t>(coordinate)]));
  }
  const bool has_width = std::any_of(box.ranges.begin(), box.ranges.end(),
                                     [](const auto& entry) { return entry.second[0] < entry.second[1]; });
  if (!has_width && !box.is_reachable) throw std::invalid_argument("the box has no range that is not empty");
  return box;
}

std::vector<double> ParseJointErrors(const std::string& text) {
  std::vector<double> errors;
  for (const std::string& part : Split(text, ',')) errors.push_back(ParseLengthError(part));
  return errors;
}

double ParseLengthError(const std::string& text) {
  constexpr double kLeast_m = 1e-12, kLargest_m = 1;
  const double error_m = ParsePositive(text);
  if (error_m < kLeast_m || error_m > kLargest_m)
    throw std::invalid_argument(
        fmt::format("{} m is no error of a robot: give {} to {} m", text, kLeast_m, kLargest_m));
  return error_m;
}

}  // namespace legible
