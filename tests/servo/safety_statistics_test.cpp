// Ten thousand servos on simulated rigs of every kind, most of them with a fault: what must hold for each.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "core/rig/simulated_edges.h"
#include "core/rig/simulated_rig.h"
#include "core/stopwatch.h"
#include "tests/servo/random_servo_trial.h"
#include "tests/testing/hexapod_view.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kRuns = 10000;
constexpr double kSettling_s = 1.5;  // until nothing coasts any more
constexpr double kFirstImage_s = 1.04;
constexpr double kFrozen_s = 5;
constexpr double kPeriod_s = 0.02;  // of camera and loop

// The rig's images as the model's camera reads them.
class EdgesThroughModel : public EdgeSource {
 public:
  EdgesThroughModel(SimulatedRig& rig, const Camera& model) : edges_(rig), rig_(rig), model_(model) {}
  SeenEdges See(const MotionNow& motion) override {
    return ThroughModel(edges_.See(motion), rig_.truth().camera, model_);
  }

 private:
  SimulatedEdges edges_;
  SimulatedRig& rig_;
  Camera model_;
};

struct Outcome {
  ServoTrial trial;
  ServoRun run;
  double end_s = 0;    // of the rig's clock
  TrueMotion at_rest;  // after it
  bool was_out_of_range = false, was_too_fast = false, still_moves = false;
};

bool IsOutOfRange(const GoughStewart& robot, const Vector6d& readings_m) {
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] < shortest_m || readings_m[i] > longest_m) return true;
  }
  return false;
}

void LetSettle(SimulatedRig& rig) {
  try {
    rig.WaitUntil(rig.true_time_s() + kSettling_s);
  } catch (const RigError&) {
  }
}

Outcome RunOf(const ServoTrial& trial) {
  Outcome outcome;
  outcome.trial = trial;
  SimulatedRig rig(trial.truth, trial.simulation);
  EdgesThroughModel source(rig, trial.model.camera);
  ServoController controller(trial.model, trial.goal, trial.options);
  const double limit = trial.options.step.limits.speed_limit_m_per_s;
  const auto watch = [&](const ServoCycle& cycle) {
    outcome.was_too_fast |= cycle.output.joint_speeds_m_per_s.cwiseAbs().maxCoeff() > limit;
    outcome.was_out_of_range |= IsOutOfRange(trial.truth.robot, rig.true_motion().joint_readings_m);
  };
  ServoLoopOptions loop;
  loop.period_s = kPeriod_s;
  outcome.run = RunServo(rig, source, controller, loop, watch);
  outcome.end_s = rig.true_time_s();
  LetSettle(rig);
  outcome.at_rest = rig.true_motion();
  outcome.still_moves = outcome.at_rest.joint_speeds_m_per_s.cwiseAbs().maxCoeff() > 1e-12;
  for (const bool hit : rig.drives().hit_end_stop()) outcome.was_out_of_range |= hit;
  outcome.was_out_of_range |= IsOutOfRange(trial.truth.robot, outcome.at_rest.joint_readings_m);
  outcome.was_too_fast |=
      rig.drives().was_commanded_too_fast() || rig.drives().largest_speed_m_per_s() > limit + 1e-12;
  return outcome;
}

// Ends and words that name a fault.
struct Naming {
  ServoEnd end;
  std::string words;
};
std::vector<Naming> NamingsOf(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::kFramesDropped:
      return {{ServoEnd::kStaleImages, "no fresh image"}, {ServoEnd::kStaleImages, "no image has come"}};
    case FaultKind::kFramesLate:
      return {{ServoEnd::kStaleImages, "no fresh image"}};
    case FaultKind::kFramesFrozen:
      return {{ServoEnd::kFrozenImages, "the images have not changed"}};
    case FaultKind::kLegCovered:
      return {{ServoEnd::kTooFewEdges, "not seen"},
              {ServoEnd::kIllConditionedEdges, "not seen"},
              {ServoEnd::kNoPose, "not seen"}};
    case FaultKind::kReadingsNan:
      return {{ServoEnd::kBadReadings, "are not numbers"}};
    case FaultKind::kReadingsFrozen:
      return {{ServoEnd::kFrozenReadings, "the joint readings have not changed"},
              {ServoEnd::kDrivesDoNotMove, "or the joint readings are frozen"},
              {ServoEnd::kStalled, "frozen joint readings"}};
    case FaultKind::kLinkLost:
      return {{ServoEnd::kLinkLost, "the link to the robot is lost"}};
  }
  return {};
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool Names(const Outcome& outcome, const Fault& fault) {
  for (const Naming& naming : NamingsOf(fault))
    if (outcome.run.end == naming.end && Contains(outcome.run.reason, naming.words)) return true;
  return false;
}

// How long a fault may last before the run must have ended because of it; infinite where it may end well.
double Patience_s(const ServoTrial& trial) {
  const SupervisorOptions& options = trial.options.supervision;
  const double stale_s = options.stale_s + 2 * kPeriod_s;
  const bool is_from_the_start = trial.fault->from_s == 0;  // then the first image is waited for
  switch (trial.fault->kind) {
    case FaultKind::kReadingsNan:
    case FaultKind::kLinkLost:
      return kPeriod_s;
    case FaultKind::kFramesDropped:
      return is_from_the_start ? kFirstImage_s : stale_s;
    case FaultKind::kFramesLate:
      if (trial.fault->delay_s <= options.stale_s) return INFINITY;
      return is_from_the_start ? kFirstImage_s : stale_s;
    case FaultKind::kFramesFrozen:
      return trial.simulation.edge_noise_px > 0.01 ? stale_s : INFINITY;
    case FaultKind::kLegCovered:
      return trial.options.step.law.legs.count() == 3 ? options.unusable_s + 2 * kPeriod_s : INFINITY;
    case FaultKind::kReadingsFrozen:  // to be commanded far enough, or to get no nearer
      return kFrozen_s;
  }
  return INFINITY;
}

// For how long the fault was there and did anything to the law, before the run ended.
double FaultLasted_s(const Outcome& outcome) {
  if (!outcome.trial.FaultMatters()) return -1;
  return std::min(outcome.trial.fault->until_s, outcome.end_s) - outcome.trial.fault->from_s;
}

double ClosestToAnEnd_m(const GoughStewart& robot, const Vector6d& readings_m) {
  double closest_m = 1;
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    closest_m = std::min({closest_m, readings_m[i] - shortest_m, longest_m - readings_m[i]});
  }
  return closest_m;
}

// Whether an end that has to do with no fault says what is so.
bool IsHonest(const Outcome& outcome) {
  const ServoTrial& trial = outcome.trial;
  const std::string& reason = outcome.run.reason;
  const bool is_wrong = trial.model_error > 0;
  const bool has_noise = trial.simulation.edge_noise_px > 0 || trial.simulation.drives.reading_noise_m > 0;
  const JointLimitOptions& limits = trial.options.step.limits;
  switch (outcome.run.end) {
    case ServoEnd::kConverged:
      return true;
    case ServoEnd::kStalled:
      if (Contains(reason, "out of the joint ranges"))
        return (has_noise && Contains(reason, "or noise drives")) ||
               ClosestToAnEnd_m(trial.truth.robot, outcome.at_rest.joint_readings_m) <
                   limits.range_margin_m + limits.look_ahead_s * limits.speed_limit_m_per_s;
      if (Contains(reason, "does not follow")) return trial.HasFriction();
      return is_wrong || has_noise || trial.HasFriction();
    case ServoEnd::kFrozenReadings:
      return trial.HasFriction() && Contains(reason, "or the drives do not move");
    case ServoEnd::kDrivesDoNotMove:
      return trial.HasFriction();
    case ServoEnd::kNoPose:
      return is_wrong || has_noise;
    case ServoEnd::kErrorGrows:
      return is_wrong || Contains(reason, "held back at");
    case ServoEnd::kRobotSingular:
      return is_wrong;
    case ServoEnd::kTooFewEdges:
      return Contains(reason, " not seen") || Contains(reason, "one edge alone");
    case ServoEnd::kIllConditionedEdges:
      return has_noise || Contains(reason, " not seen") || Contains(reason, "one edge alone") ||
             !trial.options.step.law.legs.all();
    case ServoEnd::kTimeout:
      return true;
    default:  // what only a fault can cause
      return false;
  }
}

// Nothing is in the way. Stronger noise leaves some motions too uncertain to move on, where legs hide each
// other.
bool IsUnhindered(const ServoTrial& trial) {
  constexpr double kMostNoise_px = 0.25;
  return trial.model_error == 0 && !trial.fault && trial.is_goal_in_range && !trial.HasFriction() &&
         trial.options.step.law.legs.all() && trial.simulation.edge_noise_px <= kMostNoise_px;
}

// How far it is from the goal: what is left of each reading, and the edges of all legs without noise.
struct LeftToGo {
  double joints_m = 0, edges_px = 0;
};
LeftToGo LeftOf(const Outcome& outcome) {
  const ServoTrial& trial = outcome.trial;
  const Rigid3& pose = outcome.at_rest.base_from_platform;
  const Vector6d to_go_m =
      InverseKinematics(trial.truth.robot, trial.goal_pose) - outcome.at_rest.joint_readings_m;
  const SeenEdges seen = EdgesOf(trial.truth.robot, trial.truth.camera_from_base, pose);
  const LawResult law = EvaluateLaw(trial.model, trial.goal,
                                    {seen, outcome.at_rest.joint_readings_m, Vector6d::Zero(), pose}, {});
  return {to_go_m.cwiseAbs().maxCoeff(), law.edge_error_px};
}

// What is wrong with a run; empty: nothing.
std::string Complaint(const Outcome& outcome) {
  const ServoTrial& trial = outcome.trial;
  if (outcome.was_out_of_range) return "a joint left its range";
  if (outcome.was_too_fast) return "a joint or a command was too fast";
  if (outcome.still_moves) return "the rig moves after the end";
  if (outcome.run.end == ServoEnd::kRunning || outcome.run.reason.empty()) return "it has not ended";
  if (outcome.run.time_s > trial.options.supervision.timeout_s + kPeriod_s) return "it ended too late";
  const double lasted_s = FaultLasted_s(outcome);
  if (lasted_s >= 0 && Names(outcome, *trial.fault)) return "";
  if (lasted_s > Patience_s(trial)) return "the fault is not named";
  return IsHonest(outcome) ? "" : "the reason is not so";
}

std::vector<Outcome> RunAll(std::uint64_t seed) {
  std::vector<Outcome> outcomes(kRuns);
  tbb::parallel_for(0, kRuns, [&](int i) { outcomes[static_cast<size_t>(i)] = RunOf(DrawTrial(seed, i)); });
  return outcomes;
}

using Counts = std::map<std::string, std::map<std::string, int>>;

void Print(const std::string& title, const Counts& counts) {
  std::map<std::string, int> columns;
  for (const auto& [row, of_row] : counts)
    for (const auto& [column, count] : of_row) columns[column] += count;
  std::string text = fmt::format("\n{:<24}", title);
  for (const auto& [column, total] : columns)
    text += fmt::format(" {:>{}}", column, std::max<size_t>(5, column.size()));
  for (const auto& [row, of_row] : counts) {
    text += fmt::format("\n{:<24}", row);
    for (const auto& [column, total] : columns) {
      const auto found = of_row.find(column);
      text += fmt::format(" {:>{}}", found == of_row.end() ? 0 : found->second,
                          std::max<size_t>(5, column.size()));
    }
  }
  std::cout << text << std::endl;
}

std::string ModeOf(const ServoTrial& trial) {
  const ControlLawOptions& law = trial.options.step.law;
  if (law.mode != ControlMode::kPose) return ToString(law.mode);
  return law.pose_source == PoseSource::kReadings ? "pose by readings" : "pose by edges";
}

void PrintTables(const std::vector<Outcome>& outcomes) {
  Counts by_fault, by_mode, unhindered;
  for (const Outcome& outcome : outcomes) {
    const ServoTrial& trial = outcome.trial;
    const std::string end = ToString(outcome.run.end);
    ++by_fault[trial.fault ? kFaultNames[static_cast<size_t>(trial.fault->kind)].second : "no fault"][end];
    ++by_mode[ModeOf(trial)][end];
    if (IsUnhindered(trial)) ++unhindered[ModeOf(trial)][end];
  }
  Print("ends by fault", by_fault);
  Print("ends by mode", by_mode);
  Print("perfect model, no fault", unhindered);
}

// Of converged runs with nothing in the way, by mode.
void PrintWhatIsLeft(const std::vector<Outcome>& outcomes) {
  std::map<std::string, std::array<std::vector<double>, 2>> by_mode;
  for (const Outcome& outcome : outcomes) {
    if (!IsUnhindered(outcome.trial) || outcome.run.end != ServoEnd::kConverged) continue;
    const LeftToGo left = LeftOf(outcome);
    by_mode[ModeOf(outcome.trial)][0].push_back(1e3 * left.joints_m);
    by_mode[ModeOf(outcome.trial)][1].push_back(left.edges_px);
  }
  std::cout
      << "\nleft to go               joints, mm: median    95 %    most  edges, px: median    95 %    most";
  for (auto& [mode, left] : by_mode) {
    std::cout << fmt::format("\n{:<24}", mode);
    for (std::vector<double>& values : left) {
      std::sort(values.begin(), values.end());
      std::cout << fmt::format("            {:>7.3f} {:>7.3f} {:>7.3f}", values[values.size() / 2],
                               values[values.size() * 95 / 100], values.back());
    }
  }
  std::cout << std::endl;
}

TEST(SafetyStatistics, NoRunCrossesALimitAndEachEndsWithItsReason) {
  const std::uint64_t seed = TestGenerator()();
  const Stopwatch watch;
  const std::vector<Outcome> outcomes = RunAll(seed);
  std::cout << fmt::format("{} runs in {:.0f} s\n", kRuns, watch.Seconds());
  PrintTables(outcomes);
  PrintWhatIsLeft(outcomes);
  int unhindered = 0, converged = 0;
  for (size_t i = 0; i < outcomes.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    const std::string text = fmt::format("run {}: {} ({}) at {:.2f} s\n    {}", i, ToString(outcome.run.end),
                                         outcome.run.reason, outcome.run.time_s, outcome.trial.Describe());
    EXPECT_EQ(Complaint(outcome), "") << text;
    if (!IsUnhindered(outcome.trial)) continue;
    ++unhindered;
    converged += outcome.run.end == ServoEnd::kConverged;
    if (outcome.run.end != ServoEnd::kConverged) {
      std::cout << text << std::endl;
    } else if (outcome.trial.options.step.law.mode == ControlMode::kEdges) {
      // All edges: those that were hidden may be farther off than those that it converged by.
      const double most_px =
          3 * (DefaultTolerance(ControlMode::kEdges) + outcome.trial.simulation.edge_noise_px);
      EXPECT_LE(LeftOf(outcome).edges_px, most_px) << text;
    }
  }
  EXPECT_GE(unhindered, 200);
  EXPECT_GE(converged, 0.98 * unhindered);
}

}  // namespace
}  // namespace legible
