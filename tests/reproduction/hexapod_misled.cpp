#include "tests/reproduction/hexapod_misled.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "apps/wording.h"
#include "core/robots/mechanism.h"
#include "servo/leg_selection.h"
#include "tests/testing/hexapod_servo.h"

namespace legible {
namespace {

constexpr unsigned kSeed = 2016;
constexpr double kReach_m = 0.12, kTurn_rad = 0.9;        // about home, of goals
constexpr double kStart_m = 0.01, kStartTurn_rad = 0.05;  // about the other mode, of starts
constexpr double kElsewhere = 0.3;                        // m and rad from the goal, at least
constexpr int kChosenWays = 10;

Rigid3 Near(const Rigid3& pose, double reach_m, double turn_rad, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector6d step;
  for (double& coordinate : step) coordinate = uniform(random);
  step.head<3>() *= reach_m;
  step.tail<3>() *= turn_rad;
  return Displaced(pose, step);
}

std::vector<std::vector<int>> Threes() {
  std::vector<std::vector<int>> threes;
  for (int i = 0; i < kLegCount; ++i)
    for (int j = i + 1; j < kLegCount; ++j)
      for (int k = j + 1; k < kLegCount; ++k) threes.push_back({i, j, k});
  return threes;
}

DirectionServoRun Servo(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& from,
                        const Rigid3& to) {
  std::mt19937 no_noise(0);
  return SimulateDirectionServo(robot, legs, from, to, {}, no_noise);
}

bool StaysInRange(const GoughStewart& robot, const DirectionServoRun& run) {
  return std::all_of(run.samples.begin(), run.samples.end(), [&](const DirectionServoSample& sample) {
    return IsReachable(robot, sample.base_from_platform);
  });
}

// From near another mode of the goal: whether the servo ends there, within the joint ranges all the way.
std::optional<MisledWay> Misled(const GoughStewart& robot, const ParallelRobot& general,
                                const std::vector<int>& legs, const Rigid3& from, const Rigid3& to) {
  if (!IsReachable(robot, from)) return std::nullopt;
  const DirectionServoRun run = Servo(general, legs, from, to);
  const DirectionServoSample& last = run.samples.back();
  if (run.end != DirectionServoEnd::kConverged || !StaysInRange(robot, run)) return std::nullopt;
  if (Displacement(to, last.base_from_platform).norm() < kElsewhere) return std::nullopt;
  return MisledWay{legs, from, to, last.base_from_platform,
                   *std::max_element(last.errors_rad.begin(), last.errors_rad.end())};
}

std::string PoseText(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Vector3d w = VectorFromRotation(pose.rotation);
  return fmt::format("({:.4f}, {:.4f}, {:.4f}; {:.4f}, {:.4f}, {:.4f})", t.x(), t.y(), t.z(), w.x(), w.y(),
                     w.z());
}

std::string RowOf(const ParallelRobot& robot, const std::vector<int>& legs, const MisledWay& way,
                  const char* why) {
  const DirectionServoRun run = Servo(robot, legs, way.from, way.to);
  const DirectionServoSample& last = run.samples.back();
  const Vector6d off = Displacement(way.to, last.base_from_platform);
  return fmt::format("| {} | {} | {} | {:.1f} mm, {:.2f} rad | {:.2g} |\n", LegNumbers(legs, ", "), why,
                     PoseText(last.base_from_platform), 1e3 * off.head<3>().norm(), off.tail<3>().norm(),
                     *std::max_element(last.errors_rad.begin(), last.errors_rad.end()));
}

std::string OffText(const Rigid3& from, const Rigid3& to) {
  const Vector6d off = Displacement(from, to);
  return fmt::format("{:.2f} mm, {:.4f} rad", 1e3 * off.head<3>().norm(), off.tail<3>().norm());
}

std::string ErrorText(const ServoedHexapod& servoed) {
  return servoed.unit == "rad" ? fmt::format("{:.2f} mrad", 1e3 * servoed.final_error)
                               : fmt::format("{:.2f} {}", servoed.final_error, servoed.unit);
}

// What the warnings before it moved say of where else it may end.
std::string WarnedText(const ServoedHexapod& servoed) {
  std::string text;
  for (const Eigen::Vector3d& p : WarnedPositions_m(servoed.said))
    text += fmt::format("{}({:.3f}, {:.3f}, {:.3f})", text.empty() ? "" : "; ", p.x(), p.y(), p.z());
  return text.empty() ? "none" : text;
}

std::string RowByImages(const std::filesystem::path& folder, const MisledWay& way, const std::string& mode,
                        const std::string& legs) {
  const ServoedHexapod servoed =
      ServoHexapod(folder / (mode + "-" + legs), {way.from, way.to}, {"--mode", mode, "--legs", legs});
  return fmt::format("| {} | {}{} | {} | {}, {:.1f} s | {} | {} | {} | {} |\n", mode,
                     LegNumbers(servoed.legs, ", "), legs == "auto" ? " (chosen)" : "", WarnedText(servoed),
                     servoed.status, servoed.time_s, ErrorText(servoed), PoseText(servoed.true_end),
                     OffText(way.to, servoed.true_end), OffText(way.ends_at, servoed.true_end));
}

}  // namespace

std::optional<MisledWay> FindMisledWay(const GoughStewart& robot, int tries) {
  const ParallelRobot general = ParallelRobotOf(robot);
  std::mt19937 random(kSeed);
  for (int i = 0; i < tries; ++i) {
    const Rigid3 goal = Near(robot.home, kReach_m, kTurn_rad, random);
    if (!IsReachable(robot, goal)) continue;
    for (const std::vector<int>& legs : Threes())
      for (const AssemblyMode& mode : AssemblyModesOf(general, legs, goal).modes) {
        if (Displacement(goal, mode.base_from_platform).norm() < kElsewhere) continue;
        const Rigid3 from = Near(mode.base_from_platform, kStart_m, kStartTurn_rad, random);
        if (auto way = Misled(robot, general, legs, from, goal)) return way;
      }
  }
  return std::nullopt;
}

std::string MisledTable(const GoughStewart& robot, const MisledWay& way) {
  const ParallelRobot general = ParallelRobotOf(robot);
  const LegSelection selection = SelectLegs(general, way.from, way.to, {});
  std::string text = fmt::format(
      "From (x, y, z; rotation vector) {} to {}:\n\n"
      "| legs | | ends at | from the goal | largest error (rad) |\n| --- | --- | --- | --- | --- |\n",
      PoseText(way.from), PoseText(way.to));
  text += RowOf(general, way.legs, way, "misled");
  if (selection.has_choice)
    text += RowOf(general, selection.sets.front().legs, way, "the choice of `legible legs`");
  int possible = 0;
  for (const JudgedLegSet& set : selection.sets)
    if (set.verdict == LegSetVerdict::kPossible) ++possible;
  return text +
         fmt::format("\nOf the {} sets of legs {} are possible here.\n", selection.sets.size(), possible);
}

std::string OneAspectTable(const GoughStewart& robot, const MisledWay& way) {
  const ParallelRobot general = ParallelRobotOf(robot);
  std::string text =
      "| legs | ends at | from the goal | largest error (rad) | straight path to the goal | to where it ends "
      "|\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const JudgedLegSet& set : SelectLegs(general, way.from, way.to, {}).sets) {
    if (set.verdict != LegSetVerdict::kMisled) continue;
    const DirectionServoSample& last = set.simulated->samples.back();
    const PathCertificate there =
        CertifyStraightPath(general, RobotKind::kHidden, set.legs, way.from, last.base_from_platform);
    const auto path_text = [](const PathCertificate& path) {
      return fmt::format("{}, {} pieces", ToString(path.verdict), path.pieces);
    };
    text += fmt::format("| {} | {} | {} | {:.2g} | {} | {} |\n", LegNumbers(set.legs, ", "),
                        PoseText(last.base_from_platform), OffText(way.to, last.base_from_platform),
                        *std::max_element(last.errors_rad.begin(), last.errors_rad.end()),
                        path_text(set.path), path_text(there));
  }
  return text;
}

std::string MisledByImagesTable(const std::filesystem::path& folder, const MisledWay& way) {
  std::string text =
      "| mode | legs | warned of (m) | ended | error seen | true end | from the goal | from the other mode "
      "|\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const char* mode : {"directions", "edges"})
    for (const std::string& legs : {LegNumbers(way.legs), std::string("auto")})
      text += RowByImages(folder, way, mode, legs);
  return text;
}

std::string ChosenLegsTable(const std::filesystem::path& folder, const GoughStewart& robot) {
  const ParallelRobot general = ParallelRobotOf(robot);
  std::string text = fmt::format(
      "Seed {}.\n\n| from | to | chosen | other modes | ended | error seen | from the goal |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n",
      kHexapodWaysSeed);
  int number = 0;
  for (const HexapodWay& way : DrawHexapodWays(robot, kChosenWays)) {
    const ServoedHexapod servoed = ServoHexapod(folder / std::to_string(++number), way, {"--legs", "auto"});
    const AssemblyModes modes = AssemblyModesOf(general, servoed.legs, way.to);
    text +=
        fmt::format("| {} | {} | {} | {} | {}, {:.1f} s | {} | {} |\n", PoseText(way.from), PoseText(way.to),
                    LegNumbers(servoed.legs, ", "), modes.modes.size() - 1, servoed.status, servoed.time_s,
                    ErrorText(servoed), OffText(way.to, servoed.true_end));
  }
  return text;
}

}  // namespace legible
