#include "apps/legs_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/leg_visibility.h"
#include "apps/legs_map.h"
#include "core/robots/leg_state.h"
#include "core/robots/parallel_kinematics.h"
#include "core/robots/platform_motion.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"
#include "datasets/parallel_robot_file.h"

namespace legible {
namespace {

// A servo of any gain is simulated alike: by steps of this part of its time constant, for so many of them.
constexpr double kStepTimesGain = 0.008;
constexpr double kLongestTimesGain = 48;
constexpr size_t kMostMappedSets = 6;

// As given, or as near to it as RPS legs allow.
Rigid3 PoseOf(const std::optional<Vector6d>& pose, const ParallelRobot& robot) {
  return pose ? BackToMotion(robot, PoseAt(*pose)) : robot.home;
}

void DemandCanTake(const LegsSettings& settings, const ParallelRobot& robot, const Rigid3& pose,
                   const char* option) {
  if (CanTake(robot, pose)) return;
  std::vector<std::string> moved;
  for (const int coordinate : FreeCoordinates(robot.motion))
    moved.push_back(CoordinateNames()[static_cast<size_t>(coordinate)]);
  throw InputError(settings.model, 0,
                   fmt::format("has a platform that cannot take the pose of {}: from its home it moves {}{}",
                               option, fmt::join(moved, ", "),
                               LegsKeptInPlanes(robot).empty() ? "" : ", less what its RPS legs forbid"),
                   "give it no motion that the platform does not have");
}

void DemandReachable(const LegsSettings& settings, const ParallelRobot& robot, const Rigid3& pose,
                     const char* option) {
  DemandCanTake(settings, robot, pose, option);
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    const auto state = StateOf(robot.legs[i], pose);
    const auto& range = robot.legs[i].joint_range;
    if (!state)
      throw InputError(settings.model, 0,
                       fmt::format("has a leg {} that does not reach the pose of {}", i + 1, option),
                       "give a pose within reach");
    if (!IsWithinJointRange(robot.legs[i], state->reading))
      throw InputError(
          settings.model, 0,
          fmt::format(
              "has a leg {} that would read {:.4g} {} at the pose of {}, beyond its range of {:.4g} to "
              "{:.4g}",
              i + 1, state->reading, ReadsAngle(robot.legs[i].chain) ? "rad" : "m", option, (*range)[0],
              (*range)[1]),
          "give a pose within reach");
  }
}

void DemandLegs(const LegsSettings& settings, const ParallelRobot& robot) {
  if (settings.leg_sets.empty() && robot.legs.size() > kMostLegsToChooseFrom)
    throw InputError(settings.model, 0,
                     fmt::format("has {} legs, and every set is judged of no more than {}", robot.legs.size(),
                                 kMostLegsToChooseFrom),
                     "name the sets to judge with --legs");
  for (const std::vector<int>& legs : settings.leg_sets)
    for (const int leg : legs)
      if (leg >= static_cast<int>(robot.legs.size()))
        throw InputError(settings.model, 0,
                         fmt::format("has {} legs, and no leg {}", robot.legs.size(), leg + 1),
                         "name others with --legs");
}

// Of a model with a camera; else all legs show everywhere.
std::function<bool(int, const Rigid3&)> VisibilityByModel(const std::filesystem::path& file,
                                                          const ParallelRobot& robot) {
  if (!HoldsModel(file)) return {};
  const CalibratedModel model = ReadModel(file);
  if (!model.camera || !model.camera_from_base) return {};
  return VisibilityOfLegs(robot, *model.camera, *model.camera_from_base);
}

std::optional<GoughStewartAssemblyModes> RobotModesAt(const ParallelRobot& robot, const Rigid3& goal) {
  const std::optional<GoughStewart> hexapod = GoughStewartOf(robot);
  if (!hexapod) return std::nullopt;
  return AllAssemblyModes(*hexapod, InverseKinematics(*hexapod, goal));
}

// Sets to map: those that were named, or the best that lead to the goal.
std::vector<std::vector<int>> SetsToMap(const LegsSettings& settings, const LegSelection& selection) {
  if (!settings.leg_sets.empty()) return settings.leg_sets;
  std::vector<std::vector<int>> legs;
  for (const JudgedLegSet& set : selection.sets)
    if (LeadsToGoal(set) && legs.size() < kMostMappedSets) legs.push_back(set.legs);
  return legs;
}

}  // namespace

LegsRun JudgeLegs(const LegsSettings& settings, ProgressLine& progress) {
  LegsRun run;
  run.settings = settings;
  run.robot = ReadParallelRobot(settings.model);
  run.from = PoseOf(settings.from, run.robot);
  run.to = PoseOf(settings.to, run.robot);
  DemandLegs(settings, run.robot);
  DemandReachable(settings, run.robot, run.from, "--from");
  DemandReachable(settings, run.robot, run.to, "--to");
  LegSelectionOptions options;
  options.leg_sets = settings.leg_sets;
  options.cone_half_angle_rad = settings.noise_rad;
  options.servo.gain_per_s = settings.gain_per_s;
  options.servo.step_s = kStepTimesGain / settings.gain_per_s;
  options.servo.longest_s = kLongestTimesGain / settings.gain_per_s;
  options.is_visible = VisibilityByModel(settings.model, run.robot);
  run.selection = SelectLegs(run.robot, run.from, run.to, options, [&](int judged, int of) {
    progress.Show(StageText("judging sets of legs", judged, of));
  });
  for (const JudgedLegSet& set : run.selection.sets)
    run.by_lines.push_back(ControllabilityOf(run.robot, set.legs, run.to, SeenFeature::kLines));
  run.robot_modes = RobotModesAt(run.robot, run.to);
  if (settings.map || settings.format == LegsFormat::kHtml)
    if (const auto slice = SliceOf(settings, run.robot, run.to))
      run.map = MapLegSets(settings, run.robot, *slice, SetsToMap(settings, run.selection), progress);
  return run;
}

}  // namespace legible
