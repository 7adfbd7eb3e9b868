#include "apps/accuracy_run.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "apps/accuracy_input.h"
#include "apps/accuracy_workspace.h"
#include "apps/wording.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

// A motion that is free, in words: "turn about (1, 0, 0)".
std::string MotionText(const PlatformJacobian& jacobian, const Eigen::VectorXd& motion) {
  const Eigen::Vector3d shift = LinearPart(motion, jacobian.linear),
                        turn = AngularPart(motion, jacobian.linear);
  const auto triple = [](const Eigen::Vector3d& v) {
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
  };
  constexpr double kTiny = 1e-4;  // beside 1
  const auto clean = [](Eigen::Vector3d v) {
    for (double& x : v)
      if (std::abs(x) < kTiny) x = 0;
    return v;
  };
  if (turn.norm() < kTiny) return "move along " + triple(clean(shift));
  const std::string text = "turn about " + triple(clean(turn));
  return shift.norm() < kTiny ? text : text + " while it moves by " + triple(clean(shift)) + " m a radian";
}

std::string SingularText(const PlatformJacobian& jacobian) {
  std::string text = "with all joints locked the platform can still ";
  for (size_t i = 0; i < jacobian.free_motions.size(); ++i)
    text += (i == 0 ? "" : ", and ") + MotionText(jacobian, jacobian.free_motions[i]);
  return text;
}

void Judge(const AccuracyRun& run, JudgedPose& pose) {
  if (!pose.status.empty()) return;
  pose.accuracy = AccuracyAt(run.robot, pose.base_from_platform, run.options);
  const PlatformJacobian& jacobian = pose.accuracy->jacobian;
  pose.status = ToString(jacobian.status);
  if (jacobian.status == PoseStatus::kSingular) pose.message = SingularText(jacobian);
  if (jacobian.status == PoseStatus::kNearSingular)
    pose.message = "close to a singularity: small joint errors move the platform far";
}

void JudgePoses(AccuracyRun& run, ProgressLine& progress) {
  std::atomic<int> done = 0;
  tbb::task_arena(run.settings.threads).execute([&] {
    tbb::parallel_for(size_t{0}, run.poses.size(), [&](size_t i) {
      Judge(run, run.poses[i]);
      progress.Show(StageText("judging poses", ++done, static_cast<int>(run.poses.size())));
    });
  });
}

void DemandSomeReachable(const AccuracyRun& run) {
  if (std::any_of(run.poses.begin(), run.poses.end(),
                  [](const JudgedPose& pose) { return pose.status.empty(); }))
    return;
  const JudgedPose& first = run.poses.front();
  throw InputError(run.settings.model, 0,
                   fmt::format("cannot reach {}{}: {}", run.poses.size() > 1 ? "any of the poses; " : "",
                               first.name, first.message),
                   "give poses within the joint ranges, in metres and radians");
}

std::optional<Comparison> CompareGiven(const std::vector<JudgedPose>& poses) {
  std::vector<std::string> names;
  std::vector<const PoseAccuracy*> compared;
  for (const JudgedPose& pose : poses)
    if (pose.HasErrors()) names.push_back(pose.name), compared.push_back(&*pose.accuracy);
  return ComparisonOver(fmt::format("the {} given", Plural(static_cast<int>(names.size()), "pose")), names,
                        compared);
}

void JudgeBox(AccuracyRun& run, ProgressLine& progress) {
  const bool is_page = run.settings.format == AccuracyFormat::kHtml;
  run.comparison = CompareGiven(run.poses);
  if (!run.settings.box && !is_page) return;
  const LaidBox laid = LayBox(run, run.settings.box.value_or(BoxSetting{true, {}}));
  if (run.settings.box || !run.comparison) run.comparison = CompareInBox(run, laid, progress);
  if (run.settings.box) run.workspace = SampleBox(run, laid, progress);
  if (is_page) run.map = MapOf(run, laid);
}

}  // namespace

bool AccuracyRun::HasErrors() const {
  if (workspace && !workspace->statistics.quantities.empty()) return true;
  return std::any_of(poses.begin(), poses.end(), [](const JudgedPose& pose) { return pose.HasErrors(); });
}

AccuracyRun JudgeAccuracy(const AccuracySettings& settings, ProgressLine& progress) {
  AccuracyRun run;
  run.settings = settings;
  run.robot = ReadJudgedRobot(settings);
  run.options = PoseOptionsOf(settings, run.robot);
  run.poses = PosesToJudge(settings, run.robot);
  DemandSomeReachable(run);
  JudgePoses(run, progress);
  JudgeBox(run, progress);
  return run;
}

}  // namespace legible
