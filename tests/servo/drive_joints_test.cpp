#include "servo/drive_joints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rig/simulated_rig.h"
#include "tests/core/rig/desktop_rig.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using testing::HasSubstr;

Vector6d FarReadings() {
  Vector6d readings_m;
  readings_m << 0.41, 0.36, 0.43, 0.39, 0.44, 0.37;
  return readings_m;
}

Vector6d TrueReadings(const SimulatedRig& rig) { return rig.true_motion().joint_readings_m; }

TEST(DriveJoints, ArrivesWithinItsToleranceAndStands) {
  SimulatedRig rig(DesktopTruth(), {});
  const JointDrive drive = DriveJoints(rig, DesktopHexapod(), FarReadings(), {});
  EXPECT_TRUE(drive.has_arrived);
  EXPECT_EQ(drive.end, ServoEnd::kConverged);
  rig.WaitUntil(rig.true_time_s() + 1);
  EXPECT_LT((TrueReadings(rig) - FarReadings()).cwiseAbs().maxCoeff(), 2e-4);
  EXPECT_LT(rig.true_motion().joint_speeds_m_per_s.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DriveJoints, KeepsTheSpeedLimitAndTheRangesOnTheWay) {
  std::mt19937_64 generator = TestGenerator();
  SimulatedRig rig(DesktopTruth(), {});
  JointDriveOptions options;
  options.limits.speed_limit_m_per_s = 0.03;
  for (int i = 0; i < 20; ++i) {
    Vector6d goal_m;
    for (double& reading_m : goal_m) reading_m = Uniform(generator, 0.365, 0.42);
    const JointDrive drive = DriveJoints(rig, DesktopHexapod(), goal_m, options);
    EXPECT_TRUE(drive.has_arrived) << drive.reason;
  }
  EXPECT_LE(rig.drives().largest_speed_m_per_s(), 0.03 * (1 + 1e-12));
  EXPECT_FALSE(rig.drives().was_commanded_too_fast());
  for (const bool hit : rig.drives().hit_end_stop()) EXPECT_FALSE(hit);
}

TEST(DriveJoints, HasArrivedNearEnoughWhereFrictionHoldsIt) {
  SimulationOptions simulation = RoughOptions();
  SimulatedRig rig(DesktopTruth(), simulation);
  JointDriveOptions options;
  options.tolerance_m = 1e-5;  // by which no command overcomes the breakaway speed
  const JointDrive drive = DriveJoints(rig, DesktopHexapod(), FarReadings(), options);
  EXPECT_TRUE(drive.has_arrived) << drive.reason;
  EXPECT_EQ(drive.end, ServoEnd::kStalled);
  EXPECT_LT((TrueReadings(rig) - FarReadings()).cwiseAbs().maxCoeff(), options.near_enough_m);
}

TEST(DriveJoints, HasNotArrivedWhereTheRobotCannotGo) {
  SimulatedRig rig(DesktopTruth(), {});
  Vector6d beyond_m = FarReadings();
  beyond_m[1] = 0.6;
  const JointDrive drive = DriveJoints(rig, DesktopHexapod(), beyond_m, {});
  EXPECT_FALSE(drive.has_arrived);
  EXPECT_FALSE(drive.is_hopeless) << "another goal may be in reach";
  EXPECT_FALSE(rig.drives().hit_end_stop()[1]);
}

TEST(DriveJoints, IsHopelessWithoutALinkWithoutReadingsAndOnceTheUserHasStoppedIt) {
  for (const FaultKind kind : {FaultKind::kLinkLost, FaultKind::kReadingsNan, FaultKind::kReadingsFrozen}) {
    SimulatedRig rig(DesktopTruth(), WithFault({kind, 0.3}));
    const JointDrive drive = DriveJoints(rig, DesktopHexapod(), FarReadings(), {});
    EXPECT_FALSE(drive.has_arrived);
    EXPECT_TRUE(drive.is_hopeless) << drive.reason;
    EXPECT_NE(drive.reason, "");
  }
  SimulatedRig rig(DesktopTruth(), {});
  JointDriveOptions options;
  options.is_stopped = [&rig] { return rig.true_time_s() > 0.5; };
  const JointDrive drive = DriveJoints(rig, DesktopHexapod(), FarReadings(), options);
  EXPECT_TRUE(drive.is_hopeless);
  EXPECT_THAT(drive.reason, HasSubstr("stopped by the user"));
}

TEST(DriveJoints, RefusesOptionsThatCannotBe) {
  SimulatedRig rig(DesktopTruth(), {});
  JointDriveOptions options;
  options.near_enough_m = options.tolerance_m / 2;
  EXPECT_THROW(DriveJoints(rig, DesktopHexapod(), FarReadings(), options), std::invalid_argument);
}

}  // namespace
}  // namespace legible
