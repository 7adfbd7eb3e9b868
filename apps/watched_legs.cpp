#include "apps/watched_legs.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "apps/leg_visibility.h"
#include "apps/legs_settings.h"
#include "apps/wording.h"
#include "core/geometry/orientation.h"
#include "core/robots/mechanism.h"
#include "datasets/input_error.h"
#include "servo/leg_selection.h"

namespace legible {
namespace {

constexpr double kSamePose = 1e-6;  // m, rad

std::vector<int> Watched(const ControlLawOptions& law) {
  std::vector<int> legs;
  for (int leg = 0; leg < kLegCount; ++leg)
    if (law.legs[static_cast<size_t>(leg)]) legs.push_back(leg);
  return legs;
}

// Nothing where the readings tell none; that is the servo's to deal with.
std::optional<Rigid3> PoseNow(PreparedServo& prepared) {
  const GoughStewart& robot = prepared.setup.model.robot;
  try {
    const auto found = ForwardKinematics(robot, prepared.rig.rig->ReadJoints().joint_readings_m, robot.home);
    if (found.status == ForwardKinematicsStatus::kConverged) return found.base_from_platform;
  } catch (const RigError&) {
  }
  return std::nullopt;
}

// Legs that show on the way and whose edges the goal has.
std::function<bool(int, const Rigid3&)> ShownWithGoal(const PreparedServo& prepared,
                                                      const ParallelRobot& robot) {
  const ServoModel& model = prepared.setup.model;
  return [shows = VisibilityOfLegs(robot, model.camera, model.camera_from_base),
          edges = prepared.setup.goal.edges](int leg, const Rigid3& pose) {
    const auto& of_leg = edges[static_cast<size_t>(leg)];
    return (of_leg[0] || of_leg[1]) && shows(leg, pose);
  };
}

JudgedLegSet Choose(PreparedServo& prepared, const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
                    ProgressLine& progress) {
  LegSelectionOptions options;
  options.cone_half_angle_rad = kAssumedDirectionNoise_rad;
  options.is_visible = ShownWithGoal(prepared, robot);
  LegSelection selection = SelectLegs(robot, from, to, options, [&](int judged, int of) {
    progress.Show(StageText("choosing legs", judged, of));
  });
  progress.Clear();
  if (!selection.has_choice)
    throw InputError(prepared.settings.model, 0,
                     "has no set of legs that is known to lead from here to the goal",
                     "see why with `legible legs`, or name legs with --legs");
  ControlLawOptions& law = prepared.setup.options.step.law;
  law.legs.reset();
  for (const int leg : selection.sets.front().legs) law.legs.set(static_cast<size_t>(leg));
  return std::move(selection.sets.front());
}

// Legs that were named.
JudgedLegSet JudgeNamed(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& from,
                        const Rigid3& to) {
  JudgedLegSet set;
  set.legs = legs;
  set.modes = AssemblyModesOf(robot, legs, to);
  set.path = CertifyStraightPath(robot, RobotKind::kHidden, legs, from, to);
  return set;
}

// "(0.012, -0.020, 0.310) m, turned by 38.1 deg"
std::string FromGoalText(const Rigid3& goal, const Rigid3& pose) {
  const Eigen::Vector3d& at = pose.translation;
  const double turned_rad = Displacement(goal, pose).tail<3>().norm();
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) m, turned by {:.1f} deg from the goal", at.x(), at.y(), at.z(),
                     turned_rad / kDegree_rad);
}

void WarnOfOtherModes(PreparedServo& prepared, const JudgedLegSet& set, const Rigid3& goal) {
  for (const AssemblyMode& mode : set.modes.modes) {
    const Rigid3& pose = mode.base_from_platform;
    if (Displacement(goal, pose).norm() < kSamePose || !IsReachable(prepared.setup.model.robot, pose))
      continue;
    prepared.warnings.push_back(fmt::format(
        "legs {} point as they do at the goal at {} as well: the servo may end there; see `legible legs`",
        LegNumbers(set.legs), FromGoalText(goal, pose)));
  }
  if (set.modes.status == AssemblyModesStatus::kIncomplete ||
      set.modes.status == AssemblyModesStatus::kInfinite)
    prepared.warnings.push_back(fmt::format("legs {} may point as they do at the goal elsewhere too: {}",
                                            LegNumbers(set.legs), set.modes.why));
}

void WarnOfWay(PreparedServo& prepared, const std::string& what, const PathCertificate& way) {
  if (way.verdict == PathVerdict::kFree) return;
  prepared.warnings.push_back(
      fmt::format("no singularity of {} is proved absent beyond {:.0f} % of the straight way to the goal: {}",
                  what, 100 * way.at, way.why));
}

}  // namespace

void SettleWatchedLegs(PreparedServo& prepared, ProgressLine& progress) {
  const ControlLawOptions& law = prepared.setup.options.step.law;
  const bool leads_legs = law.mode == ControlMode::kEdges || law.mode == ControlMode::kDirections;
  const auto refuse_auto = [&](const char* what) {
    if (prepared.settings.chooses_legs)
      throw InputError(prepared.settings.model, 0, what, "name legs with --legs");
  };
  if (!leads_legs) return refuse_auto("is not servoed by its legs in this mode: no legs can be chosen");
  const std::optional<Rigid3>& goal = prepared.setup.goal.base_from_platform;
  const std::optional<Rigid3> from = PoseNow(prepared);
  if (!goal || !from) return refuse_auto("leaves open where the robot or the goal is: no legs can be chosen");
  const ParallelRobot robot = ParallelRobotOf(prepared.setup.model.robot);
  const JudgedLegSet set = prepared.settings.chooses_legs ? Choose(prepared, robot, *from, *goal, progress)
                                                          : JudgeNamed(robot, Watched(law), *from, *goal);
  DemandGoal(prepared.setup.goal, law);
  if (set.verdict == LegSetVerdict::kArrives) prepared.warnings.push_back(NotProvedText(set.legs, set.why));
  WarnOfOtherModes(prepared, set, *goal);
  WarnOfWay(prepared, "what legs " + LegNumbers(set.legs) + " show", set.path);
  std::vector<int> every(kLegCount);
  std::iota(every.begin(), every.end(), 0);
  WarnOfWay(prepared, "the robot itself", CertifyStraightPath(robot, RobotKind::kReal, every, *from, *goal));
}

}  // namespace legible
