#include "core/rig/simulated_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/core/rig/desktop_rig.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kPeriod_s = 0.02;

TEST(SimulatedRig, ThePoseIsThatOfTheTrueReadings) {
  SimulatedRig rig(DesktopTruth(), RoughOptions());
  EXPECT_TRUE(
      AreNear(rig.true_motion().base_from_platform.translation, DesktopHexapod().home.translation, 0));
  for (int i = 1; i <= 100; ++i) {
    Vector6d command;
    for (int leg = 0; leg < kLegCount; ++leg) command[leg] = 0.03 * std::sin(0.1 * i + leg);
    rig.CommandSpeeds(command);
    rig.WaitUntil(i * 0.017);
    const TrueMotion motion = rig.true_motion();
    EXPECT_TRUE(AreNear(InverseKinematics(DesktopHexapod(), motion.base_from_platform),
                        motion.joint_readings_m, 1e-12));
  }
  EXPECT_GT((rig.true_motion().joint_readings_m - Vector6d::Constant(0.375)).norm(), 1e-3);
}

TEST(SimulatedRig, StartsWhereItIsTold) {
  SimulationOptions options;
  options.start = DesktopHexapod().home;
  options.start->translation += Eigen::Vector3d(0.01, -0.02, 0.03);
  const SimulatedRig rig(DesktopTruth(), options);
  EXPECT_EQ(rig.true_motion().base_from_platform.translation, options.start->translation);
  options.start->translation.z() = 0.6;
  EXPECT_THROW(SimulatedRig(DesktopTruth(), options), std::invalid_argument);
}

TEST(SimulatedRig, ItsClockGoesOnInWaitUntilOnly) {
  SimulatedRig rig(DesktopTruth(), {});
  EXPECT_EQ(rig.Now(), 0);
  rig.WaitUntil(0.123);
  EXPECT_EQ(rig.Now(), 0.123);
  rig.WaitUntil(0.1);
  EXPECT_EQ(rig.Now(), 0.123);
  EXPECT_EQ(rig.ReadJoints().time_s, 0.123);
  EXPECT_THROW(rig.WaitUntil(NAN), std::invalid_argument);
}

TEST(SimulatedRig, ExposesAtTheMultiplesOfItsPeriod) {
  SimulatedRig rig(DesktopTruth(), {});
  rig.CommandSpeeds(Rising(0.05));
  EXPECT_EQ(rig.NewestFrame().time_s, 0);
  rig.WaitUntil(0.0599);
  EXPECT_EQ(rig.NewestFrame().time_s, 0.04);
  const Rigid3 before = rig.NewestFrame().base_from_platform;
  rig.WaitUntil(0.06 - 1e-15);  // as who adds up periods may say it
  EXPECT_EQ(rig.NewestFrame().time_s, 3 * kPeriod_s);
  EXPECT_GT((rig.NewestFrame().base_from_platform.translation - before.translation).norm(), 1e-4);
  EXPECT_TRUE(AreNear(rig.NewestFrame().base_from_platform.translation,
                      rig.true_motion().base_from_platform.translation, 1e-12));
}

// Numbers of a run with noise, friction and all; with images and readings asked for more or less often.
std::vector<double> NumbersOfRun(std::uint64_t seed, int extra_calls) {
  SimulationOptions options = RoughOptions();
  options.seed = seed;
  SimulatedRig rig(DesktopTruth(), options, [](const Rigid3&, const std::vector<int>&, std::uint64_t) {
    return GrayImage{1, 1, {0}};
  });
  std::vector<double> numbers;
  for (int i = 1; i <= 100; ++i) {
    rig.CommandSpeeds(0.1 * (Vector6d::Constant(0.38) - rig.ReadJoints().joint_readings_m) +
                      Rising(0.01 * std::sin(0.1 * i)));
    rig.WaitUntil(i * kPeriod_s);
    for (int k = 0; k < extra_calls; ++k) {
      rig.Grab();
      rig.ReadJoints();
    }
    const StampedReadings readings = rig.ReadJoints();
    const TrueMotion motion = rig.true_motion();
    numbers.insert(numbers.end(), readings.joint_readings_m.begin(), readings.joint_readings_m.end());
    numbers.insert(numbers.end(), motion.joint_readings_m.begin(), motion.joint_readings_m.end());
    const auto& rotation = motion.base_from_platform.rotation.coeffs();
    numbers.insert(numbers.end(), rotation.begin(), rotation.end());
  }
  return numbers;
}

TEST(SimulatedRig, RepeatsBitForBitHoweverOftenItIsAsked) {
  EXPECT_EQ(NumbersOfRun(5, 0), NumbersOfRun(5, 0));
  EXPECT_EQ(NumbersOfRun(5, 0), NumbersOfRun(5, 3));
  EXPECT_NE(NumbersOfRun(5, 0), NumbersOfRun(6, 0));
}

TEST(SimulatedRig, DrawsAFrameOnceAndOnlyWhenAsked) {
  std::vector<std::uint64_t> drawn;
  SimulatedRig rig(DesktopTruth(), WithFault({FaultKind::kLegCovered, 0.05, 0.1, 3}),
                   [&](const Rigid3& pose, const std::vector<int>& covered, std::uint64_t frame) {
                     drawn.push_back(frame);
                     EXPECT_GT(pose.translation.z(), 0.3);
                     EXPECT_EQ(covered, frame == 4 ? std::vector<int>{3} : std::vector<int>{});
                     return GrayImage{1, 1, {static_cast<std::uint8_t>(frame)}};
                   });
  rig.WaitUntil(0.045);
  EXPECT_EQ(rig.Grab().time_s, 0.04);
  EXPECT_EQ(rig.Grab().image(0, 0), 2);
  rig.WaitUntil(0.08);
  EXPECT_EQ(rig.Grab().image(0, 0), 4);
  EXPECT_EQ(drawn, (std::vector<std::uint64_t>{2, 4}));
}

TEST(SimulatedRig, WithoutAPictureSourceHasNoCamera) {
  SimulatedRig rig(DesktopTruth(), {});
  EXPECT_THROW(rig.Grab(), std::logic_error);
}

// Stamps of the newest frame at the given times.
std::vector<double> Stamps(const Fault& fault, const std::vector<double>& times_s) {
  SimulatedRig rig(DesktopTruth(), WithFault(fault));
  std::vector<double> stamps_s;
  for (const double time_s : times_s) {
    rig.WaitUntil(time_s);
    stamps_s.push_back(rig.NewestFrame().time_s);
  }
  return stamps_s;
}

TEST(SimulatedRig, DroppedFramesLeaveTheLastOneBefore) {
  const std::vector<double> stamps =
      Stamps({FaultKind::kFramesDropped, 0.1, 0.2}, {0.08, 0.1, 0.18, 0.2, 0.22});
  EXPECT_THAT(stamps, testing::Pointwise(testing::DoubleEq(), {0.08, 0.08, 0.08, 0.2, 0.22}));
  SimulatedRig rig(DesktopTruth(), WithFault({FaultKind::kFramesDropped, 0, 0.2}));
  EXPECT_THROW(rig.NewestFrame(), NoImageYet);
}

TEST(SimulatedRig, LateFramesComeLateWithTheirOwnStamps) {
  Fault late{FaultKind::kFramesLate, 0.1, 0.4};
  late.delay_s = 0.2;
  const std::vector<double> stamps = Stamps(late, {0.1, 0.29, 0.30, 0.33, 0.39, 0.4, 0.5});
  EXPECT_THAT(stamps, testing::Pointwise(testing::DoubleEq(), {0.08, 0.08, 0.1, 0.12, 0.18, 0.4, 0.5}));
}

TEST(SimulatedRig, FrozenFramesHaveNewStampsAndOldContent) {
  SimulatedRig rig(DesktopTruth(), WithFault({FaultKind::kFramesFrozen, 0.1, 0.2}));
  rig.CommandSpeeds(Rising(0.05));
  rig.WaitUntil(0.08);
  const Frame before = rig.NewestFrame();
  rig.WaitUntil(0.181);
  EXPECT_DOUBLE_EQ(rig.NewestFrame().time_s, 0.18);
  EXPECT_EQ(rig.NewestFrame().number, before.number);
  EXPECT_EQ(rig.NewestFrame().base_from_platform.translation, before.base_from_platform.translation);
  rig.WaitUntil(0.2);
  EXPECT_EQ(rig.NewestFrame().number, 10U);
  EXPECT_NE(rig.NewestFrame().base_from_platform.translation, before.base_from_platform.translation);
}

TEST(SimulatedRig, CoveredLegsAreThoseOfTheExposure) {
  SimulationOptions options;
  options.faults = {{FaultKind::kLegCovered, 0.1, 0.2, 4},
                    {FaultKind::kLegCovered, 0.1, 0.15, 1},
                    {FaultKind::kLegCovered, 0.12, 0.15, 1}};
  SimulatedRig rig(DesktopTruth(), options);
  const auto covered_at = [&](double time_s) {
    rig.WaitUntil(time_s);
    return rig.NewestFrame().covered_legs;
  };
  EXPECT_EQ(covered_at(0.09), std::vector<int>{});
  EXPECT_EQ(covered_at(0.13), (std::vector<int>{1, 4}));
  EXPECT_EQ(covered_at(0.19), std::vector<int>{4});
  EXPECT_EQ(covered_at(0.2), std::vector<int>{});
}

TEST(SimulatedRig, ReadingsBecomeNanOrFreezeWithNewStamps) {
  SimulationOptions options = RoughOptions();
  options.faults = {{FaultKind::kReadingsFrozen, 0.1, 0.2}, {FaultKind::kReadingsNan, 0.3, 0.4}};
  SimulatedRig rig(DesktopTruth(), options), healthy(DesktopTruth(), RoughOptions());
  const auto read_at = [](SimulatedRig& some, double time_s) {
    some.CommandSpeeds(Rising(0.03));
    some.WaitUntil(time_s);
    return some.ReadJoints().joint_readings_m;
  };
  EXPECT_EQ(read_at(rig, 0.09), read_at(healthy, 0.09));
  const Vector6d at_start_m = read_at(healthy, 0.1);
  EXPECT_EQ(read_at(rig, 0.15), at_start_m);
  EXPECT_EQ(read_at(rig, 0.19), at_start_m);
  EXPECT_EQ(rig.ReadJoints().time_s, 0.19);
  EXPECT_GT((read_at(rig, 0.25) - at_start_m).minCoeff(), 1e-3);
  EXPECT_TRUE(read_at(rig, 0.35).array().isNaN().all());
  EXPECT_TRUE(read_at(rig, 0.4).allFinite());
}

SimulationOptions IdealDrives() {
  SimulationOptions options;
  options.drives.lag_s = 0;
  return options;
}

// By how much the joints of an ideal rig at 0.04 m/s have moved since the beginning, as a time.
double DrivenFor_s(const SimulatedRig& rig) {
  const Vector6d start_m = InverseKinematics(DesktopHexapod(), DesktopHexapod().home);
  const Vector6d way_m = rig.true_motion().joint_readings_m - start_m;
  EXPECT_TRUE(AreNear(way_m, Rising(way_m[0]), 1e-12));
  return way_m[0] / 0.04;
}

TEST(SimulatedRig, BringsTheJointsToRestWhereACommandIsNotRenewed) {
  SimulatedRig rig(DesktopTruth(), IdealDrives());
  for (const double commanded_s : {0.0, 1.0}) {
    rig.WaitUntil(commanded_s);
    rig.CommandSpeeds(Rising(0.04));
    rig.WaitUntil(commanded_s + Rig::kCommandHolds_s - 1e-6);
    EXPECT_EQ(rig.true_motion().joint_speeds_m_per_s, Rising(0.04));
    rig.WaitUntil(commanded_s + 0.9);
    EXPECT_EQ(rig.true_motion().joint_speeds_m_per_s, Rising(0));
  }
  EXPECT_NEAR(DrivenFor_s(rig), 2 * Rig::kCommandHolds_s, 1e-9);
}

TEST(SimulatedRig, DrivesOnWhileCommandsAreRenewed) {
  SimulatedRig rig(DesktopTruth(), IdealDrives());
  rig.CommandSpeeds(Rising(0.04));
  for (int i = 1; i <= 8; ++i) {
    rig.WaitUntil(0.2 * i);
    EXPECT_EQ(rig.true_motion().joint_speeds_m_per_s, Rising(0.04));
    rig.CommandSpeeds(Rising(0.04));
  }
  EXPECT_NEAR(DrivenFor_s(rig), 1.6, 1e-9);
}

TEST(SimulatedRig, WithoutItsLinkNothingAnswers) {
  SimulatedRig rig(DesktopTruth(), WithFault({FaultKind::kLinkLost, 0.1, 0.9}));
  EXPECT_THROW(rig.WaitUntil(0.15), RigError);
  EXPECT_EQ(rig.true_time_s(), 0.15);
  EXPECT_THROW(rig.Now(), RigError);
  EXPECT_THROW(rig.ReadJoints(), RigError);
  EXPECT_THROW(rig.NewestFrame(), RigError);
  EXPECT_THROW(rig.CommandSpeeds(Rising(0)), RigError);
  EXPECT_NO_THROW(rig.Stop());
  EXPECT_NO_THROW(rig.WaitUntil(0.9));
  EXPECT_NO_THROW(rig.ReadJoints());
}

// The last command that came through lapses like any other; what is sent without a link does not arrive.
TEST(SimulatedRig, ComesToRestByItselfWhereItsLinkIsLostOnTheWay) {
  SimulationOptions options = IdealDrives();
  options.faults = {{FaultKind::kLinkLost, 0.31, 0.9}};
  SimulatedRig rig(DesktopTruth(), options);
  CommandUntil(rig, Rising(0.04), 0.3);
  EXPECT_THROW(rig.WaitUntil(0.32), RigError);
  EXPECT_THROW(rig.CommandSpeeds(Rising(0.04)), RigError);
  rig.Stop();
  EXPECT_THROW(rig.WaitUntil(0.54), RigError);
  EXPECT_EQ(rig.true_motion().joint_speeds_m_per_s, Rising(0.04));
  rig.WaitUntil(0.9);
  EXPECT_EQ(rig.true_motion().joint_speeds_m_per_s, Rising(0));
  EXPECT_NEAR(DrivenFor_s(rig), 0.3 + Rig::kCommandHolds_s, 1e-9);
  CommandUntil(rig, Rising(0.04), 1.1);  // the link is back
  EXPECT_NEAR(DrivenFor_s(rig), 0.3 + Rig::kCommandHolds_s + 0.2, 1e-9);
}

TEST(SimulatedRig, DrivesOnWhereTheLinkIsBackWithACommandBeforeTheLastOneLapses) {
  SimulationOptions options = IdealDrives();
  options.faults = {{FaultKind::kLinkLost, 0.1, 0.15}};
  SimulatedRig rig(DesktopTruth(), options);
  rig.CommandSpeeds(Rising(0.04));
  EXPECT_THROW(rig.WaitUntil(0.12), RigError);
  rig.Stop();  // does not arrive
  rig.WaitUntil(0.16);
  CommandUntil(rig, Rising(0.04), 0.8);
  EXPECT_NEAR(DrivenFor_s(rig), 0.8, 1e-9);
}

TEST(SimulatedRig, StopBringsTheJointsToRest) {
  SimulatedRig rig(DesktopTruth(), {});
  rig.CommandSpeeds(Rising(0.04));
  rig.WaitUntil(0.2);
  rig.Stop();
  rig.Stop();
  rig.WaitUntil(0.8);
  EXPECT_LT(rig.true_motion().joint_speeds_m_per_s.cwiseAbs().maxCoeff(), 1e-12);
}

// A quarter turn of the platform about the vertical is singular: the legs no longer hold its turning.
TEST(SimulatedRig, SaysThatTheTrueRobotIsSingular) {
  SimulationTruth truth = DesktopTruth();
  for (Leg& leg : truth.robot.legs) leg.joint_range_m = {0.1, 1};
  SimulationOptions options;
  options.drives.lag_s = 0;
  options.drives.speed_limit_m_per_s = 10;
  SimulatedRig rig(truth, options);
  const auto turn = [&] {
    for (int i = 1; i < 400; ++i) {
      Vector6d twist = Vector6d::Zero();
      twist[5] = 0.5;
      rig.CommandSpeeds(InverseJacobian(truth.robot, rig.true_motion().base_from_platform) * twist);
      rig.WaitUntil(i * kPeriod_s);
    }
  };
  std::string message;
  try {
    turn();
  } catch (const RigError& error) {
    message = error.what();
  }
  EXPECT_THAT(message, testing::HasSubstr("the true robot"));
  EXPECT_NE(rig.kinematics_status(), ForwardKinematicsStatus::kConverged);
  EXPECT_GT(VectorFromRotation(rig.true_motion().base_from_platform.rotation).norm(), 1.3);
  EXPECT_THROW(rig.ReadJoints(), RigError);
  EXPECT_NO_THROW(rig.Stop());
}

TEST(SimulationOptions, AreCheckedByField) {
  const auto complaint = [](const auto& spoil) {
    SimulationOptions options;
    spoil(options);
    try {
      SimulatedRig(DesktopTruth(), options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(complaint([](SimulationOptions&) {}), "none");
  EXPECT_EQ(complaint([](SimulationOptions& o) { o.period_s = 0; }),
            "SimulationOptions: period_s is 0; give 0.001 to 10");
  EXPECT_EQ(complaint([](SimulationOptions& o) { o.drives.lag_s = NAN; }),
            "SimulationOptions: drives.lag_s is nan; give 0 to 10");
  EXPECT_EQ(complaint([](SimulationOptions& o) { o.drives.sliding_loss_m_per_s = 0.01; }),
            "SimulationOptions: drives.sliding_loss_m_per_s must not exceed drives.breakaway_speed_m_per_s");
  EXPECT_EQ(complaint([](SimulationOptions& o) { o.scene.ambient = 1.5; }),
            "SimulationOptions: scene.ambient is 1.5; give 0 to 1");
  EXPECT_EQ(complaint([](SimulationOptions& o) { o.scene.light_in_camera.setZero(); }),
            "SimulationOptions: scene.light_in_camera must be finite and not 0");
  EXPECT_EQ(complaint([](SimulationOptions& o) {
              o.faults = {{}, {FaultKind::kLegCovered, 1, 1}};
            }),
            "SimulationOptions: faults[2].until_s must be later than from_s");
  EXPECT_EQ(complaint([](SimulationOptions& o) {
              o.faults = {{FaultKind::kLegCovered, 1, 2, 6}};
            }),
            "SimulationOptions: faults[1].leg must be 0 to 5");
  EXPECT_EQ(complaint([](SimulationOptions& o) {
              o.start = Rigid3{{1, 1, 0, 0}, {0, 0, 0.3}};
            }),
            "SimulationOptions: start.rotation must be a unit quaternion");
}

}  // namespace
}  // namespace legible
