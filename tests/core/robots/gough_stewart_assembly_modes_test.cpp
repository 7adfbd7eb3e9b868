#include "core/robots/gough_stewart_assembly_modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/robots/assembly_mode_start.h"
#include "datasets/robot_file.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

GoughStewart RobotOf(const std::array<Eigen::Vector3d, 6>& base,
                     const std::array<Eigen::Vector3d, 6>& platform) {
  GoughStewart robot;
  for (size_t i = 0; i < kLegCount; ++i) {
    robot.legs[i].base_joint_m = base[i];
    robot.legs[i].platform_joint_m = platform[i];
  }
  return robot;
}

// Joints anywhere in two cubes with edges of 2 m, offsets of up to 0.1 m.
GoughStewart RandomRobot(std::mt19937_64& generator) {
  GoughStewart robot;
  for (Leg& leg : robot.legs) {
    leg.base_joint_m = UniformVector(generator, -1, 1);
    leg.platform_joint_m = UniformVector(generator, -1, 1);
    leg.joint_offset_m = Uniform(generator, -0.1, 0.1);
  }
  return robot;
}

Rigid3 RandomPose(std::mt19937_64& generator) {
  return {UniformRotation(generator), UniformVector(generator, -2, 2)};
}

Rigid3 PoseNearHome(std::mt19937_64& generator, const GoughStewart& robot) {
  Vector6d displacement;
  displacement << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.2, 0.2);
  return Displaced(robot.home, displacement);
}

double DistanceTo(const GoughStewartAssemblyModes& found, const Rigid3& pose) {
  double distance = std::numeric_limits<double>::infinity();
  for (const GoughStewartAssemblyMode& mode : found.modes)
    distance = std::min(distance, Displacement(mode.base_from_platform, pose).norm());
  return distance;
}

// What holds of every result.
void ExpectSound(const GoughStewartAssemblyModes& found, const GoughStewart& robot,
                 const Vector6d& readings_m) {
  EXPECT_LE(found.certified, 40);
  EXPECT_LE(found.modes.size(), static_cast<size_t>(found.certified));
  EXPECT_EQ((found.certified - static_cast<int>(found.modes.size())) % 2,
            0);  // the others are conjugate pairs
  EXPECT_EQ(found.certified + found.at_infinity + found.uncertified, 40);
  EXPECT_EQ(found.is_complete, found.certified == 40);
  for (const GoughStewartAssemblyMode& mode : found.modes) {
    const Vector6d errors_m = InverseKinematics(robot, mode.base_from_platform) - readings_m;
    EXPECT_LT(errors_m.cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(mode.largest_length_error_m, errors_m.cwiseAbs().maxCoeff());
  }
  for (size_t i = 0; i < found.modes.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_GT(Displacement(found.modes[i].base_from_platform, found.modes[j].base_from_platform).norm(),
                1e-9);
}

// Each of the modes is one of the others', and they are as many.
void ExpectSameModes(const GoughStewartAssemblyModes& found, const GoughStewartAssemblyModes& others) {
  EXPECT_EQ(found.modes.size(), others.modes.size());
  for (const GoughStewartAssemblyMode& mode : found.modes)
    EXPECT_LT(DistanceTo(others, mode.base_from_platform), 1e-7);
}

// P. Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures, Advances in Robot
// Kinematics 1998: the robot that he found, as printed.
TEST(AllAssemblyModes, OfDietmaiersRobotAreFortyAllReal) {
  const GoughStewart robot = RobotOf({{{0, 0, 0},
                                       {1.107915, 0, 0},
                                       {0.549094, 0.756063, 0},
                                       {0.735077, -0.223935, 0.525991},
                                       {0.514188, -0.526063, -0.368418},
                                       {0.590473, 0.094733, -0.205018}}},
                                     {{{0, 0, 0},
                                       {0.542805, 0, 0},
                                       {0.956919, -0.528915, 0},
                                       {0.665885, -0.353482, 1.402538},
                                       {0.478359, 1.158742, 0.107672},
                                       {-0.137087, -0.235121, 0.353913}}});
  Vector6d lengths_m;
  lengths_m << 1, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071;
  const GoughStewartAssemblyModes found = AllAssemblyModes(robot, lengths_m);
  ExpectSound(found, robot, lengths_m);
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.modes.size(), 40);
}

TEST(AllAssemblyModes, OfGeneralRobotsAreCompleteAndHoldThePoseThatMadeTheLengths) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 30; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Rigid3 pose = RandomPose(generator);
    const Vector6d readings_m = InverseKinematics(robot, pose);
    const GoughStewartAssemblyModes found = AllAssemblyModes(robot, readings_m);
    ExpectSound(found, robot, readings_m);
    EXPECT_TRUE(found.is_complete) << found.certified << " certified of robot " << i;
    EXPECT_LT(DistanceTo(found, pose), 1e-9);
  }
}

TEST(AllAssemblyModes, DoNotDependOnWhereThePathsStart) {
  std::mt19937_64 generator = TestGenerator();
  const AssemblyModeStart other_start = MakeAssemblyModeStart(7);
  for (int i = 0; i < 20; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Vector6d readings_m = InverseKinematics(robot, RandomPose(generator));
    const GoughStewartAssemblyModes others = AllAssemblyModes(robot, readings_m, other_start);
    EXPECT_TRUE(others.is_complete);
    ExpectSameModes(AllAssemblyModes(robot, readings_m), others);
  }
}

TEST(AllAssemblyModes, OfTheShippedHexapodAreThoseOfBothStartsAndHoldItsPose) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = ReadRobot(std::string(LEGIBLE_SOURCE_DIR) + "/datasets/hexapod/robot.yaml");
  const AssemblyModeStart other_start = MakeAssemblyModeStart(7);
  for (int i = 0; i < 5; ++i) {
    const Rigid3 pose = PoseNearHome(generator, robot);
    const Vector6d readings_m = InverseKinematics(robot, pose);
    const GoughStewartAssemblyModes found = AllAssemblyModes(robot, readings_m);
    ExpectSound(found, robot, readings_m);
    EXPECT_LT(DistanceTo(found, pose), 1e-9);
    ExpectSameModes(found, AllAssemblyModes(robot, readings_m, other_start));
  }
}

// A robot as it is built, up to 2 mm off its symmetric drawing.
TEST(AllAssemblyModes, OfBuiltHexapodsAreComplete) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 20; ++i) {
    const GoughStewart robot = DesktopHexapod(generator, 0.002);
    const Rigid3 pose = PoseNearHome(generator, robot);
    const Vector6d readings_m = InverseKinematics(robot, pose);
    const GoughStewartAssemblyModes found = AllAssemblyModes(robot, readings_m);
    ExpectSound(found, robot, readings_m);
    EXPECT_TRUE(found.is_complete) << found.certified << " certified of robot " << i;
    EXPECT_LT(DistanceTo(found, pose), 1e-9);
  }
}

// With the platform's joints in three places it has at most 16 (P. Nanua, K. Waldron and V. Murthy, Direct
// kinematic solution of a Stewart platform, IEEE Transactions on Robotics and Automation 6, 1990): the other
// paths leave.
TEST(AllAssemblyModes, OfA63PlatformAreSixteenAndNotCompleteByCount) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 5; ++i) {
    GoughStewart robot = RandomRobot(generator);
    for (size_t pair = 0; pair < 6; pair += 2)
      robot.legs[pair + 1].platform_joint_m = robot.legs[pair].platform_joint_m;
    const Rigid3 pose = RandomPose(generator);
    const Vector6d readings_m = InverseKinematics(robot, pose);
    const GoughStewartAssemblyModes found = AllAssemblyModes(robot, readings_m);
    ExpectSound(found, robot, readings_m);
    EXPECT_EQ(found.certified, 16);
    EXPECT_FALSE(found.is_complete);
    EXPECT_GE(found.at_infinity, 20);  // of 24; as far as doubles tell
    EXPECT_LT(DistanceTo(found, pose), 1e-9);
  }
}

// A platform in a plane, mirrored in the base's plane and in its own, has the same legs.
TEST(AllAssemblyModes, OfPlanarRobotsComeInMirroredPairs) {
  std::mt19937_64 generator = TestGenerator();
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal();
  for (int i = 0; i < 10; ++i) {
    GoughStewart robot = RandomRobot(generator);
    for (Leg& leg : robot.legs) leg.base_joint_m.z() = leg.platform_joint_m.z() = 0;
    const Vector6d readings_m = InverseKinematics(robot, RandomPose(generator));
    const GoughStewartAssemblyModes found = AllAssemblyModes(robot, readings_m);
    ExpectSound(found, robot, readings_m);
    EXPECT_TRUE(found.is_complete);
    for (const GoughStewartAssemblyMode& mode : found.modes) {
      const Eigen::Matrix3d rotation = mode.base_from_platform.rotation.toRotationMatrix();
      const Rigid3 mirrored{Eigen::Quaterniond(Eigen::Matrix3d(mirror * rotation * mirror)),
                            mirror * mode.base_from_platform.translation};
      EXPECT_LT(DistanceTo(found, mirrored), 1e-9);
    }
  }
}

TEST(AllAssemblyModes, DoNotDependOnTheFramesNorOnTheUnitOfLength) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 5; ++i) {
    const GoughStewart robot = RandomRobot(generator);
    const Vector6d readings_m = InverseKinematics(robot, RandomPose(generator));
    const Rigid3 world_from_base = RandomPose(generator), tool_from_platform = RandomPose(generator);
    constexpr double kScale = 1000;
    GoughStewart moved = robot;
    for (Leg& leg : moved.legs) {
      leg.base_joint_m = kScale * (world_from_base * leg.base_joint_m);
      leg.platform_joint_m = kScale * (tool_from_platform * leg.platform_joint_m);
      leg.joint_offset_m *= kScale;
    }
    GoughStewartAssemblyModes found = AllAssemblyModes(moved, kScale * readings_m);
    EXPECT_TRUE(found.is_complete);
    for (GoughStewartAssemblyMode& mode : found.modes) {
      mode.base_from_platform.translation /= kScale;
      mode.base_from_platform = Inverse(world_from_base) * mode.base_from_platform * tool_from_platform;
    }
    ExpectSameModes(found, AllAssemblyModes(robot, readings_m));
  }
}

// Legs whose lines all meet the z axis: about it the platform turns a little with no leg's length changing,
// so that two modes are one. Whole numbers throughout, lengths included, or rounding would part the two.
TEST(AllAssemblyModes, OfAPoseWhereTwoMeetAreNotComplete) {
  const std::array<Eigen::Vector3d, 6> directions = {
      {{1, 2, 2}, {2, 3, 6}, {-1, 4, 8}, {4, -4, 7}, {-2, -6, 9}, {6, -7, -6}}};
  const std::array<double, 6> norms = {3, 7, 9, 9, 11, 11}, heights = {0, 1, -2, 3, 5, -4};
  const std::array<double, 6> to_base = {3, 1, -1, -1, 2, 2}, to_platform = {-2, 2, -3, 1, 1, -1};
  GoughStewart robot;
  Vector6d lengths_m;
  for (size_t i = 0; i < kLegCount; ++i) {
    ASSERT_EQ(directions[i].norm(), norms[i]);
    const Eigen::Vector3d on_axis(0, 0, heights[i]);
    robot.legs[i].base_joint_m = on_axis + to_base[i] * directions[i];
    robot.legs[i].platform_joint_m = on_axis + to_platform[i] * directions[i];
    lengths_m[static_cast<Eigen::Index>(i)] = std::abs(to_base[i] - to_platform[i]) * norms[i];
  }
  const GoughStewartAssemblyModes found = AllAssemblyModes(robot, lengths_m);
  ExpectSound(found, robot, lengths_m);
  EXPECT_FALSE(found.is_complete);
  EXPECT_GT(DistanceTo(found, Rigid3()), 1e-3);
  EXPECT_EQ(found.certified, 38);
  EXPECT_EQ(found.uncertified, 2);
}

TEST(AllAssemblyModes, RefuseLengthsAndJointsThatAreNone) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0.002);
  const Vector6d readings_m = InverseKinematics(robot, robot.home);
  Vector6d wrong_m = readings_m;
  wrong_m[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(AllAssemblyModes(robot, wrong_m), std::invalid_argument);
  wrong_m[3] = -0.1;
  EXPECT_THROW(AllAssemblyModes(robot, wrong_m), std::invalid_argument);
  GoughStewart wrong_robot = robot;
  wrong_robot.legs[0].base_joint_m.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(AllAssemblyModes(wrong_robot, readings_m), std::invalid_argument);
}

TEST(AssemblyModeStart, SatisfiesItsConditionsAtFortyDifferentMotions) {
  const AssemblyModeStart start = MakeAssemblyModeStart(3);
  ASSERT_EQ(start.solutions.size(), 40);
  for (size_t i = 0; i < 40; ++i) {
    const auto& v = start.solutions[i];
    for (const auto& quadric : start.quadrics)
      EXPECT_LT(std::abs(v.cwiseProduct(quadric * v).sum()), 1e-11 * quadric.norm());
    for (size_t j = 0; j < i; ++j) EXPECT_LT(std::abs(v.dot(start.solutions[j])), 1 - 1e-8);
  }
}

}  // namespace
}  // namespace legible
