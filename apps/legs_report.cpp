#include "apps/legs_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/json_text.h"
#include "apps/program.h"
#include "core/robots/leg_state.h"

namespace legible {
namespace {

using nlohmann::json;

// Of a simulation, for curves.
constexpr size_t kMostSamples = 300;
// Unit vectors that differ by less are the same direction: modes agree far better.
constexpr double kSameDirection = 1e-6;

json RoundedPoint(const Eigen::Vector3d& point) {
  return {Rounded(point.x()), Rounded(point.y()), Rounded(point.z())};
}

json RobotJson(const ParallelRobot& robot) {
  json legs = json::array();
  for (const RobotLeg& leg : robot.legs)
    legs.push_back({{"base_joint_m", RoundedPoint(leg.base_joint_m)}, {"radius_m", leg.radius_m}});
  return {{"legs", legs}};
}

// Of a leg that may bend either way, that in which its seen segment has the direction.
std::optional<LegState> StateThatPoints(RobotLeg leg, const Rigid3& pose, const Eigen::Vector3d& direction) {
  for (const int turn : {1, -1}) {
    leg.working_mode *= turn;
    auto state = StateOf(leg, pose);
    if (state && (state->direction - direction).norm() < kSameDirection) return state;
  }
  return std::nullopt;
}

json PlaceJson(const RobotLeg& leg, const Rigid3& pose, const std::optional<LegState>& state) {
  return {{"start_m", state ? RoundedPoint(state->start_m) : json()},
          {"platform_joint_m", RoundedPoint(pose * leg.platform_joint_m + leg.carried_offset_m)}};
}

// Legs as they bend at home.
json PlacesAt(const ParallelRobot& robot, const Rigid3& pose) {
  json places = json::array();
  for (const RobotLeg& leg : robot.legs) places.push_back(PlaceJson(leg, pose, StateOf(leg, pose)));
  return places;
}

// The same, but for the seen legs, which point as at the goal and may have to bend the other way for it.
json PlacesInMode(const ParallelRobot& robot, const std::vector<int>& seen, const Rigid3& goal,
                  const Rigid3& pose) {
  json places = PlacesAt(robot, pose);
  for (const int leg : seen) {
    const RobotLeg& one = robot.legs[static_cast<size_t>(leg)];
    if (const auto at_goal = StateOf(one, goal))
      places[static_cast<size_t>(leg)] = PlaceJson(one, pose, StateThatPoints(one, pose, at_goal->direction));
  }
  return places;
}

json ModesJson(const LegsRun& run, const JudgedLegSet& set) {
  if (set.modes.modes.empty()) return {};
  json modes = json::array();
  for (const AssemblyMode& mode : set.modes.modes)
    modes.push_back(PlacesInMode(run.robot, set.legs, run.to, mode.base_from_platform));
  return modes;
}

json SimulationJson(const std::optional<DirectionServoRun>& run, const Rigid3& goal) {
  if (!run || run->samples.empty()) return {};
  const size_t last = run->samples.size() - 1;
  const size_t steps = std::min(last, kMostSamples - 1);
  json times = json::array(), positions = json::array(), rotations = json::array();
  json errors(run->samples.front().errors_rad.size(), json::array());
  for (size_t i = 0; i <= steps; ++i) {
    const DirectionServoSample& sample = run->samples[steps == 0 ? 0 : i * last / steps];
    const Vector6d from_goal = Displacement(goal, sample.base_from_platform);
    times.push_back(Rounded(sample.time_s));
    positions.push_back(Rounded(from_goal.head<3>().norm()));
    rotations.push_back(Rounded(from_goal.tail<3>().norm()));
    for (size_t leg = 0; leg < errors.size(); ++leg) errors[leg].push_back(Rounded(sample.errors_rad[leg]));
  }
  return {{"time_s", times},
          {"errors_rad", errors},
          {"position_from_goal_m", positions},
          {"rotation_from_goal_rad", rotations}};
}

}  // namespace

json LegsReportData(const LegsRun& run, const nlohmann::ordered_json& document) {
  json modes = json::array(), simulations = json::array();
  for (const JudgedLegSet& set : run.selection.sets) {
    modes.push_back(ModesJson(run, set));
    simulations.push_back(SimulationJson(set.simulated, run.to));
  }
  json data = {
      {"title", run.robot.name.empty() ? "Robot" : run.robot.name},
      {"program_version", ProgramVersion()},
      {"model", run.settings.model.string()},
      {"robot", RobotJson(run.robot)},
      {"places",
       {{"from", PlacesAt(run.robot, run.from)}, {"to", PlacesAt(run.robot, run.to)}, {"modes", modes}}},
      {"simulations", simulations}};
  data["document"] = document;
  return data;
}

}  // namespace legible
