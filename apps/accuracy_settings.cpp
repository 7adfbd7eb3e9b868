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

OutputUnit LengthUnitOf(const AccuracySettings& settings) {
  return UnitOf(LengthUnits(), settings.length_unit, "mm", settings.format);
}

OutputUnit AngleUnitOf(const AccuracySettings& settings) {
  return UnitOf(AngleUnits(), settings.angle_unit, "deg", settings.format);
}

BoxSetting ParseBox(const std::string& text) {
  BoxSetting box;
  std::vector<std::string> ranges;
  for (const std::string& part : Split(text, ','))
    if (part == kReachable)
      box.is_reachable = true;
    else
      ranges.push_back(part);
  box.ranges = ParseRanges(ranges, kReachable);
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
