#include "core/rig/drives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/synthetic_session.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kStart_m = 0.4;

Drives SomeDrives(const DriveOptions& options, std::uint64_t seed = 1) {
  return {options, DesktopHexapod(), Vector6d::Constant(kStart_m), seed};
}

// Uniform friction in all joints.
DriveOptions WithFriction(double breakaway_m_per_s, double sliding_m_per_s) {
  DriveOptions options;
  options.breakaway_speed_m_per_s = breakaway_m_per_s;
  options.sliding_loss_m_per_s = sliding_m_per_s;
  options.friction_variation = 0;
  return options;
}

TEST(Drives, FollowTheirCommandsWithALagOfFirstOrder) {
  DriveOptions options;
  options.lag_s = 0.03;
  Drives drives = SomeDrives(options);
  const Vector6d first = (Vector6d() << 0.01, 0.02, -0.03, 0.04, -0.05, 0).finished();
  drives.Command(first);
  drives.Advance(0.05);
  const double left = std::exp(-0.05 / 0.03);
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), first * (1 - left), 1e-15));
  Vector6d expected_m = Vector6d::Constant(kStart_m) + first * (0.05 - 0.03 * (1 - left));
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), expected_m, 1e-14));

  drives.Command(-first);  // through zero, where nothing sticks
  drives.Advance(0.08);
  const double left_later = std::exp(-0.08 / 0.03);
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), first * (-1 + (2 - left) * left_later), 1e-15));
  expected_m += first * (-0.08 + (2 - left) * 0.03 * (1 - left_later));
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), expected_m, 1e-14));
}

TEST(Drives, WithoutLagMoveAtTheirCommandAtOnce) {
  DriveOptions options;
  options.lag_s = 0;
  Drives drives = SomeDrives(options);
  for (const double speed : {0.02, -0.03, 0.0}) {
    const Vector6d before_m = drives.joint_readings_m();
    drives.Command(Vector6d::Constant(speed));
    drives.Advance(0.02);
    EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), Vector6d::Constant(speed), 0));
    EXPECT_TRUE(AreNear(drives.joint_readings_m() - before_m, Vector6d::Constant(0.02 * speed), 1e-15));
  }
}

TEST(Drives, CutOffCommandsBeyondTheLimitJointByJoint) {
  DriveOptions options;
  options.speed_limit_m_per_s = 0.05;
  Drives drives = SomeDrives(options);
  drives.Command((Vector6d() << 0.05, -0.05, 0, 0.01, 0.02, 0.03).finished());
  EXPECT_FALSE(drives.was_commanded_too_fast());
  const Vector6d command = (Vector6d() << 0.04, 0.06, -1, 0.02, 0, 0.05).finished();
  drives.Command(command);
  EXPECT_TRUE(drives.was_commanded_too_fast());
  drives.Advance(1);
  const Vector6d expected = (Vector6d() << 0.04, 0.05, -0.05, 0.02, 0, 0.05).finished();
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s().head<2>(), expected.head<2>(), 1e-15));
  EXPECT_LE(drives.largest_speed_m_per_s(), 0.05);
  EXPECT_THROW(drives.Command(Vector6d::Constant(NAN)), std::invalid_argument);
}

TEST(Drives, StickUntilTheBreakawaySpeedIsOvercome) {
  Drives drives = SomeDrives(WithFriction(0.01, 0.004));
  drives.Command((Vector6d() << 0.00999, -0.00999, 0.005, 0.01, 0, -0.01).finished());
  drives.Advance(2);
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), Vector6d::Constant(kStart_m), 0));
  EXPECT_EQ(drives.largest_speed_m_per_s(), 0);

  // The lagging speed c (1 - exp(-t / lag)) passes the breakaway speed at a known time; then it slides.
  constexpr double kLag_s = 0.02, kCommand = 0.03, kTime_s = 0.1;
  Drives sliding = SomeDrives(WithFriction(0.01, 0.004));
  sliding.Command(Vector6d::Constant(kCommand));
  sliding.Advance(kTime_s);
  const double start_s = kLag_s * std::log(kCommand / (kCommand - 0.01));
  const double slid_m = (kCommand - 0.004) * (kTime_s - start_s) -
                        kCommand * kLag_s * (std::exp(-start_s / kLag_s) - std::exp(-kTime_s / kLag_s));
  EXPECT_TRUE(AreNear(sliding.joint_readings_m(), Vector6d::Constant(kStart_m + slid_m), 1e-14));
}

TEST(Drives, SlideOnBelowTheBreakawaySpeedUntilNothingIsLeft) {
  Drives drives = SomeDrives(WithFriction(0.01, 0.004));
  drives.Command(Vector6d::Constant(-0.03));
  drives.Advance(1);
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), Vector6d::Constant(-0.026), 1e-15));
  drives.Command(Vector6d::Constant(-0.006));
  drives.Advance(1);
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), Vector6d::Constant(-0.002), 1e-15));

  // At rest once -0.006 exp(-t / lag) has come to -0.004.
  const double from_m = drives.joint_readings_m()[0];
  drives.Command(Vector6d::Zero());
  drives.Advance(1);
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), Vector6d::Zero(), 0));
  const double slid_m = -0.02 * (0.006 - 0.004) + 0.02 * std::log(0.006 / 0.004) * 0.004;
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), Vector6d::Constant(from_m + slid_m), 1e-14));
}

TEST(Drives, FrictionVariesWithEachJointsLengthInItsOwnPhase) {
  DriveOptions options = WithFriction(0.01, 0.004);
  options.friction_variation = 0.5;
  const Drives drives = SomeDrives(options, 7), same = SomeDrives(options, 7), other = SomeDrives(options, 8);
  for (int i = 0; i < kLegCount; ++i) {
    double lowest = 1, highest = 0, sum = 0;
    for (int k = 0; k < 1000; ++k) {
      const double reading_m = 0.35 + k * options.friction_period_m / 1000;
      const Friction friction = drives.FrictionAt(i, reading_m);
      EXPECT_NEAR(friction.sliding_loss_m_per_s / friction.breakaway_speed_m_per_s, 0.4, 1e-12);
      EXPECT_EQ(friction.breakaway_speed_m_per_s, same.FrictionAt(i, reading_m).breakaway_speed_m_per_s);
      lowest = std::min(lowest, friction.breakaway_speed_m_per_s);
      highest = std::max(highest, friction.breakaway_speed_m_per_s);
      sum += friction.breakaway_speed_m_per_s;
    }
    EXPECT_NEAR(lowest, 0.005, 1e-6);
    EXPECT_NEAR(highest, 0.015, 1e-6);
    EXPECT_NEAR(sum / 1000, 0.01, 1e-12);
    const auto at = [&](const Drives& some, int joint) {
      return some.FrictionAt(joint, kStart_m).breakaway_speed_m_per_s;
    };
    EXPECT_NE(at(drives, i), at(other, i));
    EXPECT_NE(at(drives, i), at(drives, (i + 1) % kLegCount));
  }
}

// The same law in steps of a microsecond, with the friction of every moment.
double SlidInTinySteps(const Drives& drives, int joint, double lag_s, double (*command)(double),
                       double until_s) {
  constexpr double kStep_s = 1e-6;
  double reading_m = kStart_m, motor = 0;
  int direction = 0;
  for (int step = 0; step * kStep_s < until_s; ++step) {
    const double period_start_s = std::floor((step + 0.5) * kStep_s / 0.02) * 0.02;
    motor += (command(period_start_s) - motor) * kStep_s / lag_s;
    const Friction friction = drives.FrictionAt(joint, reading_m);
    if (direction == 0 && std::abs(motor) > friction.breakaway_speed_m_per_s) direction = motor > 0 ? 1 : -1;
    if (direction != 0 && direction * motor < friction.sliding_loss_m_per_s) direction = 0;
    if (direction != 0) reading_m += (motor - direction * friction.sliding_loss_m_per_s) * kStep_s;
  }
  return reading_m;
}

TEST(Drives, AgreeWithTheSameLawInTinySteps) {
  DriveOptions options = WithFriction(0.006, 0.004);
  options.friction_variation = 0.5;
  const auto command = [](double time_s) { return 0.02 * std::sin(7 * time_s) + 0.004; };
  Drives drives = SomeDrives(options);
  for (int period = 0; period < 60; ++period) {
    drives.Command(Vector6d::Constant(command(period * 0.02)));
    drives.Advance(0.02);
  }
  // Both err by about half a step's travel in where they look up the friction, 5 um at most, which changes by
  // a fifth of itself in a millimetre: by 0.1 % of 4 mm/s over 1.2 s.
  for (int i = 0; i < kLegCount; ++i)
    EXPECT_NEAR(drives.joint_readings_m()[i], SlidInTinySteps(drives, i, options.lag_s, command, 1.2), 5e-6);
}

TEST(Drives, NeverLeaveTheirRangeNorExceedTheLimitAndSayWhichJointHitItsStop) {
  std::mt19937_64 generator = TestGenerator();
  for (const double lag_s : {0.0, 0.02, 0.1}) {
    DriveOptions options = WithFriction(0.01, 0.005);
    options.friction_variation = 1;
    options.lag_s = lag_s;
    Drives drives = SomeDrives(options);
    std::array<bool, kLegCount> was_at_stop{};
    for (int step = 0; step < 3000; ++step) {
      Vector6d command;
      for (double& speed : command) speed = Uniform(generator, -0.2, 0.2);
      command[5] = 0;
      drives.Command(command);
      drives.Advance(Uniform(generator, 0, 0.3));
      const Vector6d readings_m = drives.joint_readings_m();
      EXPECT_GE(readings_m.minCoeff(), 0.345);
      EXPECT_LE(readings_m.maxCoeff(), 0.485);
      EXPECT_LE(drives.joint_speeds_m_per_s().cwiseAbs().maxCoeff(), options.speed_limit_m_per_s);
      for (int i = 0; i < kLegCount; ++i)
        was_at_stop[static_cast<size_t>(i)] |= readings_m[i] == 0.345 || readings_m[i] == 0.485;
      for (int i = 0; i < kLegCount; ++i)
        EXPECT_LE(was_at_stop[static_cast<size_t>(i)], drives.hit_end_stop()[static_cast<size_t>(i)]);
    }
    EXPECT_LE(drives.largest_speed_m_per_s(), options.speed_limit_m_per_s);
    EXPECT_EQ(drives.hit_end_stop(), (std::array<bool, kLegCount>{true, true, true, true, true, false}));
  }
}

TEST(Drives, RestAtAnEndStopAndLeaveItWhenCommandedBack) {
  Drives drives = SomeDrives({});
  drives.Command(Vector6d::Constant(0.1));
  drives.Advance(2);
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), Vector6d::Constant(0.485), 0));
  EXPECT_TRUE(AreNear(drives.joint_speeds_m_per_s(), Vector6d::Zero(), 0));
  drives.Command(Vector6d::Constant(-0.1));
  drives.Advance(0.1);
  // The motor turns round first: its speed -0.1 + 0.2 exp(-t / lag) is 0 at lag log 2.
  const double start_s = 0.02 * std::log(2.0);
  const double left_m = -0.1 * (0.1 - start_s) + 0.2 * 0.02 * (0.5 - std::exp(-0.1 / 0.02));
  EXPECT_TRUE(AreNear(drives.joint_readings_m(), Vector6d::Constant(0.485 + left_m), 1e-14));
}

TEST(Drives, DoNotDependOnHowTheTimeIsDivided) {
  Drives whole = SomeDrives(WithFriction(0.006, 0.004)), divided = whole;
  for (Drives* drives : {&whole, &divided}) drives->Command(Vector6d::Constant(0.03));
  whole.Advance(0.2);
  for (int i = 0; i < 400; ++i) divided.Advance(0.0005);
  EXPECT_TRUE(AreNear(whole.joint_readings_m(), divided.joint_readings_m(), 1e-14));
}

TEST(Drives, QuantiseTheirReadings) {
  DriveOptions options;
  options.reading_step_m = 1e-5;
  Drives drives = SomeDrives(options);
  drives.Command((Vector6d() << 1, 2, 3, 4, 5, 6).finished() * 1.2345e-3);
  drives.Advance(1.111);
  const Vector6d measured_m = drives.Measure(0), truth_m = drives.joint_readings_m();
  for (int i = 0; i < kLegCount; ++i) EXPECT_NEAR(std::remainder(measured_m[i], 1e-5), 0, 1e-15);
  EXPECT_LE((measured_m - truth_m).cwiseAbs().maxCoeff(), 0.5e-5 + 1e-15);
  EXPECT_GT((measured_m - truth_m).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Drives, ReadingsScatterByTheirNoiseAndRepeatByTheirKey) {
  DriveOptions options;
  options.reading_step_m = 0;
  options.reading_noise_m = 3e-6;
  const Drives drives = SomeDrives(options);
  constexpr int kDraws = 20000;
  Vector6d sum = Vector6d::Zero();
  Matrix6d scatter = Matrix6d::Zero();
  for (int key = 0; key < kDraws; ++key) {
    const Vector6d error = (drives.Measure(key) - drives.joint_readings_m()) / options.reading_noise_m;
    EXPECT_EQ(drives.Measure(key), drives.Measure(key));
    sum += error / kDraws;
    scatter += error * error.transpose() / kDraws;
  }
  // Five standard deviations of a mean, and of a variance.
  EXPECT_TRUE(AreNear(sum, Vector6d::Zero(), 5 / std::sqrt(kDraws)));
  EXPECT_TRUE(AreNear(scatter, Matrix6d::Identity(), 5 * std::sqrt(2.0 / kDraws)));
  EXPECT_NE(drives.Measure(1), SomeDrives(options, 2).Measure(1));
}

TEST(Drives, StartWithinTheirRanges) {
  EXPECT_THROW(Drives({}, DesktopHexapod(), Vector6d::Constant(0.5), 1), std::invalid_argument);
  EXPECT_THROW(Drives({}, DesktopHexapod(), Vector6d::Constant(NAN), 1), std::invalid_argument);
}

}  // namespace
}  // namespace legible
