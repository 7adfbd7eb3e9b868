#include "apps/watched_legs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/leg_visibility.h"
#include "apps/legs_settings.h"
#include "core/geometry/orientation.h"
#include "core/robots/mechanism.h"
#include "datasets/input_error.h"
#include "servo/leg_selection.h"

namespace legible {
namespace {

std::vector<int> Watched(const ControlLawOptions& law) {
  std::vector<int> legs;
  for (int leg = 0; leg < kLegCount; ++leg)
    if (law.legs[static_cast<size_t>(leg)]) legs.push_back(leg);
  return legs;
}

std::string LegList(std::vector<int> legs) {
  for (int& leg : legs) ++leg;
  return fmt::format("{}", fmt::join(legs, ","));
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

void Choose(PreparedServo& prepared, const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
            ProgressLine& progress) {
  const ServoModel& model = prepared.setup.model;
  LegSelectionOptions options;
  options.cone_half_angle_rad = kAssumedDirectionNoise_rad;
  options.is_visible = VisibilityOfLegs(robot, model.camera, model.camera_from_base);
  const LegSelection selection = SelectLegs(robot, from, to, options, [&](int judged, int of) {
    progress.Show(StageText("choosing legs", judged, of));
  });
  progress.Clear();
  if (!selection.has_choice)
    throw InputError(prepared.settings.model, 0, "has no set of legs that leads from here to the goal",
                     "see why with `legible legs`, or name legs with --legs");
  ControlLawOptions& law = prepared.setup.options.step.law;
  law.legs.reset();
  for (const int leg : selection.sets.front().legs) law.legs.set(static_cast<size_t>(leg));
}

// "(0.012, -0.020, 0.310) m, turned by 38.1 deg"
std::string FromGoalText(const Rigid3& goal, const Rigid3& pose) {
  const Eigen::Vector3d& at = pose.translation;
  const double turned_rad = Displacement(goal, pose).tail<3>().norm();
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) m, turned by {:.1f} deg from the goal", at.x(), at.y(), at.z(),
                     turned_rad / kDegree_rad);
}

void WarnOfOtherModes(PreparedServo& prepared, const ParallelRobot& robot, const std::vector<int>& legs,
                      const Rigid3& goal) {
  const AssemblyModes modes = AssemblyModesOf(robot, legs, goal);
  for (const AssemblyMode& mode : modes.modes) {
    const Rigid3& pose = mode.base_from_platform;
    if (Displacement(goal, pose).norm() < 1e-6 || !IsReachable(prepared.setup.model.robot, pose)) continue;
    prepared.warnings.push_back(fmt::format(
        "legs {} point as they do at the goal at {} as well: the servo may end there; see `legible legs`",
        LegList(legs), FromGoalText(goal, pose)));
  }
  if (modes.status == AssemblyModesStatus::kIncomplete)
    prepared.warnings.push_back(
        fmt::format("legs {} may point as they do at the goal elsewhere too: {}", LegList(legs), modes.why));
}

void WarnOfWay(PreparedServo& prepared, const ParallelRobot& robot, const std::vector<int>& legs,
               const Rigid3& from, const Rigid3& goal) {
  const PathCertificate way = CertifyStraightPath(robot, RobotKind::kHidden, legs, from, goal);
  if (way.verdict == PathVerdict::kFree) return;
  prepared.warnings.push_back(fmt::format(
      "what legs {} show is not proved to lead to the goal: {:.0f} % of the straight way there, {}",
      LegList(legs), 100 * way.at, way.why));
}

}  // namespace

void SettleWatchedLegs(PreparedServo& prepared, ProgressLine& progress) {
  const ControlLawOptions& law = prepared.setup.options.step.law;
  const bool watches = law.mode == ControlMode::kEdges || law.mode == ControlMode::kDirections;
  const std::optional<Rigid3>& goal = prepared.setup.goal.base_from_platform;
  if (!watches) return;
  const std::optional<Rigid3> from = PoseNow(prepared);
  if (!goal || !from) {
    if (prepared.settings.chooses_legs)
      throw InputError(prepared.settings.model, 0,
                       "leaves open where the robot or the goal is: no legs can be chosen",
                       "name legs with --legs");
    return;
  }
  const ParallelRobot robot = ParallelRobotOf(prepared.setup.model.robot);
  if (prepared.settings.chooses_legs) Choose(prepared, robot, *from, *goal, progress);
  const std::vector<int> legs = Watched(law);
  WarnOfOtherModes(prepared, robot, legs, *goal);
  WarnOfWay(prepared, robot, legs, *from, *goal);
}

}  // namespace legible
