#include "tests/reproduction/quattro.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <unsupported/Eigen/NonLinearOptimization>

#include "apps/wording.h"
#include "core/geometry/orientation.h"
#include "core/hidden/assembly_modes.h"
#include "core/hidden/cone_noise.h"
#include "core/hidden/path_certificate.h"
#include "core/hidden/singularity_conditions.h"
#include "datasets/parallel_robot_file.h"
#include "servo/direction_simulation.h"

namespace legible {
namespace {

using Legs = std::vector<int>;

constexpr double kPaperNoise_rad = 0.1 * kDegree_rad;
constexpr int kNoisyRuns = 200;
constexpr unsigned kSeed = 2016;
constexpr int kDrawnPairs = 4000;
const Legs kAllLegs = {0, 1, 2, 3};

Rigid3 At(double x_m, double y_m, double z_m) { return {Eigen::Quaterniond::Identity(), {x_m, y_m, z_m}}; }

std::string LegList(const Legs& legs) { return fmt::format("{{{}}}", LegNumbers(legs, ", ")); }

double Turn_rad(const Rigid3& pose) { return VectorFromRotation(pose.rotation).z(); }

// Coordinates of the nearest modes less the published ones.
class ModeDifferences {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  static int inputs() { return 3; }
  static int values() { return 3 * static_cast<int>(PublishedModes().size()); }

  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& differences) const {
    const ParallelRobot robot = Quattro({parameters[0], parameters[1], parameters[2]});
    const std::vector<PublishedMode> published = PublishedModes();
    for (size_t i = 0; i < published.size(); ++i)
      differences.segment<3>(static_cast<Eigen::Index>(3 * i)) =
          NearestMode(robot, published[i]).translation - published[i].position_m;
    return 0;
  }
};

struct Motion {
  Legs legs;
  Rigid3 from, to;
  std::string published;
};

DirectionServoRun Simulate(const ParallelRobot& robot, const Motion& motion) {
  std::mt19937 random(kSeed);
  return SimulateDirectionServo(robot, motion.legs, motion.from, motion.to, {}, random);
}

std::string PositionText(const Eigen::Vector3d& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x(), p.y(), p.z());
}

// Over noisy runs, where each ends: root mean square and largest distance from the goal.
struct Spread {
  double rms_m = 0, largest_m = 0, rms_rad = 0, largest_rad = 0;
};

Spread SpreadAtGoal(const ParallelRobot& robot, const Motion& motion) {
  std::mt19937 random(kSeed);
  DirectionServoOptions options;
  options.cone_half_angle_rad = kPaperNoise_rad;
  options.longest_s = 12;
  options.step_s = 0.05;
  Spread spread;
  for (int run = 0; run < kNoisyRuns; ++run) {
    const auto simulated =
        SimulateDirectionServo(robot, motion.legs, motion.from, motion.to, options, random);
    const Vector6d off = Displacement(motion.to, simulated.samples.back().base_from_platform);
    const double position_m = off.head<3>().norm(), rotation_rad = off.tail<3>().norm();
    spread.rms_m += position_m * position_m / kNoisyRuns;
    spread.rms_rad += rotation_rad * rotation_rad / kNoisyRuns;
    spread.largest_m = std::max(spread.largest_m, position_m);
    spread.largest_rad = std::max(spread.largest_rad, rotation_rad);
  }
  spread.rms_m = std::sqrt(spread.rms_m);
  spread.rms_rad = std::sqrt(spread.rms_rad);
  return spread;
}

std::optional<Rigid3> DrawReachable(const ParallelRobot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x_m = 0.65 * uniform(random), y_m = 0.65 * uniform(random),
               z_m = -0.75 + 0.3 * uniform(random);
  if (!Type1MeasureOf(robot, kAllLegs, At(x_m, y_m, z_m))) return std::nullopt;
  return At(x_m, y_m, z_m);
}

// How many servos ended so, and the first of them that was clearly off.
struct Ends {
  int count = 0;
  std::string example;
};

std::string EndText(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
                    const DirectionServoRun& run) {
  const DirectionServoSample& last = run.samples.back();
  const Rigid3& pose = last.base_from_platform;
  const auto type1 = Type1MeasureOf(robot, kAllLegs, pose);
  const auto type2 = Type2MeasureOf(robot, RobotKind::kHidden, kAllLegs, pose);
  return fmt::format("{} to {}: {}, φ {:.0f} deg, {:.3f} | {:.2g} | {:.2g}", PositionText(from.translation),
                     PositionText(to.translation), PositionText(pose.translation),
                     Turn_rad(pose) / kDegree_rad,
                     *std::max_element(last.errors_rad.begin(), last.errors_rad.end()), type1.value_or(0),
                     type2 ? type2->matrix : 0);
}

}  // namespace

std::string EndsTable(const ParallelRobot& robot) {
  std::mt19937 random(kSeed);
  std::map<DirectionServoEnd, Ends> ends;
  for (int i = 0; i < kDrawnPairs; ++i) {
    const auto from = DrawReachable(robot, random), to = DrawReachable(robot, random);
    if (!from || !to) continue;
    const DirectionServoRun run = SimulateDirectionServo(robot, kAllLegs, *from, *to, {}, random);
    Ends& of = ends[run.end];
    ++of.count;
    if (run.end != DirectionServoEnd::kConverged && of.example.empty())
      of.example = EndText(robot, *from, *to, run);
  }
  std::string text =
      "| end | how many | first: from, to (m): where, largest error (rad) | \\|u · t\\| there | smallest of "
      "largest singular "
      "value there |\n| --- | --- | --- | --- | --- |\n";
  for (const auto& [end, of] : ends)
    text +=
        fmt::format("| {} | {} | {} |\n", ToString(end), of.count, of.example.empty() ? " | | " : of.example);
  return text;
}

ParallelRobot Quattro(const QuattroPlatform& platform) {
  constexpr std::array<std::array<double, 2>, 4> kFromD_m = {
      {{-0.066, -0.048}, {0.066, -0.048}, {0.066, 0.048}, {-0.066, 0.048}}};
  static const ParallelRobot kShipped = ReadParallelRobot(LEGIBLE_SOURCE_DIR "/datasets/robots/quattro.yaml");
  ParallelRobot robot = kShipped;
  for (size_t i = 0; i < 4; ++i) {
    const bool is_on_second_half = i >= 2;
    const double d_y_m = is_on_second_half ? platform.y_m - platform.arm_m : -platform.y_m;
    robot.legs[i].carried_offset_m = {platform.x_m + kFromD_m[i][0], d_y_m + kFromD_m[i][1], 0};
    robot.legs[i].platform_joint_m = {0, is_on_second_half ? platform.arm_m : 0, 0};
  }
  return robot;
}

std::vector<PublishedMode> PublishedModes() {
  return {{{0, 3}, {-0.2, 0, -0.909}}, {{0, 3}, {-0.138, 0.062, -1.019}}, {{0, 3}, {-0.138, 0.062, -0.45}},
          {{1, 2}, {-0.2, 0, -0.296}}, {{1, 2}, {-0.262, 0.062, -0.694}}, {{1, 2}, {-0.262, 0.062, -0.161}}};
}

Rigid3 NearestMode(const ParallelRobot& robot, const PublishedMode& published) {
  const AssemblyModes modes =
      AssemblyModesOf(robot, published.legs, {Eigen::Quaterniond::Identity(), kPublishedGoal_m});
  const auto nearest = std::min_element(
      modes.modes.begin(), modes.modes.end(), [&](const AssemblyMode& a, const AssemblyMode& b) {
        return (a.base_from_platform.translation - published.position_m).norm() <
               (b.base_from_platform.translation - published.position_m).norm();
      });
  return nearest->base_from_platform;
}

FittedPlatform FitPlatform(const QuattroPlatform& start) {
  Eigen::VectorXd parameters = Eigen::Vector3d(start.x_m, start.y_m, start.arm_m);
  Eigen::NumericalDiff<ModeDifferences, Eigen::Central> differences;
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<ModeDifferences, Eigen::Central>> solver(differences);
  solver.minimize(parameters);
  return {{parameters[0], parameters[1], parameters[2]},
          solver.fnorm / std::sqrt(static_cast<double>(ModeDifferences::values()))};
}

std::string ModesTable(const ParallelRobot& robot) {
  std::string text =
      "| legs | published (m) | here (m) | difference (mm) | φ here (deg) |\n| --- | --- | --- | --- | --- "
      "|\n";
  for (const PublishedMode& published : PublishedModes()) {
    const Rigid3 mode = NearestMode(robot, published);
    const Eigen::Vector3d off_mm = 1e3 * (mode.translation - published.position_m);
    text += fmt::format("| {} | {} | {} | {:.1f}, {:.1f}, {:.1f} | {:.1f} |\n", LegList(published.legs),
                        PositionText(published.position_m), PositionText(mode.translation), off_mm.x(),
                        off_mm.y(), off_mm.z(), std::abs(Turn_rad(mode)) / kDegree_rad);
  }
  return text;
}

std::string ConvergenceTable(const ParallelRobot& robot) {
  const Rigid3 goal{Eigen::Quaterniond::Identity(), kPublishedGoal_m};
  const std::vector<Motion> motions = {
      {{0, 3}, At(0, 0, -0.75), goal, "(-0.2, 0, -0.909), errors 0"},
      {{1, 2}, At(0, 0, -0.75), goal, "the goal"},
      {{0, 1, 2, 3}, At(0.05, 0.05, -0.8), At(0.03, 0.03, -0.59), "(0.03, 0.03, -0.65), errors 0"},
      {{0, 1, 2, 3}, At(0.028, 0, -0.617), At(-0.6, 0, -0.8), "(-0.588, 0, -0.847), at the boundary"}};
  std::string text =
      "| legs | from (m) | to (m) | published end (m) | end here (m) | why | time (s) | largest error (mrad) "
      "| straight way |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Motion& motion : motions) {
    const DirectionServoRun run = Simulate(robot, motion);
    const DirectionServoSample& last = run.samples.back();
    const PathCertificate way =
        CertifyStraightPath(robot, RobotKind::kHidden, motion.legs, motion.from, motion.to);
    text +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {:.1f} | {:.2g} | {} |\n", LegList(motion.legs),
                    PositionText(motion.from.translation), PositionText(motion.to.translation),
                    motion.published, PositionText(last.base_from_platform.translation), ToString(run.end),
                    last.time_s, 1e3 * *std::max_element(last.errors_rad.begin(), last.errors_rad.end()),
                    way.verdict == PathVerdict::kFree ? "free" : way.why);
  }
  return text;
}

std::string AccuracyTable(const ParallelRobot& robot) {
  const Rigid3 first_start = At(0.02, 0.1, -0.7), first_goal = At(-0.2, 0.01, -0.7);
  const Rigid3 second_start = At(0.05, 0.05, -0.8), second_goal = At(0.03, 0.03, -0.65);
  const std::vector<Motion> motions = {{{1, 2}, first_start, first_goal, "3 mm, 0.05 rad"},
                                       {{1, 3}, first_start, first_goal, "7 mm, 0.07 rad"},
                                       {{0, 3}, second_start, second_goal, "as three legs"},
                                       {{0, 2, 3}, second_start, second_goal, "as two legs"},
                                       {{0, 1, 2, 3}, second_start, second_goal, "the least"}};
  std::string text =
      "| legs | goal (m) | published | largest by eq. A.2 | simulated: rms | simulated: largest |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const Motion& motion : motions) {
    const auto largest = LargestErrorByConeNoise(robot, motion.legs, motion.to, kPaperNoise_rad);
    const Spread spread = SpreadAtGoal(robot, motion);
    text += fmt::format(
        "| {} | {} | {} | {:.2f} mm, {:.3f} rad | {:.2f} mm, {:.4f} rad | {:.2f} mm, {:.4f} rad |\n",
        LegList(motion.legs), PositionText(motion.to.translation), motion.published,
        1e3 * largest->position_m, largest->rotation_rad, 1e3 * spread.rms_m, spread.rms_rad,
        1e3 * spread.largest_m, spread.largest_rad);
  }
  return text;
}

}  // namespace legible
