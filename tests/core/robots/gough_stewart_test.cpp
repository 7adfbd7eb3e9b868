#include "core/robots/gough_stewart.h"

#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Status = ForwardKinematicsStatus;

constexpr double kDegree_rad = std::numbers::pi / 180;

Vector6d RandomDisplacement(std::mt19937_64& generator, double translation_m, double rotation_rad) {
  Vector6d displacement;
  displacement << translation_m * UniformVector(generator, -1, 1).normalized(),
      rotation_rad * UniformVector(generator, -1, 1).normalized();
  return displacement;
}

// A desktop hexapod up to 5 mm and 2 mm of offset away from its symmetric drawing.
GoughStewart RandomRobot(std::mt19937_64& generator) {
  GoughStewart robot = DesktopHexapod(generator, 0.005);
  for (Leg& leg : robot.legs) leg.joint_offset_m = Uniform(generator, -0.002, 0.002);
  return robot;
}

Rigid3 RandomPose(std::mt19937_64& generator, const GoughStewart& robot) {
  return Displaced(robot.home, RandomDisplacement(generator, 0.05, 0.2));
}

// The same robot in frames that lie elsewhere has the same leg lengths.
TEST(InFramesOf, KeepsTheLegsOfTheSameRobotInOtherFrames) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 20; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Rigid3 base = Displaced({}, RandomDisplacement(generator, 0.5, 2)),
                 platform = Displaced({}, RandomDisplacement(generator, 0.5, 2));
    GoughStewart moved = robot;
    for (Leg& leg : moved.legs) {
      leg.base_joint_m = base * leg.base_joint_m;
      leg.platform_joint_m = platform * leg.platform_joint_m;
    }
    const Rigid3 pose = RandomPose(generator, robot);
    EXPECT_TRUE(AreNear(InverseKinematics(moved, InFramesOf(moved, robot, pose)),
                        InverseKinematics(robot, pose), 1e-12));
  }
}

// --- Inverse kinematics. ---------------------------------------------------------------------------------

TEST(InverseKinematics, ReadingsAreTheLegLengthsLessTheOffsets) {
  GoughStewart robot;
  for (int i = 0; i < kLegCount; ++i) {
    robot.legs[i].base_joint_m = {1, 0, 0};
    robot.legs[i].platform_joint_m = {0, 1, 0};
    robot.legs[i].joint_offset_m = 0.1 * i;
  }
  // A quarter turn about z takes B to (-1, 0, 0), and the translation on to (1, 3, 4).
  const Rigid3 pose{RotationFromVector({0, 0, std::numbers::pi / 2}), {2, 3, 4}};
  Vector6d expected;
  expected << 5, 4.9, 4.8, 4.7, 4.6, 4.5;
  EXPECT_TRUE(AreNear(InverseKinematics(robot, pose), expected, 1e-14));
}

TEST(InverseKinematics, DoesNotDependOnTheFramesOfBaseAndPlatform) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const Rigid3 pose = RandomPose(generator, robot);
  const Rigid3 world_from_base{UniformRotation(generator), UniformVector(generator, -1, 1)};
  const Rigid3 tool_from_platform{UniformRotation(generator), UniformVector(generator, -1, 1)};
  GoughStewart moved = robot;
  for (Leg& leg : moved.legs) {
    leg.base_joint_m = world_from_base * leg.base_joint_m;
    leg.platform_joint_m = tool_from_platform * leg.platform_joint_m;
  }
  const Rigid3 world_from_tool = world_from_base * pose * Inverse(tool_from_platform);
  EXPECT_TRUE(AreNear(InverseKinematics(moved, world_from_tool), InverseKinematics(robot, pose), 1e-14));
}

// --- The inverse Jacobian. -------------------------------------------------------------------------------

// Leg lengths after a twist (v, omega) in base has moved the platform; v moves its origin.
struct LegLengthsAfter {
  const GoughStewart& robot;
  Rigid3 base_from_platform;

  template <typename T>
  Eigen::Matrix<T, 6, 1> operator()(const Eigen::Matrix<T, 6, 1>& twist) const {
    Eigen::Matrix<T, 6, 1> lengths;
    for (int i = 0; i < kLegCount; ++i) {
      const Eigen::Vector3d arm_m = base_from_platform.rotation * robot.legs[i].platform_joint_m;
      const Eigen::Matrix<T, 3, 1> arm = arm_m.cast<T>();
      const Eigen::Matrix<T, 3, 1> omega = twist.template tail<3>();
      Eigen::Matrix<T, 3, 1> turned;
      ceres::AngleAxisRotatePoint(omega.data(), arm.data(), turned.data());
      const Eigen::Vector3d offset_m = base_from_platform.translation - robot.legs[i].base_joint_m;
      lengths[i] = (turned + twist.template head<3>() + offset_m.cast<T>()).norm();
    }
    return lengths;
  }
};

TEST(InverseJacobian, MatchesJetsAndCentralDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 100; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Rigid3 pose = RandomPose(generator, robot);
    const LegLengthsAfter lengths{robot, pose};
    const auto readings = [&](const Vector6d& step) {
      return InverseKinematics(robot, Displaced(pose, step));
    };
    const Matrix6d found = InverseJacobian(robot, pose);
    EXPECT_TRUE(AreNear(found, JetJacobian(lengths, Vector6d(Vector6d::Zero())), 1e-14));
    EXPECT_TRUE(AreNear(found, NumericJacobian(readings, Vector6d(Vector6d::Zero())), 1e-11));
  }
}

// --- Forward kinematics. ---------------------------------------------------------------------------------

// From guesses this far away, on random robots in random poses.
void ExpectForwardInvertsInverse(double translation_m, double rotation_rad, int most_iterations) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 2000; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Rigid3 pose = RandomPose(generator, robot);
    const Vector6d error =
        Uniform(generator, 0, 1) * RandomDisplacement(generator, translation_m, rotation_rad);
    const ForwardKinematicsResult found =
        ForwardKinematics(robot, InverseKinematics(robot, pose), Displaced(pose, error));
    ASSERT_EQ(found.status, Status::kConverged);
    EXPECT_TRUE(AreNear(Displacement(pose, found.base_from_platform), Vector6d::Zero(), 1e-11));
    EXPECT_LT(found.largest_length_error_m, 1e-12);
    EXPECT_LE(found.iterations, most_iterations);
  }
}

TEST(ForwardKinematics, StaysWhereTheGuessIsRight) { ExpectForwardInvertsInverse(0, 0, 0); }

TEST(ForwardKinematics, TakesOneStepFromAHundredMillionthAway) { ExpectForwardInvertsInverse(1e-8, 1e-8, 1); }

TEST(ForwardKinematics, InvertsInverseKinematicsFromTwoCentimetresAndFiveDegreesInFiveSteps) {
  ExpectForwardInvertsInverse(0.02, 5 * kDegree_rad, 5);
}

TEST(ForwardKinematics, InvertsInverseKinematicsFromEightCentimetresAndTwentyDegrees) {
  ExpectForwardInvertsInverse(0.08, 20 * kDegree_rad, 8);
}

TEST(ForwardKinematics, ReturnsAUnitRotation) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  Rigid3 pose = robot.home;
  for (int i = 0; i < 1000; ++i) {
    const Rigid3 target = RandomPose(generator, robot);
    pose = ForwardKinematics(robot, InverseKinematics(robot, target), pose).base_from_platform;
    ASSERT_NEAR(pose.rotation.norm(), 1, 1e-15);
  }
}

// The same robot drawn in other units: lengths times `scale`.
GoughStewart Scaled(GoughStewart robot, double scale) {
  robot.home.translation *= scale;
  for (Leg& leg : robot.legs) {
    leg.base_joint_m *= scale;
    leg.platform_joint_m *= scale;
    leg.joint_offset_m *= scale;
  }
  return robot;
}

TEST(ForwardKinematics, TakesTheSameStepsOnARobotOfAnySize) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const Vector6d readings = InverseKinematics(robot, RandomPose(generator, robot));
  const ForwardKinematicsResult found = ForwardKinematics(robot, readings, robot.home);
  for (const double scale : {1.0 / 1024, 1024.0}) {
    const GoughStewart scaled = Scaled(robot, scale);
    const ForwardKinematicsResult same = ForwardKinematics(scaled, scale * readings, scaled.home);
    EXPECT_EQ(same.status, found.status);
    EXPECT_EQ(same.iterations, found.iterations);
    EXPECT_TRUE(
        AreNear(same.base_from_platform.translation / scale, found.base_from_platform.translation, 1e-13));
  }
}

TEST(ForwardKinematics, FindsNoPoseForLegsTenTimesTooLongOrTooShort) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 200; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Vector6d readings = InverseKinematics(robot, RandomPose(generator, robot));
    for (const double factor : {10.0, 1000.0, 0.1}) {
      const ForwardKinematicsResult found = ForwardKinematics(robot, factor * readings, robot.home);
      EXPECT_EQ(found.status, Status::kNotConverged) << "factor " << factor;
    }
  }
}

TEST(ForwardKinematics, FindsNoPoseForReadingsThatAreNotNumbers) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  for (const double bad : {double{NAN}, double{INFINITY}, -double{INFINITY}}) {
    Vector6d readings = InverseKinematics(robot, robot.home);
    readings[3] = bad;
    const ForwardKinematicsResult found = ForwardKinematics(robot, readings, robot.home);
    EXPECT_EQ(found.status, Status::kNotConverged);
    EXPECT_EQ(found.iterations, 0);
    EXPECT_TRUE(AreNear(Displacement(robot.home, found.base_from_platform), Vector6d::Zero(), 0));
  }
}

TEST(ForwardKinematics, StatusHasAName) {
  EXPECT_STREQ(ToString(Status::kConverged), "converged");
  EXPECT_STREQ(ToString(Status::kSingular), "singular");
  EXPECT_STREQ(ToString(Status::kNotConverged), "not converged");
}

// --- Singular poses. -------------------------------------------------------------------------------------

// Smallest over largest singular value of the inverse Jacobian, its rotations in units of 1 / (0.2 m).
double ReciprocalCondition(const GoughStewart& robot, const Rigid3& pose) {
  Matrix6d jacobian = InverseJacobian(robot, pose);
  jacobian.rightCols<3>() /= 0.2;
  const Vector6d values = Eigen::JacobiSVD<Matrix6d>(jacobian).singularValues();
  return values[5] / values[0];
}

// Fichter's: the platform of a symmetric hexapod turned by a quarter about the vertical, at any height.
Rigid3 FichterPose(const GoughStewart& robot, double yaw_rad) {
  return {RotationFromVector({0, 0, yaw_rad}), robot.home.translation};
}

TEST(ForwardKinematics, IsSingularAtFichtersQuarterTurnOfARegularHexapod) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  EXPECT_GT(ReciprocalCondition(robot, robot.home), 0.1);
  for (const double yaw_rad : {90 * kDegree_rad, -90 * kDegree_rad}) {
    const Rigid3 pose = FichterPose(robot, yaw_rad);
    EXPECT_LT(ReciprocalCondition(robot, pose), 1e-14);
    for (const double scale : {1e-3, 1.0, 1e3}) {
      const GoughStewart scaled = Scaled(robot, scale);
      const Rigid3 guess = FichterPose(scaled, yaw_rad);
      EXPECT_EQ(ForwardKinematics(scaled, InverseKinematics(scaled, scaled.home), guess).status,
                Status::kSingular);
    }
  }
}

TEST(ForwardKinematics, IsSingularWhereTheReadingsBelongToASingularPose) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  const Vector6d readings = InverseKinematics(robot, FichterPose(robot, 90 * kDegree_rad));
  const Rigid3 guess = FichterPose(robot, 80 * kDegree_rad);
  EXPECT_EQ(ForwardKinematics(robot, readings, guess).status, Status::kSingular);
}

TEST(ForwardKinematics, IsSingularForARobotWhoseLegsAreParallel) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0.005);
  for (Leg& leg : robot.legs) leg.platform_joint_m = leg.base_joint_m;
  EXPECT_EQ(ForwardKinematics(robot, Vector6d::Constant(0.4), robot.home).status, Status::kSingular);
}

TEST(ForwardKinematics, IsSingularForARobotWhosePlatformIsAPoint) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0.005);
  for (Leg& leg : robot.legs) leg.platform_joint_m.setZero();
  EXPECT_EQ(ForwardKinematics(robot, Vector6d::Constant(0.4), robot.home).status, Status::kSingular);
}

}  // namespace
}  // namespace legible
