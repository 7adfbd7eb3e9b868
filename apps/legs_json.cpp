#include "apps/legs_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/legs_map_json.h"
#include "apps/option_values.h"
#include "apps/wording.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

ordered_json PoseJson(const Rigid3& pose) {
  return {{"rotation_xyzw", List(pose.rotation.coeffs())}, {"translation_m", List(pose.translation)}};
}

ordered_json ChainsJson(const ParallelRobot& robot) {
  ordered_json legs = ordered_json::array();
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    const HiddenLeg hidden = HiddenLegOf(robot.legs[i].chain, robot.motion);
    ordered_json leg = {{"leg", i + 1}, {"chain", legible::ToText(robot.legs[i].chain)}};
    leg["hidden_chain"] = hidden.chain.empty() ? ordered_json() : ordered_json(legible::ToText(hidden.chain));
    leg["why_not_controllable"] =
        hidden.why_not_controllable.empty() ? ordered_json() : ordered_json(hidden.why_not_controllable);
    legs.push_back(leg);
  }
  return legs;
}

ordered_json PathJson(const PathCertificate& path) {
  return {{"verdict", ToString(path.verdict)},
          {"pieces", path.pieces},
          {"free_up_to", path.at},
          {"pose_there", PoseJson(path.pose)},
          {"why", path.why}};
}

ordered_json ControllabilityJson(const Controllability& it) {
  ordered_json twists = ordered_json::array();
  for (const auto& twist : it.unseen_twists.colwise()) twists.push_back(List(twist));
  return {{"status", ToString(it.status)},
          {"freedoms", it.freedoms},
          {"seen_freedoms", it.seen_freedoms},
          {"unseen_twists", twists},
          {"why", it.why}};
}

ordered_json FromGoalJson(const Rigid3& goal, const Rigid3& pose) {
  const Vector6d from_goal = Displacement(goal, pose);
  return {{"base_from_platform", PoseJson(pose)},
          {"position_from_goal_m", from_goal.head<3>().norm()},
          {"rotation_from_goal_rad", from_goal.tail<3>().norm()}};
}

// Null where the joints have no ranges.
ordered_json WithinJointRangesJson(const ParallelRobot& robot, const Rigid3& pose) {
  const bool has_ranges = std::any_of(robot.legs.begin(), robot.legs.end(),
                                      [](const RobotLeg& leg) { return leg.joint_range.has_value(); });
  const CellState state = StateOfCell(robot, pose);
  if (state == CellState::kFine && !has_ranges) return {};
  return state == CellState::kFine;
}

ordered_json ModesJson(const LegsRun& run, const AssemblyModes& modes) {
  ordered_json list = ordered_json::array();
  for (const AssemblyMode& mode : modes.modes) {
    ordered_json json = FromGoalJson(run.to, mode.base_from_platform);
    json["has_own_working_modes"] = mode.has_own_working_modes;
    json["within_joint_ranges"] = WithinJointRangesJson(run.robot, mode.base_from_platform);
    json["largest_direction_error"] = mode.largest_direction_error;
    list.push_back(json);
  }
  return {{"status", ToString(modes.status)},
          {"most_possible", modes.most_possible},
          {"why", modes.why},
          {"modes", list},
          {"with_a_reversed_leg", modes.reversed.size()}};
}

// Of the robot itself, by its joint readings.
ordered_json RobotModesJson(const LegsRun& run) {
  if (!run.robot_modes) return {};
  const GoughStewartAssemblyModes& modes = *run.robot_modes;
  ordered_json list = ordered_json::array();
  for (const GoughStewartAssemblyMode& mode : modes.modes) {
    ordered_json json = FromGoalJson(run.to, mode.base_from_platform);
    json["largest_length_error_m"] = mode.largest_length_error_m;
    list.push_back(json);
  }
  std::sort(list.begin(), list.end(), [](const ordered_json& a, const ordered_json& b) {
    return a.at("position_from_goal_m").get<double>() < b.at("position_from_goal_m").get<double>();
  });
  return {{"status", modes.is_complete ? "complete" : "incomplete"},
          {"why", modes.is_complete
                      ? ""
                      : fmt::format("{} of {} complex roots are certified; {} seem to be at infinity",
                                    modes.certified, kGoughStewartRootCount, modes.at_infinity)},
          {"most_possible", kGoughStewartRootCount},
          {"modes", list}};
}

ordered_json ErrorJson(const std::optional<LargestPoseError>& error) {
  if (!error) return {};
  return {{"position_m", error->position_m}, {"rotation_rad", error->rotation_rad}};
}

ordered_json SimulationJson(const std::optional<DirectionServoRun>& run, const Rigid3& goal) {
  if (!run) return {};
  const DirectionServoSample& last = run->samples.back();
  ordered_json json = {{"end", ToString(run->end)}, {"time_s", last.time_s}};
  json.update(FromGoalJson(goal, last.base_from_platform));
  json["largest_direction_error_rad"] = *std::max_element(last.errors_rad.begin(), last.errors_rad.end());
  return json;
}

ordered_json SetJson(const LegsRun& run, const JudgedLegSet& set, const Controllability& by_lines) {
  ordered_json path = PathJson(set.path);
  path["is_the_simulated_way"] = set.is_path_simulated;
  const bool was_judged = set.error_at_goal.has_value();  // else it was ruled out before
  return {{"legs", FromOne(set.legs)},
          {"verdict", ToString(set.verdict)},
          {"why", set.why},
          {"controllability", ControllabilityJson(set.controllability)},
          {"by_lines", ControllabilityJson(by_lines)},
          {"path", was_judged ? path : ordered_json()},
          {"assembly_modes", was_judged ? ModesJson(run, set.modes) : ordered_json()},
          {"largest_error_at_goal", ErrorJson(set.error_at_goal)},
          {"largest_error_on_path", ErrorJson(set.error_on_path)},
          {"simulation", SimulationJson(set.simulated, run.to)}};
}

// Where RPS legs did not allow the pose that was given.
void AddPoseTaken(const std::optional<Vector6d>& given, const Rigid3& taken, const char* option,
                  std::vector<std::string>& warnings) {
  constexpr double kSamePose = 1e-9;  // m, rad
  if (!given || Displacement(PoseAt(*given), taken).lpNorm<Eigen::Infinity>() <= kSamePose) return;
  warnings.push_back(fmt::format("the RPS legs do not allow the pose of {}; one near to it is taken: {}",
                                 option, PoseText(taken)));
}

std::vector<std::string> Warnings(const LegsRun& run) {
  std::vector<std::string> warnings;
  AddPoseTaken(run.settings.from, run.from, "--from", warnings);
  AddPoseTaken(run.settings.to, run.to, "--to", warnings);
  if (run.selection.robot_path.verdict != PathVerdict::kFree)
    warnings.push_back(fmt::format("the straight way of the robot itself, all joints held: {}",
                                   run.selection.robot_path.why));
  if (!run.selection.has_choice) return warnings;
  const JudgedLegSet& best = run.selection.sets.front();
  if (best.verdict == LegSetVerdict::kArrives) warnings.push_back(NotProvedText(best.legs, best.why));
  if (best.modes.status != AssemblyModesStatus::kComplete)
    warnings.push_back(fmt::format("the assembly modes of legs {} may not be all: {}", LegNumbers(best.legs),
                                   best.modes.why));
  return warnings;
}

ordered_json WhyNoChoice(const LegSelection& selection) {
  if (selection.has_choice) return {};
  return selection.robot_path.verdict == PathVerdict::kSingular
             ? "the robot itself cannot go to the goal without a singularity, whichever legs are watched"
             : "no set of legs leads to the goal";
}

}  // namespace

ordered_json LegsJson(const LegsRun& run) {
  ordered_json sets = ordered_json::array();
  for (size_t i = 0; i < run.selection.sets.size(); ++i)
    sets.push_back(SetJson(run, run.selection.sets[i], run.by_lines[i]));
  return {{"robot", run.robot.name},
          {"platform", ToString(run.robot.motion)},
          {"from", PoseJson(run.from)},
          {"to", PoseJson(run.to)},
          {"noise_rad", run.settings.noise_rad},
          {"legs", ChainsJson(run.robot)},
          {"robot_path", PathJson(run.selection.robot_path)},
          {"robot_modes", RobotModesJson(run)},
          {"sets", sets},
          {"choice", run.selection.has_choice ? ordered_json(FromOne(run.selection.sets.front().legs))
                                              : ordered_json()},
          {"why_no_choice", WhyNoChoice(run.selection)},
          {"maps", run.map ? SliceMapJson(*run.map) : ordered_json()},
          {"warnings", Warnings(run)}};
}

}  // namespace legible
