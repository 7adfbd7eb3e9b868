#include "apps/accuracy_run.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "apps/accuracy_input.h"
#include "apps/wording.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr size_t kLeastPosesToCompare = 3;
constexpr size_t kComparedSamples = 400;
constexpr int kMapPoints = 61;  // along each axis

// --- Poses.
// ----------------------------------------------------------------------------------------------------------

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
    pose.message = "so close to a singularity that errors in first order mean little";
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

// --- Workspace.
// ------------------------------------------------------------------------------------------------------

Rigid3 PoseOf(const OrientationConvention& orientation, const Eigen::Ref<const Eigen::VectorXd>& point) {
  return {orientation.ToRotation(point.tail<3>()), point.head<3>()};
}

// Around the first pose; "reachable" where nothing else is asked for.
Box BoxOf(const AccuracyRun& run, const BoxSetting& setting) {
  const JudgedPose& first = run.poses.front();
  Box box{first.coordinates, first.coordinates};
  if (setting.is_reachable) {
    const auto ranges = ReachableRanges(run.robot.mechanism, first.base_from_platform);
    if (!ranges)
      throw InputError(run.settings.model, 0, "has joint ranges that no place allows with this orientation",
                       "mend joint_range_m, or give --box ranges");
    box.low.head<3>() = ranges->col(0);
    box.high.head<3>() = ranges->col(1);
  }
  for (const auto& [coordinate, range] : setting.ranges) {
    box.low[coordinate] = range[0];
    box.high[coordinate] = range[1];
  }
  return box;
}

WorkspaceErrorOptions EvaluatorOptions(const AccuracyRun& run, const BoxSetting& setting, double length_m) {
  WorkspaceErrorOptions options;
  options.joint_error_bounds = run.options.joint_error_bounds;
  options.characteristic_length_m = length_m;
  options.within_joint_ranges = setting.is_reachable || run.settings.within_joint_ranges;
  options.in_aspect_of_home = setting.is_reachable;
  options.threads = run.settings.threads;
  options.pose_of_point = [orientation =
                               run.settings.orientation](const Eigen::Ref<const Eigen::VectorXd>& point) {
    return PoseOf(orientation, point);
  };
  return options;
}

// The given length, or home's natural one: one for the whole workspace.
double LengthOf(const AccuracyRun& run) {
  if (run.options.characteristic_length_m) return *run.options.characteristic_length_m;
  const auto home = FullInverseJacobianOf(run.robot.mechanism, HomeOf(run.robot.mechanism));
  return Invert(home).status == PoseStatus::kSingular ? 1 : NaturalLengths(home).two_m;
}

std::string OverText(const AccuracyRun& run, const BoxSetting& setting, const Box& box) {
  std::string text;
  for (const Eigen::Index i : box.FreeCoordinates())
    text +=
        fmt::format("{}{} {:.4g} to {:.4g} {}", text.empty() ? "" : ", ",
                    CoordinateNames()[static_cast<size_t>(i)], box.low[i], box.high[i], i < 3 ? "m" : "rad");
  if (setting.is_reachable || run.settings.within_joint_ranges) text += ", as far as the joint ranges allow";
  if (setting.is_reachable) text += " without crossing a singularity";
  return text;
}

Workspace SampleBox(const AccuracyRun& run, const BoxSetting& setting, ProgressLine& progress) {
  Workspace workspace;
  workspace.box = BoxOf(run, setting);
  workspace.over = OverText(run, setting, workspace.box);
  workspace.characteristic_length_m = LengthOf(run);
  StatisticsOptions options;
  options.sampling = run.settings.sampling;
  options.progress = [&progress](int done, int total) {
    progress.Show(StageText("sampling the workspace", done, total));
  };
  workspace.statistics = SampleWorkspace(
      workspace.box, options,
      ErrorEvaluator(run.robot.mechanism, EvaluatorOptions(run, setting, workspace.characteristic_length_m)));
  if (workspace.statistics.quantities.empty()) return workspace;
  const QuantityStatistics& determinant = workspace.statistics.quantities[kDeterminantRow];
  workspace.crosses_singularity = determinant.smallest_seen < 0 && determinant.largest_seen > 0;
  return workspace;
}

// --- Indices against errors.
// --------------------------------------------------------------------------------------

std::optional<Comparison> Compared(const std::string& over, const std::vector<std::string>& names,
                                   const std::vector<const PoseAccuracy*>& poses) {
  if (poses.size() < kLeastPosesToCompare) return std::nullopt;
  return Comparison{over, names, CompareIndices(poses)};
}

std::optional<Comparison> CompareGiven(const std::vector<JudgedPose>& poses) {
  std::vector<std::string> names;
  std::vector<const PoseAccuracy*> compared;
  for (const JudgedPose& pose : poses)
    if (pose.HasErrors()) names.push_back(pose.name), compared.push_back(&*pose.accuracy);
  return Compared(fmt::format("the {} given", Plural(static_cast<int>(names.size()), "pose")), names,
                  compared);
}

std::string PointName(const Box& box, const Eigen::VectorXd& point) {
  std::string name;
  for (const Eigen::Index i : box.FreeCoordinates())
    name += fmt::format("{}{}={:.3g}", name.empty() ? "" : " ", CoordinateNames()[static_cast<size_t>(i)],
                        point[i]);
  return name;
}

// Poses of the box that count, by Sobol's sequence.
std::optional<Comparison> CompareInBox(const AccuracyRun& run, const BoxSetting& setting,
                                       ProgressLine& progress) {
  const Box box = BoxOf(run, setting);
  const auto dimension = static_cast<int>(box.FreeCoordinates().size());
  const Sampling sampling{SamplingRule::kSobol, kReplicates * 128 * kComparedSamples,
                          run.settings.sampling.seed};
  const Eigen::MatrixXd points = InBox(box, UnitCubePoints(sampling, dimension, 0).points);
  const auto evaluate = ErrorEvaluator(run.robot.mechanism, EvaluatorOptions(run, setting, LengthOf(run)));
  const BatchValues batch = evaluate(points);
  std::vector<std::string> names;
  std::vector<PoseAccuracy> poses;
  for (Eigen::Index i = 0; i < points.cols() && poses.size() < kComparedSamples; ++i) {
    if (batch.states[static_cast<size_t>(i)] != PointState::kInside) continue;
    const Rigid3 pose = PoseOf(run.settings.orientation, points.col(i));
    poses.push_back(QuickAccuracyAt(run.robot, pose, run.options));
    names.push_back(PointName(box, points.col(i)));
    progress.Show(
        StageText("comparing indices with errors, pose", static_cast<int>(poses.size()), kComparedSamples));
  }
  std::vector<const PoseAccuracy*> compared;
  for (const PoseAccuracy& pose : poses) compared.push_back(&pose);
  return Compared(fmt::format("{} poses of the box {}", poses.size(), OverText(run, setting, box)), names,
                  compared);
}

// --- Maps.
// ------------------------------------------------------------------------------------------------------------

// All points of two coordinates' values, those of the first running fastest, the other coordinates held.
Eigen::MatrixXd MapPoints(const ErrorMap& map) {
  Eigen::MatrixXd points = map.held.replicate(1, map.first.size() * map.second.size());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points(map.axes[0], i) = map.first[i % map.first.size()];
    points(map.axes[1], i) = map.second[i / map.first.size()];
  }
  return points;
}

// Narrows both ranges to where the joint ranges allow a pose, and a little more.
void NarrowToReach(const BatchEvaluator& evaluate, ErrorMap& map) {
  constexpr double kMargin = 0.08;
  const Eigen::MatrixXd points = MapPoints(map);
  const std::vector<PointState> states = evaluate(points).states;
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (states[static_cast<size_t>(i)] == PointState::kOutside) continue;
    const Eigen::Array2d place(points(map.axes[0], i), points(map.axes[1], i));
    low = low.min(place);
    high = high.max(place);
  }
  if (!(low < high).all()) return;
  const Eigen::Array2d margin = kMargin * (high - low);
  map.first = Eigen::VectorXd::LinSpaced(kMapPoints, low[0] - margin[0], high[0] + margin[0]);
  map.second = Eigen::VectorXd::LinSpaced(kMapPoints, low[1] - margin[1], high[1] + margin[1]);
}

// Over the first two coordinates that the box leaves free, the others as in the first pose or, where that is
// outside, at the end of the box next to it.
std::optional<ErrorMap> MapOf(const AccuracyRun& run, const BoxSetting& setting) {
  const Box box = BoxOf(run, setting);
  const std::vector<Eigen::Index> free = box.FreeCoordinates();
  if (free.size() < 2) return std::nullopt;
  ErrorMap map;
  map.axes = {static_cast<int>(free[0]), static_cast<int>(free[1])};
  map.first = Eigen::VectorXd::LinSpaced(kMapPoints, box.low[free[0]], box.high[free[0]]);
  map.second = Eigen::VectorXd::LinSpaced(kMapPoints, box.low[free[1]], box.high[free[1]]);
  map.held = run.poses.front().coordinates.cwiseMax(box.low).cwiseMin(box.high);
  WorkspaceErrorOptions options = EvaluatorOptions(run, setting, LengthOf(run));
  options.in_aspect_of_home = options.within_joint_ranges = false;
  const BatchEvaluator anywhere = ErrorEvaluator(run.robot.mechanism, options);
  options.within_joint_ranges = true;
  const BatchEvaluator in_reach = ErrorEvaluator(run.robot.mechanism, options);
  if (setting.is_reachable) NarrowToReach(in_reach, map);
  const Eigen::MatrixXd points = MapPoints(map);
  map.values = anywhere(points);
  for (const PointState state : in_reach(points).states)
    map.is_within_joint_ranges.push_back(state != PointState::kOutside);
  return map;
}

void JudgeBox(AccuracyRun& run, ProgressLine& progress) {
  const bool is_page = run.settings.format == AccuracyFormat::kHtml;
  run.comparison = CompareGiven(run.poses);
  if (!run.settings.box && !is_page) return;
  const BoxSetting setting = run.settings.box.value_or(BoxSetting{true, {}});
  if (run.settings.box || !run.comparison) run.comparison = CompareInBox(run, setting, progress);
  if (run.settings.box) run.workspace = SampleBox(run, setting, progress);
  if (is_page) run.map = MapOf(run, setting);
}

}  // namespace

bool AccuracyRun::HasErrors() const {
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
