#include "apps/accuracy_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/index_definitions.h"
#include "apps/json_text.h"
#include "apps/program.h"
#include "core/geometry/orientation.h"

namespace legible {
namespace {

using nlohmann::json;

// Maps are always in millimetres and degrees.
constexpr double kMillimetre_m = 1e-3;
double MapUnit(int coordinate) { return coordinate < 3 ? kMillimetre_m : kDegree_rad; }
const char* MapUnitName(int coordinate) { return coordinate < 3 ? "mm" : "deg"; }

json RobotJson(const Mechanism& mechanism) {
  json legs = json::array();
  for (const LegShape& leg : LegShapesOf(mechanism))
    legs.push_back({{"base_joint_m", List(leg.base_joint_m)},
                    {"platform_joint_m", List(leg.platform_joint_m)},
                    {"radius_m", leg.radius_m}});
  return {{"legs", legs}};
}

json PosesJson(const std::vector<JudgedPose>& poses) {
  json list = json::array();
  for (const JudgedPose& pose : poses)
    list.push_back({{"rotation_xyzw", List(pose.base_from_platform.rotation.coeffs())},
                    {"translation_m", List(pose.base_from_platform.translation)}});
  return list;
}

json AxisJson(int coordinate, const Eigen::VectorXd& values) {
  return {{"label", CoordinateNames()[static_cast<size_t>(coordinate)]},
          {"unit", MapUnitName(coordinate)},
          {"values", List(values / MapUnit(coordinate))}};
}

// "z = 530 mm, rx = 0 deg, …": what the map holds.
std::string HeldText(const ErrorMap& map) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    if (i == map.axes[0] || i == map.axes[1]) continue;
    text +=
        fmt::format("{}{} = {:.4g} {}", text.empty() ? "" : ", ", CoordinateNames()[static_cast<size_t>(i)],
                    map.held[i] / MapUnit(i) + 0.0, MapUnitName(i));
  }
  return text;
}

enum class CellState { kFine, kBeyondJointRanges, kSingular };

json StatesJson(const ErrorMap& map) {
  json rows = json::array();
  for (Eigen::Index y = 0; y < map.second.size(); ++y) {
    json row = json::array();
    for (Eigen::Index x = 0; x < map.first.size(); ++x) {
      const auto point = static_cast<size_t>(y * map.first.size() + x);
      const bool is_singular = map.values.states[point] != PointState::kInside;
      row.push_back(is_singular                         ? CellState::kSingular
                    : map.is_within_joint_ranges[point] ? CellState::kFine
                                                        : CellState::kBeyondJointRanges);
    }
    rows.push_back(row);
  }
  return rows;
}

template <typename F>
json QuantityJson(const ErrorMap& map, const std::string& key, const std::string& label,
                  const std::string& unit, const F& value) {
  json rows = json::array();
  for (Eigen::Index y = 0; y < map.second.size(); ++y) {
    json row = json::array();
    for (Eigen::Index x = 0; x < map.first.size(); ++x) {
      const Eigen::Index point = y * map.first.size() + x;
      const bool has_value = map.values.states[static_cast<size_t>(point)] == PointState::kInside;
      row.push_back(has_value ? json(Rounded(value(map.values.values.col(point)))) : json());
    }
    rows.push_back(row);
  }
  return {{"key", key}, {"label", label}, {"unit", unit}, {"values", rows}};
}

json MapJson(const ErrorMap& map) {
  json quantities = json::array();
  const auto error_row = [&](const std::string& key, const std::string& label, int row, int unit_of) {
    quantities.push_back(QuantityJson(map, key, label, MapUnitName(unit_of),
                                      [=](const auto& values) { return values[row] / MapUnit(unit_of); }));
  };
  error_row("position", "largest position error", kPositionRow, 0);
  error_row("rotation", "largest rotation error", kRotationRow, 3);
  for (int i = 0; i < 6; ++i)
    error_row(CoordinateNames()[static_cast<size_t>(i)],
              "error in " + CoordinateNames()[static_cast<size_t>(i)], i, i);
  quantities.push_back(QuantityJson(map, "condition", IndexLabel("condition.two_normalized"), "",
                                    [](const auto& values) { return 1 / values[kInverseConditionRow]; }));
  return {{"x", AxisJson(map.axes[0], map.first)},
          {"y", AxisJson(map.axes[1], map.second)},
          {"fixed", HeldText(map)},
          {"quantities", quantities},
          {"states", StatesJson(map)}};
}

json ScatterJson(const AccuracyRun& run, const nlohmann::ordered_json& document) {
  const Comparison& comparison = *run.comparison;
  json indices = json::array();
  for (size_t i = 0; i < comparison.indices.indices.size(); ++i) {
    const ComparedIndex& index = comparison.indices.indices[i];
    indices.push_back({{"key", index.key},
                       {"label", IndexLabel(index.key)},
                       {"unit", document.at("comparison").at("indices").at(i).at("unit")},
                       {"values", index.values}});
  }
  const auto error = [](const std::string& key, const std::vector<double>& values, double unit,
                        const char* name) {
    return json{{"key", key},
                {"label", "largest " + key + " error"},
                {"unit", name},
                {"values", List(Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                                  static_cast<Eigen::Index>(values.size())) /
                                unit)}};
  };
  const OutputUnit length = LengthUnitOf(run.settings), angle = AngleUnitOf(run.settings);
  return {{"over", comparison.over},
          {"names", comparison.names},
          {"indices", indices},
          {"errors",
           {error("position", comparison.indices.position_m, length.si, length.name.c_str()),
            error("rotation", comparison.indices.rotation_rad, angle.si, angle.name.c_str())}}};
}

}  // namespace

json AccuracyReportData(const AccuracyRun& run, const nlohmann::ordered_json& document) {
  const std::string& name = NameOf(run.robot.mechanism);
  json data = {{"title", name.empty() ? "Robot" : name},
               {"program_version", ProgramVersion()},
               {"model", run.settings.model.string()},
               {"robot", RobotJson(run.robot.mechanism)},
               {"poses_si", PosesJson(run.poses)},
               {"maps", run.map ? MapJson(*run.map) : json()},
               {"scatter", run.comparison ? ScatterJson(run, document) : json()}};
  data["document"] = document;
  return data;
}

}  // namespace legible
