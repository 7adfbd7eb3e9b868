#include "accuracy/batch_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "accuracy/conditioning.h"
#include "accuracy/maximal_errors.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kCharacteristicLength_m = 0.2;

// A desktop hexapod up to 5 mm and 2 mm of offset away from its symmetric drawing.
GoughStewart RandomRobot(std::mt19937_64& generator) {
  GoughStewart robot = DesktopHexapod(generator, 0.005);
  for (Leg& leg : robot.legs) leg.joint_offset_m = Uniform(generator, -0.002, 0.002);
  return robot;
}

// Up to 8 cm along and so far about each axis from home.
std::vector<Rigid3> RandomPoses(std::mt19937_64& generator, const GoughStewart& robot, size_t count,
                                double rotation_rad = 0.4) {
  std::vector<Rigid3> poses;
  for (size_t i = 0; i < count; ++i) {
    Vector6d displacement;
    displacement << UniformVector(generator, -0.08, 0.08),
        UniformVector(generator, -rotation_rad, rotation_rad);
    poses.push_back(Displaced(robot.home, displacement));
  }
  return poses;
}

BatchOptions Everything(std::mt19937_64& generator) {
  BatchOptions options;
  for (double& bound_m : options.joint_error_bounds_m) bound_m = Uniform(generator, 5e-6, 50e-6);
  options.any_direction = options.condition = options.determinant = options.joint_readings = true;
  options.characteristic_length_m = kCharacteristicLength_m;
  return options;
}

Rigid3 Turned(const GoughStewart& robot, double yaw_rad) {
  return {RotationFromVector({0, 0, yaw_rad}), robot.home.translation};
}

double InverseConditionTwo(const GoughStewart& robot, const Rigid3& pose, double length_m) {
  return 1 /
         NormalizedConditionNumbers(FullInverseJacobianOf(robot, pose), {length_m, length_m, length_m}).two;
}

void ExpectRelative(double found, double expected, double tolerance) {
  EXPECT_NEAR(found, expected, tolerance * std::abs(expected));
}

// A row of the batch, and the functions for one pose. The relative tolerance grows with the condition number,
// as the error of any inverse.
void ExpectAsAlone(const BatchErrors& batch, Eigen::Index i, const GoughStewart& robot, const Rigid3& pose,
                   const BatchOptions& options) {
  const FullInverseJacobian inverse_jacobian = FullInverseJacobianOf(robot, pose);
  const PlatformJacobian jacobian = Invert(inverse_jacobian);
  ASSERT_EQ(batch.status[static_cast<size_t>(i)], jacobian.status) << "pose " << i;
  const Vector6d readings_m = InverseKinematics(robot, pose);
  for (int k = 0; k < kLegCount; ++k) EXPECT_NEAR(batch.joint_readings_m(i, k), readings_m[k], 1e-14);
  EXPECT_NEAR(batch.determinant[i], DeterminantOf(inverse_jacobian),
              1e-14 + 1e-9 * std::abs(batch.determinant[i]));
  if (jacobian.status == PoseStatus::kSingular) {
    EXPECT_TRUE(batch.of_coordinate.row(i).array().isNaN().all());
    EXPECT_TRUE(std::isnan(batch.position_m[i]) && std::isnan(batch.rotation_rad[i]));
    EXPECT_EQ(batch.inverse_condition_two[i], 0);
    return;
  }
  const double tolerance = jacobian.status == PoseStatus::kRegular ? 1e-9 : 1e-6;
  const MaximalErrors errors = MaximalErrorsOf(jacobian, options.joint_error_bounds_m);
  for (int k = 0; k < kLegCount; ++k)
    ExpectRelative(batch.of_coordinate(i, k), errors.of_coordinate[k], tolerance);
  ExpectRelative(batch.position_m[i], errors.position_m(), tolerance);
  ExpectRelative(batch.rotation_rad[i], errors.rotation_rad(), tolerance);
  ExpectRelative(batch.inverse_condition_two[i],
                 InverseConditionTwo(robot, pose, options.characteristic_length_m), tolerance);
}

void ExpectAllAsAlone(const BatchErrors& batch, const GoughStewart& robot, const std::vector<Rigid3>& poses,
                      const BatchOptions& options) {
  ASSERT_EQ(batch.status.size(), poses.size());
  ASSERT_EQ(batch.of_coordinate.rows(), static_cast<Eigen::Index>(poses.size()));
  for (size_t i = 0; i < poses.size(); ++i)
    ExpectAsAlone(batch, static_cast<Eigen::Index>(i), robot, poses[i], options);
}

bool SameBits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::equal(a.data(), a.data() + a.size(), b.data(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool SameBits(const BatchErrors& a, const BatchErrors& b) {
  return a.status == b.status && a.careful == b.careful && SameBits(a.of_coordinate, b.of_coordinate) &&
         SameBits(a.position_m, b.position_m) && SameBits(a.rotation_rad, b.rotation_rad) &&
         SameBits(a.inverse_condition_two, b.inverse_condition_two) &&
         SameBits(a.determinant, b.determinant) && SameBits(a.joint_readings_m, b.joint_readings_m);
}

TEST(EvaluateBatch, IsWhatEachPoseGivesAlone) {
  std::mt19937_64 generator = TestGenerator();
  size_t careful = 0;
  for (int robots = 0; robots < 20; ++robots) {
    const GoughStewart robot = RandomRobot(generator);
    const std::vector<Rigid3> poses = RandomPoses(generator, robot, 203);
    const BatchOptions options = Everything(generator);
    const BatchErrors batch = EvaluateBatch(robot, poses, options);
    ExpectAllAsAlone(batch, robot, poses, options);
    careful += batch.careful;
  }
  EXPECT_EQ(careful, 0U);
}

TEST(EvaluateBatch, HoldsForRobotsWithoutStructureInAnyPose) {
  std::mt19937_64 generator = TestGenerator();
  for (int robots = 0; robots < 200; ++robots) {
    GoughStewart robot;
    for (Leg& leg : robot.legs) {
      leg.base_joint_m = UniformVector(generator, -1, 1);
      leg.platform_joint_m = UniformVector(generator, -1, 1);
    }
    std::vector<Rigid3> poses(21);
    for (Rigid3& pose : poses) pose = {UniformRotation(generator), UniformVector(generator, -1, 1)};
    BatchOptions options = Everything(generator);
    options.joint_error_bounds_m[robots % kLegCount] = 0;
    ExpectAllAsAlone(EvaluateBatch(robot, poses, options), robot, poses, options);
  }
}

TEST(EvaluateBatch, TakesAnyNumberOfPoses) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const BatchOptions options = Everything(generator);
  for (const size_t count : {0, 1, 2, 7, 8, 9, 63, 64, 65, 131}) {
    const std::vector<Rigid3> poses = RandomPoses(generator, robot, count);
    ExpectAllAsAlone(EvaluateBatch(robot, poses, options), robot, poses, options);
  }
}

TEST(EvaluateBatch, ComputesOnlyWhatIsAskedFor) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const std::vector<Rigid3> poses = RandomPoses(generator, robot, 70);
  BatchOptions options = Everything(generator);
  const BatchErrors everything = EvaluateBatch(robot, poses, options);
  options.any_direction = options.condition = options.determinant = options.joint_readings = false;
  const BatchErrors least = EvaluateBatch(robot, poses, options);
  EXPECT_TRUE(SameBits(least.of_coordinate, everything.of_coordinate));
  EXPECT_EQ(least.position_m.size() + least.rotation_rad.size() + least.inverse_condition_two.size() +
                least.determinant.size() + least.joint_readings_m.size(),
            0);
}

// Where x = y = 0 and nothing is tilted, the inverse Jacobian of a drawn hexapod has double singular values.
TEST(EvaluateBatch, IsExactWhereSymmetryMakesSingularValuesDouble) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  std::vector<Rigid3> poses;
  for (int i = 0; i < 300; ++i) {
    Rigid3 pose = Turned(robot, Uniform(generator, -1, 1));
    pose.translation.z() = Uniform(generator, 0.2, 0.5);
    poses.push_back(pose);
  }
  poses.push_back(robot.home);
  BatchOptions options = Everything(generator);
  for (const double length_m : {0.02, 0.1, 0.2, 1.0}) {
    options.characteristic_length_m = length_m;
    const BatchErrors batch = EvaluateBatch(robot, poses, options);
    ExpectAllAsAlone(batch, robot, poses, options);
    EXPECT_EQ(batch.careful, 0U);
  }
}

// Fichter's: the platform of a symmetric hexapod turned by a quarter about the vertical.
TEST(EvaluateBatch, HasTheStatusesOfInvertAtAndNearASingularPose) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  std::vector<Rigid3> poses;
  for (const double quarter_rad : {90 * kDegree_rad, -90 * kDegree_rad})
    for (double off_rad = 1; off_rad > 1e-18; off_rad /= 1.1)
      poses.push_back(Turned(robot, quarter_rad - off_rad));
  const BatchOptions options = Everything(generator);
  const BatchErrors batch = EvaluateBatch(robot, poses, options);
  ExpectAllAsAlone(batch, robot, poses, options);
  const auto count = [&](PoseStatus status) {
    return std::count(batch.status.begin(), batch.status.end(), status);
  };
  EXPECT_GT(count(PoseStatus::kRegular), 10);
  EXPECT_GT(count(PoseStatus::kNearSingular), 10);
  EXPECT_GT(count(PoseStatus::kSingular), 10);
  EXPECT_FALSE(batch.of_coordinate.array().isInf().any() || batch.position_m.array().isInf().any() ||
               batch.rotation_rad.array().isInf().any() || batch.inverse_condition_two.array().isInf().any());
}

TEST(EvaluateBatch, CallsRobotsThatAreAlwaysSingularSingular) {
  std::mt19937_64 generator = TestGenerator();
  const BatchOptions options = Everything(generator);
  GoughStewart parallel = RandomRobot(generator), point = parallel;
  for (Leg& leg : parallel.legs) leg.platform_joint_m = leg.base_joint_m;
  for (Leg& leg : point.legs) leg.platform_joint_m.setZero();
  for (const GoughStewart& robot : {parallel, point}) {
    const BatchErrors batch = EvaluateBatch(robot, {robot.home, robot.home}, options);
    EXPECT_EQ(batch.status, std::vector<PoseStatus>(2, PoseStatus::kSingular));
    EXPECT_EQ(batch.careful, 2U);
  }
}

TEST(EvaluateBatch, CallsAPoseInWhichALegHasNoLengthSingular) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0.005);
  robot.legs[3].platform_joint_m.setZero();
  const Rigid3 pose{UniformRotation(generator), robot.legs[3].base_joint_m};
  const BatchErrors batch = EvaluateBatch(robot, {robot.home, pose}, Everything(generator));
  EXPECT_EQ(batch.status[0], PoseStatus::kRegular);
  EXPECT_EQ(batch.status[1], PoseStatus::kSingular);
  EXPECT_EQ(batch.determinant[1], 0);
  EXPECT_TRUE(batch.joint_readings_m.allFinite());
}

TEST(EvaluateBatch, HasTheSameResultsOnEveryInstructionSet) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const std::vector<Rigid3> poses = RandomPoses(generator, robot, 2000, 0.3);
  BatchOptions options = Everything(generator);
  options.instruction_set = InstructionSet::kBaseline;
  const BatchErrors baseline = EvaluateBatch(robot, poses, options);
  for (const InstructionSet set : AvailableInstructionSets()) {
    std::cout << ToString(set) << std::endl;
    options.instruction_set = set;
    const BatchErrors batch = EvaluateBatch(robot, poses, options);
    const auto largest_difference = [](const auto& a, const auto& b) {
      return ((a - b).array() / b.array()).abs().maxCoeff();
    };
    EXPECT_EQ(batch.status, baseline.status);
    EXPECT_LT(largest_difference(batch.of_coordinate, baseline.of_coordinate), 1e-12);
    EXPECT_LT(largest_difference(batch.position_m, baseline.position_m), 1e-12);
    EXPECT_LT(largest_difference(batch.rotation_rad, baseline.rotation_rad), 1e-12);
    EXPECT_LT(largest_difference(batch.inverse_condition_two, baseline.inverse_condition_two), 1e-12);
    EXPECT_LT(largest_difference(batch.determinant, baseline.determinant), 1e-12);
    EXPECT_LT(largest_difference(batch.joint_readings_m, baseline.joint_readings_m), 1e-12);
  }
}

TEST(EvaluateBatch, HasTheSameBitsOnAnyNumberOfThreads) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  std::vector<Rigid3> poses = RandomPoses(generator, robot, 5003);
  poses[7] = Turned(robot, 90 * kDegree_rad);
  poses[4000] = Turned(robot, 90.01 * kDegree_rad);
  BatchOptions options = Everything(generator);
  const BatchErrors one = EvaluateBatch(robot, poses, options);
  EXPECT_EQ(one.status[7], PoseStatus::kSingular);
  EXPECT_GE(one.careful, 2U);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    EXPECT_TRUE(SameBits(one, EvaluateBatch(robot, poses, options))) << threads << " threads";
  }
}

TEST(EvaluateBatch, RefusesOptionsRobotsAndPosesThatMakeNoSense) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = RandomRobot(generator);
  const BatchOptions sound = Everything(generator);
  const auto expect_refused = [&](const auto& spoil) {
    BatchOptions options = sound;
    spoil(options);
    EXPECT_THROW(options.Check(), std::invalid_argument);
    EXPECT_THROW(EvaluateBatch(robot, {robot.home}, options), std::invalid_argument);
  };
  expect_refused([](BatchOptions& options) { options.joint_error_bounds_m[2] = -1e-9; });
  expect_refused([](BatchOptions& options) { options.joint_error_bounds_m[0] = std::nan(""); });
  expect_refused([](BatchOptions& options) { options.joint_error_bounds_m[5] = INFINITY; });
  expect_refused([](BatchOptions& options) { options.characteristic_length_m = 0; });
  expect_refused([](BatchOptions& options) { options.characteristic_length_m = std::nan(""); });
  expect_refused([](BatchOptions& options) { options.threads = 0; });
  expect_refused([](BatchOptions& options) { options.instruction_set = static_cast<InstructionSet>(9); });
  GoughStewart broken = robot;
  broken.legs[1].base_joint_m.x() = std::nan("");
  EXPECT_THROW(EvaluateBatch(broken, {robot.home}, sound), std::invalid_argument);
  for (const double bad : {double{NAN}, double{INFINITY}}) {
    Rigid3 pose = robot.home;
    pose.translation.y() = bad;
    EXPECT_THROW(EvaluateBatch(robot, {robot.home, pose}, sound), std::invalid_argument);
    pose = robot.home;
    pose.rotation.x() = bad;
    EXPECT_THROW(EvaluateBatch(robot, {pose}, sound), std::invalid_argument);
  }
}

}  // namespace
}  // namespace legible
