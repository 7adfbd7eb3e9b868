#include "servo/servo_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/rig/simulated_edges.h"
#include "core/rig/simulated_rig.h"
#include "tests/servo/servo_scene.h"

namespace legible {
namespace {

using testing::HasSubstr;

// The desktop robot at home and a goal 3 cm up, aside and tilted; its camera sees all legs.
struct Trial {
  GoughStewart robot = DesktopHexapod();
  Camera camera = DesktopCamera(true);
  Rigid3 camera_from_base = SyntheticOptions().camera_from_base;
  SimulationOptions simulation;
  ServoOptions options;
  ServoLoopOptions loop;
  Rigid3 goal = Displaced(DesktopHexapod().home, GoalDisplacement());

  static Vector6d GoalDisplacement() {
    Vector6d displacement;
    displacement << 0.01, 0.02, 0.03, 0.02, -0.03, 0.05;
    return displacement;
  }
};

constexpr double kSettling_s = Rig::kCommandHolds_s + 1;

struct Outcome {
  ServoRun run;
  int records = 0;
  TrueMotion end;  // when nothing coasts any more
  bool hit_end_stop = false, was_too_fast = false;
  double largest_speed_m_per_s = 0;
};

bool IsInRange(const GoughStewart& robot, const Vector6d& readings_m) {
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] < shortest_m || readings_m[i] > longest_m) return false;
  }
  return true;
}

Outcome RunOf(const Trial& trial) {
  const ServoModel model = MakeServoModel(trial.robot, trial.camera, trial.camera_from_base);
  SimulatedRig rig({trial.robot, trial.camera, trial.camera_from_base}, trial.simulation);
  SimulatedEdges source(rig);
  ServoController controller(model, GoalAtPose(model, trial.goal), trial.options);
  Outcome outcome;
  outcome.run = RunServo(rig, source, controller, trial.loop, [&](const ServoCycle& cycle) {
    ++outcome.records;
    EXPECT_TRUE(IsInRange(trial.robot, rig.true_motion().joint_readings_m));
    EXPECT_GE(cycle.law_s, 0);
    EXPECT_GE(cycle.look_s, 0);
  });
  try {
    rig.WaitUntil(rig.true_time_s() + kSettling_s);
  } catch (const RigError&) {
  }
  const TrueMotion settled = rig.true_motion();
  try {
    rig.WaitUntil(rig.true_time_s() + 0.1);
  } catch (const RigError&) {
  }
  outcome.end = rig.true_motion();
  EXPECT_LT((outcome.end.joint_readings_m - settled.joint_readings_m).norm(), 1e-12) << "does not rest";
  for (const bool hit : rig.drives().hit_end_stop()) EXPECT_FALSE(hit);
  EXPECT_FALSE(rig.drives().was_commanded_too_fast());
  outcome.largest_speed_m_per_s = rig.drives().largest_speed_m_per_s();
  EXPECT_LE(outcome.largest_speed_m_per_s, trial.options.step.limits.speed_limit_m_per_s + 1e-12);
  EXPECT_TRUE(IsInRange(trial.robot, outcome.end.joint_readings_m));
  EXPECT_NE(outcome.run.reason, "");
  EXPECT_GE(outcome.run.cycles, outcome.records);
  return outcome;
}

Vector6d OffGoal(const Trial& trial, const Outcome& outcome) {
  return Displacement(outcome.end.base_from_platform, trial.goal);
}

TEST(RunServo, BringsASimulatedRigToTheGoalInEveryMode) {
  for (const ControlMode mode :
       {ControlMode::kEdges, ControlMode::kDirections, ControlMode::kPose, ControlMode::kJoints}) {
    Trial trial;
    trial.options.step.law.mode = mode;
    trial.simulation.edge_noise_px = 0;
    const Outcome outcome = RunOf(trial);
    EXPECT_EQ(outcome.run.end, ServoEnd::kConverged) << ToString(mode) << ": " << outcome.run.reason;
    EXPECT_EQ(outcome.records, outcome.run.cycles);
    EXPECT_NEAR(outcome.run.time_s, (outcome.run.cycles - 1) * 0.02, 1e-9);
    EXPECT_LT(OffGoal(trial, outcome).head<3>().norm(), 2e-3) << ToString(mode);
  }
}

TEST(RunServo, IsRepeatable) {
  Trial trial;
  const Outcome once = RunOf(trial), again = RunOf(trial);
  EXPECT_EQ(once.run.cycles, again.run.cycles);
  EXPECT_EQ(once.end.joint_readings_m, again.end.joint_readings_m);
}

struct FaultCase {
  Fault fault;
  ServoEnd end;
  std::string words;
};

void ExpectEnd(Trial trial, const FaultCase& expected) {
  trial.simulation.faults.push_back(expected.fault);
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, expected.end) << ToString(outcome.run.end) << ": " << outcome.run.reason;
  EXPECT_THAT(outcome.run.reason, HasSubstr(expected.words));
  if (expected.end != ServoEnd::kConverged) {
    EXPECT_LT(outcome.run.time_s, 2);
  }
}

TEST(RunServo, EndsOnEachFaultWithAReasonThatNamesIt) {
  const std::vector<FaultCase> cases = {
      {{FaultKind::kFramesDropped, 0.3}, ServoEnd::kStaleImages, "no fresh image"},
      {{FaultKind::kFramesLate, 0.3}, ServoEnd::kStaleImages, "no fresh image"},
      {{FaultKind::kFramesFrozen, 0.3}, ServoEnd::kFrozenImages, "the images have not changed"},
      {{FaultKind::kLegCovered, 0.3, 1e9, 4}, ServoEnd::kConverged, "within the tolerance"},
      {{FaultKind::kReadingsNan, 0.3}, ServoEnd::kBadReadings, "are not numbers"},
      {{FaultKind::kReadingsFrozen, 0.3}, ServoEnd::kFrozenReadings, "joint readings have not changed"},
      {{FaultKind::kLinkLost, 0.3}, ServoEnd::kLinkLost, "the rig does not answer: the link"},
  };
  for (const FaultCase& one : cases) {
    SCOPED_TRACE(kFaultNames[static_cast<size_t>(one.fault.kind)].second);
    ExpectEnd({}, one);
    // From the first cycle on.
    FaultCase at_once = one;
    at_once.fault.from_s = 0;
    if (one.fault.kind == FaultKind::kFramesDropped) {  // no image ever
      at_once.words = "no image has come from the camera within 1 s";
    }
    if (one.fault.kind == FaultKind::kFramesLate) continue;  // below
    ExpectEnd({}, at_once);
  }
}

TEST(RunServo, NamesLateFramesFromTheFirstOneOn) {
  ExpectEnd({}, {{FaultKind::kFramesLate, 0}, ServoEnd::kStaleImages, "the newest is 0.20 s old"});
}

// A disk that blocks, for instance, while a cycle is recorded.
TEST(RunServo, DoesNotMakeUpForALongCycleInABurst) {
  const Trial trial;
  const ServoModel model = MakeServoModel(trial.robot, trial.camera, trial.camera_from_base);
  SimulatedRig rig({trial.robot, trial.camera, trial.camera_from_base}, trial.simulation);
  SimulatedEdges source(rig);
  ServoController controller(model, GoalAtPose(model, trial.goal), trial.options);
  constexpr double kBlocked_s = 0.47;
  std::vector<double> times_s;
  const ServoRun run = RunServo(rig, source, controller, trial.loop, [&](const ServoCycle& cycle) {
    times_s.push_back(cycle.input.time_s);
    if (times_s.size() == 10) rig.WaitUntil(rig.Now() + kBlocked_s);
  });
  EXPECT_EQ(run.end, ServoEnd::kConverged) << run.reason;
  ASSERT_GT(times_s.size(), 20u);
  EXPECT_NEAR(times_s[10] - times_s[9], kBlocked_s, 1e-9);
  for (size_t i = 11; i < times_s.size(); ++i)
    EXPECT_NEAR(times_s[i] - times_s[i - 1], trial.loop.period_s, 1e-9);
}

TEST(RunServo, WaitsForTheFirstImage) {
  Trial trial;
  trial.simulation.faults.push_back({FaultKind::kFramesDropped, 0, 0.31});
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kConverged) << outcome.run.reason;
  trial.simulation.faults[0].until_s = 1e9;
  trial.loop.is_stopped = [] { return true; };
  EXPECT_EQ(RunOf(trial).run.end, ServoEnd::kStoppedByUser);
}

TEST(RunServo, NeedsNoCameraForALawThatDoesNotLook) {
  for (const ControlMode mode : {ControlMode::kPose, ControlMode::kJoints}) {
    Trial trial;
    trial.options.step.law.mode = mode;
    trial.simulation.faults.push_back({FaultKind::kFramesDropped, 0});
    const Outcome outcome = RunOf(trial);
    EXPECT_EQ(outcome.run.end, ServoEnd::kConverged) << outcome.run.reason;
  }
}

TEST(RunServo, LeavesTheRigAtRestThoughTheLinkIsSoonBack) {
  Trial trial;
  trial.simulation.faults.push_back({FaultKind::kLinkLost, 0.3, 0.33});
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kLinkLost);
  EXPECT_LT(outcome.end.joint_speeds_m_per_s.norm(), 1e-12);
}

// The joints go on by their lag after the readings have frozen, as fast as a range lets them.
TEST(RunServo, KeepsTheRangesThoughReadingsAreFrozenAndDrivesLag) {
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kJoints}) {
    for (int n = 0; n < 40; ++n) {
      Trial trial;
      trial.options.step.law.mode = mode;
      trial.options.step.gain = AdaptiveGain::Constant(8);
      trial.options.step.limits.speed_limit_m_per_s = 0.1;
      trial.simulation.drives.lag_s = 0.04;
      trial.robot.legs[1].joint_range_m[1] = InverseKinematics(trial.robot, trial.robot.home)[1] + 0.012;
      trial.simulation.faults.push_back({FaultKind::kReadingsFrozen, 0.02 * n});
      RunOf(trial);  // looks at the ranges
    }
  }
}

// The last command that reached the drives leads them on until it lapses.
TEST(RunServo, KeepsTheRangesThoughTheLinkIsLostAndDrivesLag) {
  for (int n = 0; n < 40; ++n) {
    Trial trial;
    trial.options.step.law.mode = ControlMode::kJoints;
    trial.options.step.gain = AdaptiveGain::Constant(8);
    trial.options.step.limits.speed_limit_m_per_s = 0.1;
    trial.simulation.drives.lag_s = 0.04;
    trial.robot.legs[1].joint_range_m[1] = InverseKinematics(trial.robot, trial.robot.home)[1] + 0.02;
    trial.goal = Displaced(trial.robot.home, 2 * Trial::GoalDisplacement());
    trial.simulation.faults.push_back({FaultKind::kLinkLost, 0.02 * n + 0.001});
    RunOf(trial);  // looks at the ranges
  }
}

TEST(RunServo, RefusesPeriodsInWhichCommandsMightLapse) {
  ServoLoopOptions options;
  EXPECT_NO_THROW(options.Check());
  options.period_s = ServoLoopOptions::kLongestPeriod_s;
  EXPECT_NO_THROW(options.Check());
  for (const double period_s : {0.0, -0.02, 1.01 * ServoLoopOptions::kLongestPeriod_s, 1.0}) {
    options.period_s = period_s;
    try {
      options.Check();
      ADD_FAILURE() << period_s;
    } catch (const std::invalid_argument& refusal) {
      EXPECT_THAT(refusal.what(), HasSubstr("a rig holds a command no longer than 0.25 s"));
    }
  }
}

// The clock goes on with each look, far with the first one.
class SlowEdges : public EdgeSource {
 public:
  explicit SlowEdges(SimulatedRig& rig) : rig_(rig), edges_(rig) {}
  SeenEdges See(const MotionNow& motion) override {
    SeenEdges seen = edges_.See(motion);
    rig_.WaitUntil(rig_.Now() + (looks_++ == 0 ? 0.3 : 0.005));
    return seen;
  }

 private:
  SimulatedRig& rig_;
  SimulatedEdges edges_;
  int looks_ = 0;
};

TEST(RunServo, HoldsAFirstLookThatTakesLongAgainstNobody) {
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kPose}) {
    Trial trial;
    trial.options.step.law.mode = mode;  // the pose by readings: images are looked at, though not needed
    const ServoModel model = MakeServoModel(trial.robot, trial.camera, trial.camera_from_base);
    SimulatedRig rig({trial.robot, trial.camera, trial.camera_from_base}, trial.simulation);
    SlowEdges source(rig);
    ServoController controller(model, GoalAtPose(model, trial.goal), trial.options);
    const ServoRun run = RunServo(rig, source, controller, trial.loop, [](const ServoCycle&) {});
    EXPECT_EQ(run.end, ServoEnd::kConverged) << run.reason;
  }
}

TEST(RunServo, TakesLateImagesOfARobotAtRestForWhatTheyAre) {
  Trial trial;
  trial.simulation.edge_noise_px = 0;
  trial.options.step.gain = AdaptiveGain::Constant(3);
  trial.options.step.limits.speed_limit_m_per_s = 0.1;
  trial.simulation.faults.push_back({FaultKind::kFramesLate, 0, 1e9, 0, 0.09});
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kConverged) << outcome.run.reason;
}

TEST(RunServo, RidesOutFaultsThatAreShort) {
  for (const auto& [kind, name] : kFaultNames) {
    if (kind == FaultKind::kReadingsNan || kind == FaultKind::kLinkLost) continue;  // at once
    Trial trial;
    Fault fault{kind, 0.3, 0.36};
    fault.delay_s = 0.05;
    trial.simulation.faults.push_back(fault);
    const Outcome outcome = RunOf(trial);
    EXPECT_EQ(outcome.run.end, ServoEnd::kConverged) << name << ": " << outcome.run.reason;
  }
}

TEST(RunServo, EndsWhereTooManyLegsAreCovered) {
  Trial trial;
  for (const int leg : {0, 1, 2}) trial.simulation.faults.push_back({FaultKind::kLegCovered, 0.3, 1e9, leg});
  ExpectEnd(trial, {{FaultKind::kLegCovered, 0.3, 1e9, 3}, ServoEnd::kTooFewEdges, "too few edges are seen"});
}

TEST(RunServo, StopsAtTheUsersWord) {
  Trial trial;
  int asked = 0;
  trial.loop.is_stopped = [&asked] { return ++asked == 20; };
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kStoppedByUser);
  EXPECT_EQ(outcome.run.cycles, 20);
  EXPECT_EQ(outcome.run.reason, "stopped by the user");
}

TEST(RunServo, StopsAtTheEndOfARangeAndSaysWhich) {
  Trial trial;
  trial.robot.legs[1].joint_range_m[1] = InverseKinematics(trial.robot, trial.robot.home)[1] + 0.008;
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kStalled) << outcome.run.reason;
  EXPECT_THAT(outcome.run.reason, HasSubstr("leg 2 held back at the longest"));
  // Up to its margin; a reading is good to its step.
  const double left_m = trial.robot.legs[1].joint_range_m[1] - outcome.end.joint_readings_m[1];
  EXPECT_GT(left_m, 5e-4 - 2e-6);
  EXPECT_LT(left_m, 7e-4);
}

TEST(RunServo, EndsInFrictionThatIsTooStrongForTheTolerance) {
  Trial trial;
  trial.simulation.drives.breakaway_speed_m_per_s = 4e-3;
  trial.simulation.drives.sliding_loss_m_per_s = 2e-3;
  trial.options.step.law.mode = ControlMode::kJoints;
  const Outcome outcome = RunOf(trial);
  EXPECT_EQ(outcome.run.end, ServoEnd::kStalled) << outcome.run.reason;
  EXPECT_THAT(outcome.run.reason, HasSubstr("does not follow"));
}

TEST(RunServo, LeavesTheRigAtRestWhateverIsThrown) {
  Trial trial;
  const ServoModel model = MakeServoModel(trial.robot, trial.camera, trial.camera_from_base);
  SimulatedRig rig({trial.robot, trial.camera, trial.camera_from_base}, trial.simulation);
  SimulatedEdges source(rig);
  ServoController controller(model, GoalAtPose(model, trial.goal), trial.options);
  int records = 0;
  EXPECT_THROW(RunServo(rig, source, controller, trial.loop,
                        [&](const ServoCycle&) {
                          if (++records == 10) throw std::runtime_error("the disk is full");
                        }),
               std::runtime_error);
  rig.WaitUntil(rig.Now() + 1);
  EXPECT_LT(rig.true_motion().joint_speeds_m_per_s.norm(), 1e-12);
}

}  // namespace
}  // namespace legible
