#include "apps/accuracy_workspace.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr size_t kLeastPosesToCompare = 3;
constexpr size_t kComparedSamples = 400;
constexpr int kMapPoints = 61;  // along each axis

Rigid3 PoseOf(const OrientationConvention& orientation, const Eigen::Ref<const Eigen::VectorXd>& point) {
  return {orientation.ToRotation(point.tail<3>()), point.head<3>()};
}

// The first pose that the robot can take: the box lies about it.
const JudgedPose& BoxPose(const AccuracyRun& run) {
  return *std::find_if(run.poses.begin(), run.poses.end(),
                       [](const JudgedPose& pose) { return pose.accuracy.has_value(); });
}

// Over how large a turn the orientations of a box lie about its middle, at most: a rotation vector turns by
// no more than it changes, Euler angles by no more than their sum.
double TurnWithin(const Box& box, const OrientationConvention& orientation) {
  const Eigen::Vector3d half = (box.high - box.low).tail<3>() / 2;
  return orientation.IsRotationVector() ? half.norm() : half.sum();
}

Box BoxOf(const AccuracyRun& run, const BoxSetting& setting) {
  const JudgedPose& first = BoxPose(run);
  Box box{first.coordinates, first.coordinates};
  for (const auto& [coordinate, range] : setting.ranges) {
    box.low[coordinate] = range[0];
    box.high[coordinate] = range[1];
  }
  if (setting.is_reachable) {
    const Eigen::VectorXd middle = (box.low + box.high) / 2;
    const Rigid3 pose{run.settings.orientation.ToRotation(middle.tail<3>()), first.coordinates.head<3>()};
    const auto ranges = ReachableRanges(run.robot.mechanism, pose, TurnWithin(box, run.settings.orientation));
    if (!ranges)
      throw InputError(run.settings.model, 0, "has joint ranges that no place allows with this orientation",
                       "mend joint_range_m, or give --box ranges");
    for (int i = 0; i < 3; ++i) {
      if (setting.ranges.contains(i)) continue;
      box.low[i] = (*ranges)(i, 0);
      box.high[i] = (*ranges)(i, 1);
    }
  }
  return box;
}

WorkspaceErrorOptions EvaluatorOptions(const AccuracyRun& run, const LaidBox& laid) {
  WorkspaceErrorOptions options;
  options.joint_error_bounds = run.options.joint_error_bounds;
  options.characteristic_length_m = laid.characteristic_length_m;
  options.within_joint_ranges = laid.setting.is_reachable || run.settings.within_joint_ranges;
  options.in_aspect_of_home = laid.setting.is_reachable;
  options.threads = run.settings.threads;
  options.pose_of_point = [orientation =
                               run.settings.orientation](const Eigen::Ref<const Eigen::VectorXd>& point) {
    return PoseOf(orientation, point);
  };
  return options;
}

// One for the whole workspace: the given one, or the natural one of home or, where that is singular, of a
// pose given.
double LengthOf(const AccuracyRun& run) {
  if (run.options.characteristic_length_m) return *run.options.characteristic_length_m;
  std::vector<Rigid3> poses = {HomeOf(run.robot.mechanism)};
  for (const JudgedPose& pose : run.poses)
    if (pose.HasErrors()) poses.push_back(pose.base_from_platform);
  for (const Rigid3& pose : poses) {
    const auto jacobian = FullInverseJacobianOf(run.robot.mechanism, pose);
    if (Invert(jacobian).status != PoseStatus::kSingular) return NaturalLengths(jacobian).two_m;
  }
  throw InputError(run.settings.model, 0, "is singular at home, which has no natural length then",
                   "give --characteristic-length, or a pose that is not singular");
}

std::string OverText(const AccuracyRun& run, const BoxSetting& setting, const Box& box) {
  std::string text;
  for (const Eigen::Index i : box.FreeCoordinates())
    text +=
        fmt::format("{}{} {:.4g} to {:.4g} {}", text.empty() ? "" : ", ",
                    CoordinateNames()[static_cast<size_t>(i)], box.low[i], box.high[i], i < 3 ? "m" : "rad");
  if (setting.is_reachable || run.settings.within_joint_ranges) text += ", as far as the joint ranges allow";
  if (setting.is_reachable) text += ", on home's side of the singularities";
  return text + ", about " + BoxPose(run).name;
}

std::string PointName(const Box& box, const Eigen::VectorXd& point) {
  std::string name;
  for (const Eigen::Index i : box.FreeCoordinates())
    name += fmt::format("{}{}={:.3g}", name.empty() ? "" : " ", CoordinateNames()[static_cast<size_t>(i)],
                        point[i]);
  return name;
}

// All points of two coordinates' values, those of the first running fastest, the other coordinates held.
Eigen::MatrixXd MapPoints(const ErrorMap& map) {
  Eigen::MatrixXd points = map.held.replicate(1, map.first.size() * map.second.size());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points(map.axes[0], i) = map.first[i % map.first.size()];
    points(map.axes[1], i) = map.second[i / map.first.size()];
  }
  return points;
}

std::vector<bool> AreWithinJointRanges(const AccuracyRun& run, const Eigen::MatrixXd& points) {
  std::vector<bool> within;
  within.reserve(static_cast<size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    within.push_back(IsReachable(run.robot.mechanism, PoseOf(run.settings.orientation, points.col(i))));
  return within;
}

// Narrows both ranges to where the joint ranges allow a pose, and a little more.
void NarrowToReach(const AccuracyRun& run, ErrorMap& map) {
  constexpr double kMargin = 0.08;
  const Eigen::MatrixXd points = MapPoints(map);
  const std::vector<bool> within = AreWithinJointRanges(run, points);
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!within[static_cast<size_t>(i)]) continue;
    const Eigen::Array2d place(points(map.axes[0], i), points(map.axes[1], i));
    low = low.min(place);
    high = high.max(place);
  }
  if (!(low < high).all()) return;
  const Eigen::Array2d margin = kMargin * (high - low);
  map.first = Eigen::VectorXd::LinSpaced(kMapPoints, low[0] - margin[0], high[0] + margin[0]);
  map.second = Eigen::VectorXd::LinSpaced(kMapPoints, low[1] - margin[1], high[1] + margin[1]);
}

}  // namespace

std::optional<Comparison> ComparisonOver(const std::string& over, const std::vector<std::string>& names,
                                         const std::vector<const PoseAccuracy*>& poses) {
  if (poses.size() < kLeastPosesToCompare) return std::nullopt;
  return Comparison{over, names, CompareIndices(poses)};
}

LaidBox LayBox(const AccuracyRun& run, const BoxSetting& setting) {
  LaidBox laid{setting, BoxOf(run, setting), BoxPose(run).coordinates, "", LengthOf(run)};
  laid.over = OverText(run, setting, laid.box);
  return laid;
}

Workspace SampleBox(const AccuracyRun& run, const LaidBox& laid, ProgressLine& progress) {
  Workspace workspace;
  workspace.laid = laid;
  StatisticsOptions options;
  options.sampling = run.settings.sampling;
  try {
    options.sampling.Check(static_cast<int>(laid.box.FreeCoordinates().size()));
  } catch (const std::invalid_argument& error) {
    throw InputError(run.settings.model, 0, "cannot be sampled so", error.what());
  }
  options.progress = [&progress](int done, int total) {
    progress.Show(StageText("sampling the workspace", done, total));
  };
  workspace.statistics =
      SampleWorkspace(laid.box, options, ErrorEvaluator(run.robot.mechanism, EvaluatorOptions(run, laid)));
  if (workspace.statistics.quantities.empty()) return workspace;
  const QuantityStatistics& determinant = workspace.statistics.quantities[kDeterminantRow];
  workspace.crosses_singularity = (determinant.smallest_seen < 0 && determinant.largest_seen > 0) ||
                                  workspace.statistics.singular + workspace.statistics.near_singular > 0;
  return workspace;
}

// Poses of the box that count, by Sobol's sequence.
std::optional<Comparison> CompareInBox(const AccuracyRun& run, const LaidBox& laid, ProgressLine& progress) {
  const Box& box = laid.box;
  const auto dimension = static_cast<int>(box.FreeCoordinates().size());
  const Sampling sampling{SamplingRule::kSobol, kReplicates * 128 * kComparedSamples,
                          run.settings.sampling.seed};
  const Eigen::MatrixXd points = InBox(box, UnitCubePoints(sampling, dimension, 0).points);
  const auto evaluate = ErrorEvaluator(run.robot.mechanism, EvaluatorOptions(run, laid));
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
  std::vector<const PoseAccuracy*> compared(poses.size());
  std::transform(poses.begin(), poses.end(), compared.begin(),
                 [](const PoseAccuracy& pose) { return &pose; });
  return ComparisonOver(fmt::format("{} poses of the box {}", poses.size(), laid.over), names, compared);
}

std::optional<ErrorMap> MapOf(const AccuracyRun& run, const LaidBox& laid) {
  const Box& box = laid.box;
  const std::vector<Eigen::Index> free = box.FreeCoordinates();
  if (free.size() < 2) return std::nullopt;
  ErrorMap map;
  map.axes = {static_cast<int>(free[0]), static_cast<int>(free[1])};
  map.first = Eigen::VectorXd::LinSpaced(kMapPoints, box.low[free[0]], box.high[free[0]]);
  map.second = Eigen::VectorXd::LinSpaced(kMapPoints, box.low[free[1]], box.high[free[1]]);
  map.held = laid.about.cwiseMax(box.low).cwiseMin(box.high);
  WorkspaceErrorOptions options = EvaluatorOptions(run, laid);
  options.in_aspect_of_home = options.within_joint_ranges = false;
  if (laid.setting.is_reachable) NarrowToReach(run, map);
  const Eigen::MatrixXd points = MapPoints(map);
  map.values = ErrorEvaluator(run.robot.mechanism, options)(points);
  map.is_within_joint_ranges = AreWithinJointRanges(run, points);
  return map;
}

}  // namespace legible
