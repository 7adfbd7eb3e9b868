#include "apps/legs_map_json.h"

#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/option_values.h"
#include "apps/wording.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

// Rows over the second coordinate of columns over the first.
template <typename Cells, typename F>
ordered_json GridJson(const PoseSlice& slice, const Cells& cells, const F& value) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index y = 0; y < slice.second.size(); ++y) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index x = 0; x < slice.first.size(); ++x)
      row.push_back(value(cells[static_cast<size_t>(y * slice.first.size() + x)]));
    rows.push_back(row);
  }
  return rows;
}

ordered_json AxisJson(int coordinate, const Eigen::VectorXd& values) {
  return {{"coordinate", CoordinateNames()[static_cast<size_t>(coordinate)]},
          {"unit", coordinate < 3 ? "m" : "rad"},
          {"values", List(values)}};
}

void AddSingularities(const PoseSlice& slice, const SingularityMap& map, ordered_json& json) {
  json["type_2_geometric"] = GridJson(slice, map.type_2, [](const std::optional<Type2Measure>& measure) {
    return measure && measure->geometric ? ordered_json(Rounded(*measure->geometric)) : ordered_json();
  });
  json["type_2_matrix"] = GridJson(slice, map.type_2, [](const std::optional<Type2Measure>& measure) {
    return measure ? ordered_json(Rounded(measure->matrix)) : ordered_json();
  });
  json["type_1"] = GridJson(slice, map.type_1, [](const std::optional<double>& measure) {
    return measure ? ordered_json(Rounded(*measure)) : ordered_json();
  });
}

ordered_json SetMapJson(const PoseSlice& slice, const LegSetMap& set) {
  ordered_json json = {{"legs", FromOne(set.legs)}};
  AddSingularities(slice, set.hidden, json);
  json["position_error_m"] = GridJson(slice, set.errors, [](const std::optional<LargestPoseError>& error) {
    return error ? ordered_json(Rounded(error->position_m)) : ordered_json();
  });
  json["rotation_error_rad"] = GridJson(slice, set.errors, [](const std::optional<LargestPoseError>& error) {
    return error ? ordered_json(Rounded(error->rotation_rad)) : ordered_json();
  });
  return json;
}

}  // namespace

ordered_json SliceMapJson(const SliceMap& map) {
  ordered_json held, robot, sets = ordered_json::array();
  for (size_t i = 0; i < CoordinateNames().size(); ++i)
    held[CoordinateNames()[i]] = map.slice.held[static_cast<Eigen::Index>(i)];
  robot["states"] = GridJson(map.slice, map.states, [](CellState state) { return ToString(state); });
  AddSingularities(map.slice, map.real, robot);
  for (const LegSetMap& set : map.sets) sets.push_back(SetMapJson(map.slice, set));
  return {{"x", AxisJson(map.slice.axes[0], map.slice.first)},
          {"y", AxisJson(map.slice.axes[1], map.slice.second)},
          {"held", held},
          {"robot", robot},
          {"sets", sets}};
}

}  // namespace legible
