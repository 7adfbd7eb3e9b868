#include "servo/servo_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tests/servo/servo_scene.h"

namespace legible {
namespace {

using testing::HasSubstr;

constexpr double kPeriod_s = 0.02;

// What happens to what the controller is given, by the time in seconds.
using Disturbance = std::function<void(CycleInput&, double)>;
// What the joints do of their commanded speeds.
using Drive = std::function<Vector6d(const Vector6d&, double)>;

// A robot that does what it is told at once, seen without noise, but for disturbances.
struct Trial {
  ServoScene scene;
  ServoGoal goal;
  ServoOptions options;
  Disturbance disturb = [](CycleInput&, double) {};
  Drive drive = [](const Vector6d& commanded, double) { return commanded; };

  CycleInput Look(const Vector6d& readings_m, double time_s) {
    scene.pose = ForwardKinematics(scene.model.robot, readings_m, scene.pose).base_from_platform;
    CycleInput input{time_s, {time_s, readings_m}, EdgesAt(scene.model, scene.pose)};
    input.seen.time_s = time_s;
    disturb(input, time_s);
    return input;
  }
};

// A run to its end, or for most_s; all its cycles.
struct History {
  std::vector<CycleOutput> cycles;

  const Verdict& Last() const { return cycles.back().verdict; }
  double Time_s() const { return static_cast<double>(cycles.size() - 1) * kPeriod_s; }
};

History RunOf(Trial trial, double most_s = 100) {
  ServoController controller(trial.scene.model, trial.goal, trial.options);
  Vector6d readings_m = InverseKinematics(trial.scene.model.robot, trial.scene.pose);
  History run;
  for (int cycle = 0; cycle * kPeriod_s <= most_s; ++cycle) {
    const double time_s = cycle * kPeriod_s;
    run.cycles.push_back(controller.Cycle(trial.Look(readings_m, time_s)));
    if (run.Last().end != ServoEnd::kRunning) break;
    readings_m += kPeriod_s * trial.drive(run.cycles.back().joint_speeds_m_per_s, time_s);
  }
  // It stays at rest and of its opinion, whatever comes then.
  if (run.Last().end == ServoEnd::kRunning) return run;
  const Verdict last = run.Last();
  EXPECT_EQ(run.cycles.back().joint_speeds_m_per_s, Vector6d::Zero());
  EXPECT_NE(last.reason, "");
  for (int more = 1; more < 60; ++more) {
    const CycleOutput after = controller.Cycle(trial.Look(readings_m, run.Time_s() + more * kPeriod_s));
    EXPECT_EQ(after.verdict.end, last.end);
    EXPECT_EQ(after.verdict.reason, last.reason);
    EXPECT_EQ(after.joint_speeds_m_per_s, Vector6d::Zero());
  }
  EXPECT_EQ(controller.End(ServoEnd::kStoppedByUser, "too late").end, last.end);
  return run;
}

Trial RandomTrial(std::mt19937_64& generator, ControlMode mode = ControlMode::kEdges) {
  const ServoScene scene = RandomScene(generator);
  Trial trial{scene, GoalAtPose(scene.model, Nearby(scene.pose, 0.03, generator)), {}};
  trial.options.step.law.mode = mode;
  return trial;
}

// Until so much later it goes well.
constexpr double kOnset_s = 0.3;

TEST(ServoController, ConvergesInEveryModeAndStaysAtTheGoalForTheDwell) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode :
       {ControlMode::kEdges, ControlMode::kDirections, ControlMode::kPose, ControlMode::kJoints}) {
    for (int n = 0; n < 3; ++n) {
      Trial trial = RandomTrial(generator, mode);
      if (n == 1) trial.options.step.law.pose_source = PoseSource::kEdges;
      const History run = RunOf(trial);
      EXPECT_EQ(run.Last().end, ServoEnd::kConverged) << run.Last().reason;
      EXPECT_THAT(run.Last().reason, HasSubstr("within the tolerance"));
      const auto dwell = static_cast<size_t>(std::lround(trial.options.supervision.dwell_s / kPeriod_s));
      const size_t count = run.cycles.size();
      ASSERT_GT(count, dwell + 1);
      const double tolerance = DefaultTolerance(mode);
      for (size_t i = count - 1 - dwell; i < count; ++i) EXPECT_LE(run.cycles[i].step.law.error, tolerance);
      EXPECT_GT(run.cycles[count - 2 - dwell].step.law.error, tolerance);
    }
  }
}

TEST(ServoController, DoesNotCountAnErrorThatLeavesTheToleranceBeforeTheDwell) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator, ControlMode::kJoints);
  trial.goal.joint_readings_m = InverseKinematics(trial.scene.model.robot, trial.scene.pose);
  // There in the beginning, pushed away at 0.1 s, back at once.
  trial.disturb = [](CycleInput& input, double time_s) {
    if (std::abs(time_s - 0.1) < 0.01) input.readings.joint_readings_m[2] += 1e-4;
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kConverged);
  EXPECT_GT(run.Time_s(), 0.3 - 1e-9);
}

TEST(ServoController, EndsOnReadingsThatAreNoNumbers) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.disturb = [](CycleInput& input, double time_s) {
    if (time_s > kOnset_s) input.readings.joint_readings_m[2] = std::numeric_limits<double>::quiet_NaN();
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kBadReadings);
  EXPECT_EQ(run.Last().reason, "joint readings of leg 3 are not numbers");
  EXPECT_NEAR(run.Time_s(), kOnset_s, 1.5 * kPeriod_s);
}

TEST(ServoController, EndsOnReadingsThatAreTooOld) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  StampedReadings held;
  trial.disturb = [held](CycleInput& input, double time_s) mutable {
    if (time_s <= kOnset_s) held = input.readings;
    input.readings = held;
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kStaleReadings);
  EXPECT_THAT(run.Last().reason, HasSubstr("no fresh joint readings"));
  EXPECT_NEAR(run.Time_s(), kOnset_s + 0.1, 2.5 * kPeriod_s);
}

TEST(ServoController, EndsOnReadingsThatAreFrozen) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  Vector6d held = Vector6d::Zero();
  trial.disturb = [held](CycleInput& input, double time_s) mutable {
    if (time_s <= kOnset_s) held = input.readings.joint_readings_m;
    input.readings.joint_readings_m = held;
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kFrozenReadings);
  EXPECT_THAT(run.Last().reason, HasSubstr("the joint readings have not changed"));
  EXPECT_THAT(run.Last().reason, HasSubstr("frozen, for the images show motion"));
  trial.options.step.law.mode = ControlMode::kJoints;  // looks at no image
  const History blind = RunOf(trial);
  EXPECT_EQ(blind.Last().end, ServoEnd::kFrozenReadings);
  EXPECT_THAT(blind.Last().reason, HasSubstr("or the drives do not move"));
}

TEST(ServoController, EndsOnImagesThatAreTooOld) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  SeenEdges held;
  trial.disturb = [held](CycleInput& input, double time_s) mutable {
    if (time_s <= kOnset_s) held = input.seen;
    input.seen = held;
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kStaleImages);
  EXPECT_THAT(run.Last().reason, HasSubstr("no fresh image"));
  EXPECT_NEAR(run.Time_s(), kOnset_s + 0.1, 2.5 * kPeriod_s);
}

TEST(ServoController, EndsOnImagesThatAreFrozen) {
  std::mt19937_64 generator = TestGenerator();
  for (const bool has_noise : {false, true}) {
    Trial trial = RandomTrial(generator);
    SeenEdges held;
    trial.disturb = [held, has_noise](CycleInput& input, double time_s) mutable {
      if (has_noise)
        for (SeenEdge& edge : input.seen.edges)
          edge.normal_covariance =
              1e-8 * (Eigen::Matrix3d::Identity() - edge.normal * edge.normal.transpose());
      if (time_s <= kOnset_s) held = input.seen;
      const double stamp_s = input.seen.time_s;
      input.seen = held;
      input.seen.time_s = stamp_s;
    };
    const History run = RunOf(trial);
    EXPECT_EQ(run.Last().end, ServoEnd::kFrozenImages) << run.Last().reason;
    EXPECT_THAT(run.Last().reason, HasSubstr("the images have not changed"));
    EXPECT_THAT(run.Last().reason, HasSubstr("frozen"));
  }
}

TEST(ServoController, EndsOnDrivesThatDoNotMove) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.drive = [](const Vector6d&, double) -> Vector6d { return Vector6d::Zero(); };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kDrivesDoNotMove);
  EXPECT_THAT(run.Last().reason, HasSubstr("the drives do not move"));
}

TEST(ServoController, SaysThatDrivesDoNotMoveThoughNoiseMovesTheEdges) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.drive = [](const Vector6d&, double) -> Vector6d { return Vector6d::Zero(); };
  trial.disturb = [&generator](CycleInput& input, double) {
    GiveCovariances(input.seen, 1e-4, generator);
    input.seen = Moved(input.seen, generator);
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kDrivesDoNotMove) << run.Last().reason;
  EXPECT_THAT(run.Last().reason, HasSubstr("the drives do not move, or the joint readings are frozen"));
}

TEST(ServoController, DoesNotTakeARobotThatWaitsForFrozenImages) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.disturb = [](CycleInput& input, double) {
    input.seen = Only(input.seen, [](int leg, int) { return leg > 3; });
    // What a simulation without noise states of edges, a short one among them.
    for (SeenEdge& edge : input.seen.edges)
      edge.normal_covariance = (edge.edge == 0 ? 1e-11 : 1e-13) * Eigen::Matrix3d::Identity();
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kTooFewEdges) << run.Last().reason;
  EXPECT_THAT(run.Last().reason, HasSubstr("legs 1, 2, 3 and 4 are not seen"));
}

TEST(ServoController, NamesLegsThatShowOneEdgeAlone) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.disturb = [](CycleInput& input, double) {
    input.seen = Only(input.seen, [](int leg, int edge) { return leg < 3 && (leg != 1 || edge == 0); });
  };
  EXPECT_THAT(RunOf(trial).Last().reason,
              HasSubstr("; legs 4, 5 and 6 are not seen, of leg 2 one edge alone"));
}

// A leg with an error of its own comes into sight.
TEST(ServoController, ComparesErrorsOfTheSameEdgesAlone) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  const double appears_s = 1.6;
  trial.disturb = [appears_s](CycleInput& input, double time_s) {
    if (time_s < appears_s) input.seen = Only(input.seen, [](int leg, int) { return leg != 2; });
    input.seen.time_s = time_s;
  };
  trial.goal.edges[2] = GoalAtPose(trial.scene.model, Nearby(trial.scene.pose, 0.03, generator)).edges[2];
  trial.options.supervision.tolerance = 1e-9;
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kStalled) << run.Last().reason;
  EXPECT_GT(run.Time_s(), appears_s + 1.5);
}

// Noise drives it at its speed limit to and fro.
TEST(ServoController, EndsInNoiseThatKeepsItAtItsSpeedLimit) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.options.step.limits.speed_limit_m_per_s = 2e-3;
  trial.goal = GoalAtPose(trial.scene.model, trial.scene.pose);
  trial.disturb = [&generator](CycleInput& input, double) {
    GiveCovariances(input.seen, 2e-3, generator);
    input.seen = Moved(input.seen, generator);
  };
  const History run = RunOf(trial);
  EXPECT_NE(run.Last().end, ServoEnd::kTimeout) << run.Last().reason;
  EXPECT_LT(run.Time_s(), 20);
}

TEST(ServoController, IsPatientWhereTheSpeedLimitAloneMakesItSlow) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator, ControlMode::kJoints);
  trial.options.step.limits.speed_limit_m_per_s = 4e-4;
  trial.goal.joint_readings_m =
      InverseKinematics(trial.scene.model.robot, trial.scene.pose) + Vector6d::Constant(0.02);
  EXPECT_EQ(RunOf(trial).Last().end, ServoEnd::kConverged);
}

TEST(ServoController, SaysAtItsTimeoutWhyItWaited) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.options.supervision.timeout_s = 2;
  trial.disturb = [](CycleInput& input, double time_s) {
    if (std::fmod(time_s, 0.4) > 0.05) input.seen = Only(input.seen, [](int leg, int) { return leg > 3; });
    input.seen.time_s = time_s;
  };
  trial.options.step.gain = AdaptiveGain::Constant(0.2);
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kTimeout) << run.Last().reason;
  EXPECT_THAT(run.Last().reason, HasSubstr("% of its cycles, last because too few edges are seen"));
}

TEST(ServoController, WaitsWhileTooLittleIsSeenAndEndsIfThatLasts) {
  std::mt19937_64 generator = TestGenerator();
  for (const double hidden_s : {0.4, 2.0}) {
    Trial trial = RandomTrial(generator);
    trial.disturb = [hidden_s](CycleInput& input, double time_s) {
      if (time_s > kOnset_s && time_s < kOnset_s + hidden_s)
        input.seen = Only(input.seen, [](int leg, int) { return leg > 3; });
      input.seen.time_s = time_s;
    };
    const History run = RunOf(trial);
    int waits = 0;
    for (const CycleOutput& cycle : run.cycles) {
      if (cycle.verdict.end != ServoEnd::kRunning || !cycle.verdict.is_waiting) continue;
      ++waits;
      EXPECT_EQ(cycle.joint_speeds_m_per_s, Vector6d::Zero());
    }
    EXPECT_NEAR(waits * kPeriod_s, std::min(hidden_s, 0.5), 2.5 * kPeriod_s);
    EXPECT_EQ(run.Last().end, hidden_s < 0.5 ? ServoEnd::kConverged : ServoEnd::kTooFewEdges);
    if (hidden_s >= 0.5) {
      EXPECT_THAT(run.Last().reason, HasSubstr("too few edges are seen: 4 of 2 legs"));
    }
  }
}

TEST(ServoController, EndsWhereWhatIsSeenLeavesAMotionOpen) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  GoughStewart robot = trial.scene.model.robot;
  for (size_t i = 0; i < kLegCount; i += 2)
    robot.legs[i].base_joint_m =
        trial.scene.pose * robot.legs[i].platform_joint_m - Eigen::Vector3d(0, 0, 0.32);
  trial.scene.model = MakeServoModel(robot, trial.scene.model.camera, trial.scene.model.camera_from_base);
  trial.goal = GoalAtPose(trial.scene.model, trial.scene.pose);
  trial.options.step.law.legs = 0b010101;
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kIllConditionedEdges);
  EXPECT_THAT(run.Last().reason, HasSubstr("leave a motion of the platform open"));
}

TEST(ServoController, EndsAtOnceAtASingularityOfTheRobot) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0);
  for (Leg& leg : robot.legs) leg.joint_range_m = {0.1, 1};
  robot.home = {RotationFromVector({0, 0, std::numbers::pi / 2 - 1e-3}), {0, 0, 0.32}};
  const ServoModel model = MakeServoModel(robot, DesktopCamera(false), LookAt({1, 0, 0.3}, {0, 0, 0.15}));
  const Trial trial{{model, robot.home}, GoalAtPose(model, robot.home), {}};
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kRobotSingular);
  EXPECT_EQ(run.cycles.size(), 1u);
  EXPECT_THAT(run.Last().reason, HasSubstr("the robot is at a singularity"));
}

TEST(ServoController, EndsOnReadingsThatBelongToNoPose) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.disturb = [](CycleInput& input, double time_s) {
    if (time_s > kOnset_s) input.readings.joint_readings_m[1] += 3;
  };
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kNoPose);
  EXPECT_EQ(run.Last().reason, "the joint readings belong to no pose of the platform");
}

TEST(ServoController, EndsWhereTheErrorGrows) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kPose, ControlMode::kJoints}) {
    Trial trial = RandomTrial(generator, mode);
    trial.drive = [](const Vector6d& commanded, double) -> Vector6d { return -commanded; };
    const History run = RunOf(trial);
    EXPECT_EQ(run.Last().end, ServoEnd::kErrorGrows) << run.Last().reason;
    EXPECT_THAT(run.Last().reason, HasSubstr("the error grows"));
  }
}

TEST(ServoController, EndsWhereTheGoalIsOutOfTheJointRanges) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kJoints}) {
    Trial trial = RandomTrial(generator, mode);
    Rigid3 goal = trial.scene.pose;
    goal.translation.z() += 0.05;
    const Vector6d start_m = InverseKinematics(trial.scene.model.robot, trial.scene.pose);
    trial.scene.model.robot.legs[3].joint_range_m[1] = start_m[3] + 0.01;
    trial.goal = GoalAtPose(trial.scene.model, goal);
    const History run = RunOf(trial);
    EXPECT_EQ(run.Last().end, ServoEnd::kStalled);
    EXPECT_THAT(run.Last().reason, HasSubstr("leg 4 held back at the longest"));
    EXPECT_THAT(run.Last().reason, HasSubstr("the goal is out of the joint ranges"));
  }
}

TEST(ServoController, EndsWhereADriveDoesNotFollow) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator, ControlMode::kJoints);
  trial.drive = [](const Vector6d& commanded, double) -> Vector6d {
    Vector6d speeds = commanded;
    speeds[4] = 0;
    return speeds;
  };
  // Too little to be told from a drive that stands for good reason.
  trial.goal.joint_readings_m =
      InverseKinematics(trial.scene.model.robot, trial.scene.pose) + Vector6d::Constant(4e-4);
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kStalled);
  EXPECT_THAT(run.Last().reason, HasSubstr("the drive of leg 5 does not follow"));
}

TEST(ServoController, EndsWhereNothingHoldsItAndTheErrorStays) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  // Edges that fit no pose.
  for (auto& of_leg : trial.goal.edges)
    of_leg[0]->normal = (of_leg[0]->normal + UniformVector(generator, -0.02, 0.02)).normalized();
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kStalled) << run.Last().reason;
  EXPECT_THAT(run.Last().reason, HasSubstr("a local minimum"));
}

TEST(ServoController, EndsWhenItsTimeIsUp) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator);
  trial.options.step.gain = AdaptiveGain::Constant(0.2);
  trial.options.supervision.timeout_s = 2;
  const History run = RunOf(trial);
  EXPECT_EQ(run.Last().end, ServoEnd::kTimeout);
  EXPECT_THAT(run.Last().reason, HasSubstr("not converged within 2.0 s"));
  EXPECT_NEAR(run.Time_s(), 2, 1e-9);
}

TEST(ServoController, GivesTheSameCommandsForTheSameInputs) {
  std::mt19937_64 generator = TestGenerator();
  const Trial trial = RandomTrial(generator);
  const History once = RunOf(trial), again = RunOf(trial);
  ASSERT_EQ(once.cycles.size(), again.cycles.size());
  for (size_t i = 0; i < once.cycles.size(); ++i)
    EXPECT_EQ(once.cycles[i].joint_speeds_m_per_s, again.cycles[i].joint_speeds_m_per_s);
}

TEST(ServoController, RefusesAGoalThatDoesNotSayWhatTheModeNeeds) {
  std::mt19937_64 generator = TestGenerator();
  Trial trial = RandomTrial(generator, ControlMode::kPose);
  trial.goal.base_from_platform.reset();
  EXPECT_THROW(ServoController(trial.scene.model, trial.goal, trial.options), std::invalid_argument);
  trial.options.step.law.mode = ControlMode::kEdges;
  EXPECT_NO_THROW(ServoController(trial.scene.model, trial.goal, trial.options));
  trial.options.supervision.growth_factor = 1;
  EXPECT_THROW(ServoController(trial.scene.model, trial.goal, trial.options), std::invalid_argument);
}

TEST(Supervisor, IsEndedFromOutsideOnce) {
  Supervisor supervisor({}, {});
  EXPECT_EQ(supervisor.End(ServoEnd::kLinkLost, "gone").end, ServoEnd::kLinkLost);
  const Verdict later = supervisor.End(ServoEnd::kStoppedByUser, "stop");
  EXPECT_EQ(later.end, ServoEnd::kLinkLost);
  EXPECT_EQ(later.reason, "gone");
}

}  // namespace
}  // namespace legible
