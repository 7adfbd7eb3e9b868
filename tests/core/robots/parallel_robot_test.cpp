#include "core/robots/parallel_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "core/robots/leg_state.h"
#include "core/robots/parallel_kinematics.h"
#include "core/robots/platform_motion.h"
#include "tests/accuracy/upu_robots.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

std::string RefusalOf(const ParallelRobot& robot) {
  try {
    Check(robot);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// What Check says once the robot's second leg, or the robot, has been spoilt.
std::string RefusalOnceSpoilt(ParallelRobot robot, const std::function<void(RobotLeg&)>& spoil) {
  spoil(robot.legs[1]);
  return RefusalOf(robot);
}

TEST(ParallelRobot, OfRandomFamiliesIsFine) {
  std::mt19937_64 generator = TestGenerator();
  EXPECT_EQ(RefusalOf(RandomPlanarRobot(generator, {"_RRR", "R_PR", "P_RP"}).robot), "");
  EXPECT_EQ(RefusalOf(RandomPlanarRobot(generator, {"_PPR", "R_RP"}).robot), "");
  EXPECT_EQ(RefusalOf(RandomSpatialRobot(generator, {"U_PS", "R_PS", "_PUS", "_RUS"}).robot), "");
  EXPECT_EQ(RefusalOf(RandomTranslationRobot(generator, {"U_PU", "_R-{2-US}", "_PUU"}).robot), "");
  EXPECT_EQ(RefusalOf(RandomSchoenfliesRobot(generator, "_P-{2-US}").robot), "");
}

TEST(ParallelRobot, IsRefusedWithLegAndField) {
  std::mt19937_64 generator = TestGenerator();
  const ParallelRobot planar = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"}).robot;
  const ParallelRobot delta =
      RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"}).robot;
  const auto says = [](const char* leg, const char* what) {
    return testing::AllOf(testing::HasSubstr(leg), testing::HasSubstr(what));
  };
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.first_axis *= 1.01; }),
              says("legs[2].first_axis", "no unit vector"));
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.zero_direction = leg.first_axis; }),
              says("legs[2].zero_direction", "across first_axis"));
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.arm_m = 0; }),
              says("legs[2].arm_m", "positive"));
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.rod_m = -1; }),
              says("legs[2].rod_m", "positive"));
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.working_mode = 0; }),
              says("legs[2].working_mode", "1 or -1"));
  EXPECT_THAT(RefusalOnceSpoilt(delta, [](RobotLeg& leg) { leg.chain = ChainFromText("_RRR"); }),
              says("legs[2].chain", "planar"));
  EXPECT_THAT(RefusalOnceSpoilt(planar, [](RobotLeg& leg) { leg.chain = ChainFromText("_RUU"); }),
              says("legs[2].chain", "plane"));
  EXPECT_THAT(RefusalOnceSpoilt(planar, [](RobotLeg& leg) { leg.first_axis = leg.zero_direction; }),
              says("legs[2].first_axis", "z"));
  EXPECT_THAT(RefusalOnceSpoilt(planar,
                                [](RobotLeg& leg) {
                                  leg.chain = ChainFromText("_RRP");
                                  leg.second_axis.setZero();
                                }),
              says("legs[2].second_axis", "no unit vector"));
}

TEST(ParallelRobot, InThePlaneHasAxesAcrossItAndRailsInIt) {
  std::mt19937_64 generator = TestGenerator();
  const ParallelRobot arms = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"}).robot;
  EXPECT_THAT(RefusalOnceSpoilt(arms,
                                [](RobotLeg& leg) {
                                  leg.first_axis = Eigen::Vector3d::UnitX();
                                  leg.zero_direction = Eigen::Vector3d::UnitY();
                                }),
              testing::HasSubstr("legs[2].first_axis"));
  const ParallelRobot rails = RandomPlanarRobot(generator, {"_PPR", "_PRP", "_PRR"}).robot;
  const auto tilt = [](Eigen::Vector3d& axis) { axis = (axis + Eigen::Vector3d(0, 0, 0.1)).normalized(); };
  EXPECT_THAT(RefusalOnceSpoilt(rails, [&](RobotLeg& leg) { tilt(leg.first_axis); }),
              testing::HasSubstr("legs[2].first_axis"));
  EXPECT_THAT(RefusalOnceSpoilt(rails, [&](RobotLeg& leg) { tilt(leg.second_axis); }),
              testing::HasSubstr("legs[2].second_axis"));
}

TEST(ParallelRobot, ThatTurnsAboutZAloneHasAHomeThatIsNotTilted) {
  std::mt19937_64 generator = TestGenerator();
  for (ParallelRobot robot : {RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"}).robot,
                              RandomSchoenfliesRobot(generator, "_R-{2-US}").robot}) {
    EXPECT_EQ(RefusalOf(robot), "");
    robot.home.rotation = RotationFromVector({0.1, 0, 0});
    EXPECT_THAT(RefusalOf(robot), testing::HasSubstr("home"));
  }
}

TEST(ParallelRobotOf, GoughStewartHasItsReadingsAndItsJacobian) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    GoughStewart hexapod = DesktopHexapod(generator, 0.02);
    for (Leg& leg : hexapod.legs) leg.joint_offset_m = Uniform(generator, -0.1, 0.1);
    const ParallelRobot robot = ParallelRobotOf(hexapod);
    EXPECT_EQ(RefusalOf(robot), "");
    const Rigid3 pose = RandomPoseNear(generator, robot, hexapod.home, 0.1);
    EXPECT_TRUE(AreNear(InverseKinematics(robot, pose).value(), InverseKinematics(hexapod, pose), 1e-15));
    Matrix6d rows;
    for (int i = 0; i < kLegCount; ++i) {
      const RobotLeg& leg = robot.legs[static_cast<size_t>(i)];
      rows.row(i) = ReadingRow(leg, StateOf(leg, pose).value(), pose);
    }
    EXPECT_TRUE(AreNear(rows, InverseJacobian(hexapod, pose), 1e-14));
  }
}

TEST(ParallelRobotOf, ThreeUpuHasItsReadings) {
  std::mt19937_64 generator = TestGenerator();
  const ThreeUpu upu = SymmetricUpu(0.9);
  const ParallelRobot robot = ParallelRobotOf(upu);
  EXPECT_EQ(RefusalOf(robot), "");
  for (int n = 0; n < 50; ++n) {
    const Rigid3 pose = RandomPoseNear(generator, robot, upu.home, 0.1);
    EXPECT_TRUE(
        AreNear(InverseKinematics(robot, pose).value(), InverseKinematics(upu, pose.translation), 1e-15));
  }
}

TEST(MotionBasis, IsOrthonormalAndOfTheMotionsFreedoms) {
  std::mt19937_64 generator = TestGenerator();
  const auto expect = [](const RobotAtPose& random, int freedoms) {
    const auto basis = MotionBasis(random.robot, random.pose);
    EXPECT_EQ(basis.cols(), freedoms);
    EXPECT_TRUE(AreNear(basis.transpose() * basis, Eigen::MatrixXd::Identity(freedoms, freedoms), 1e-14));
    EXPECT_TRUE(CanTake(random.robot, random.pose));
  };
  for (int n = 0; n < 20; ++n) {
    expect(RandomPlanarRobot(generator, {"_RRR", "_RRR"}), 2);
    expect(RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"}), 3);
    expect(RandomTranslationRobot(generator, {"U_PU", "U_PU", "U_PU"}), 3);
    expect(RandomSchoenfliesRobot(generator, "_R-{2-US}"), 4);
    expect(RandomSpatialRobot(generator, {"U_PS", "U_PS", "U_PS", "U_PS", "U_PS", "U_PS"}), 6);
    expect(RandomSpatialRobot(generator, {"R_PS", "U_PS", "R_PS", "U_PS"}), 4);
    expect(RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"}), 3);
  }
}

// C keeps to the plane through A across the axis of R.
TEST(PlatformMotion, OfRpsLegsKeepsToTheirPlanes) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
    const Rigid3 moved = RandomPoseNear(generator, random.robot, random.pose, 0.05);
    for (const RobotLeg& leg : random.robot.legs)
      EXPECT_LT(std::abs(leg.first_axis.dot(moved * leg.platform_joint_m - leg.base_joint_m)), 1e-12);
    EXPECT_TRUE(CanTake(random.robot, moved));
    EXPECT_FALSE(
        CanTake(random.robot, Displaced(moved, UniformVector(generator, 0.01, 0.02).replicate<2, 1>())));
  }
}

TEST(PlatformMotion, CannotTakeWhatTurnsOrLeavesThePlane) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose planar = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"});
  const RobotAtPose delta = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  const auto moved = [](const RobotAtPose& random, int coordinate) {
    return Displaced(random.pose, 0.1 * Vector6d::Unit(coordinate));
  };
  EXPECT_TRUE(CanTake(planar.robot, moved(planar, 5)));
  for (const int coordinate : {2, 3, 4}) EXPECT_FALSE(CanTake(planar.robot, moved(planar, coordinate)));
  EXPECT_TRUE(CanTake(delta.robot, moved(delta, 2)));
  for (const int coordinate : {3, 4, 5}) EXPECT_FALSE(CanTake(delta.robot, moved(delta, coordinate)));
}

// Rows of the actuated joints' speeds on the motion: singular where the readings do not tell the pose.
double SmallestSingularValue(const RobotAtPose& random) {
  const auto basis = MotionBasis(random.robot, random.pose);
  Eigen::MatrixXd rows(random.robot.legs.size(), 6);
  for (size_t i = 0; i < random.robot.legs.size(); ++i) {
    const RobotLeg& leg = random.robot.legs[i];
    rows.row(static_cast<Eigen::Index>(i)) = ReadingRow(leg, StateOf(leg, random.pose).value(), random.pose);
  }
  return (rows * basis).jacobiSvd().singularValues().tail<1>()[0];
}

TEST(ForwardKinematics, ReturnsThePoseOfTheInverse) {
  std::mt19937_64 generator = TestGenerator();
  using Draw = std::function<RobotAtPose()>;
  const auto planar = [&](const char* a, const char* b, const char* c) {
    return Draw([&generator, a, b, c] { return RandomPlanarRobot(generator, {a, b, c}); });
  };
  const std::vector<Draw> families = {
      planar("_RRR", "R_RR", "_RRR"),
      planar("_RPR", "R_PR", "R_PR"),
      planar("_PRR", "P_RR", "_PRR"),
      planar("_PPR", "P_PR", "_RRR"),
      planar("_RRP", "R_RP", "_RRR"),
      planar("_PRP", "R_PR", "_RRR"),
      [&] {
        return RandomPlanarRobot(generator, {"_RRR", "R_PR"});
      },
      [&] {
        return RandomSpatialRobot(generator, {"U_PS", "U_PS", "U_PS", "U_PS", "U_PS", "U_PS"});
      },
      [&] {
        return RandomSpatialRobot(generator, {"_PUS", "_RUS", "_PUS", "_RUS", "_PUS", "_RUS"});
      },
      [&] {
        return RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
      },
      [&] {
        return RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
      },
      [&] {
        return RandomTranslationRobot(generator, {"U_PU", "_P-{2-US}", "_PUU"});
      },
      [&] { return RandomSchoenfliesRobot(generator, "_R-{2-US}"); },
      [&] { return RandomSchoenfliesRobot(generator, "_P-{2-US}"); },
  };
  for (const Draw& draw : families)
    for (int n = 0; n < 20; ++n) {
      RobotAtPose random = draw();
      while (SmallestSingularValue(random) < 0.1) random = draw();
      SCOPED_TRACE(random.robot.name + " " + ToText(random.robot.legs[0].chain));
      const Eigen::VectorXd readings = InverseKinematics(random.robot, random.pose).value();
      const ForwardResult found = ForwardKinematics(
          random.robot, readings, RandomPoseNear(generator, random.robot, random.pose, 3e-3));
      EXPECT_EQ(found.status, ForwardKinematicsStatus::kConverged);
      EXPECT_LT(found.largest_error, 1e-10);
      EXPECT_LT(Displacement(found.base_from_platform, random.pose).norm(), 1e-10);
    }
}

TEST(ForwardKinematics, SaysThatItDidNotConvergeWhereNoPoseHasTheReadings) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomPlanarRobot(generator, {"R_PR", "R_PR", "R_PR"});
  const ForwardResult found = ForwardKinematics(random.robot, Eigen::Vector3d(0.01, 50, 0.01), random.pose);
  EXPECT_NE(found.status, ForwardKinematicsStatus::kConverged);
}

}  // namespace
}  // namespace legible
