#include "accuracy/workspace_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/pose_accuracy.h"
#include "tests/accuracy/merlet_robot.h"
#include "tests/accuracy/upu_robots.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

WorkspaceErrorOptions OptionsFor(int joints) {
  WorkspaceErrorOptions options;
  options.joint_error_bounds = Eigen::VectorXd::Constant(joints, 1e-4);
  options.characteristic_length_m = 0.2;
  options.pose_of_point = [](const Eigen::Ref<const Eigen::VectorXd>& point) {
    return Rigid3{RotationFromVector(point.tail<3>()), point.head<3>()};
  };
  return options;
}

bool IsReachable(const Mechanism& mechanism, const Eigen::Vector3d& place_m) {
  const Rigid3 pose{Eigen::Quaterniond::Identity(), place_m};
  const bool is_above_base = place_m.z() > 0;  // as home is; below lies the other assembly
  return is_above_base && JointsOutOfRange(mechanism, JointReadingsOf(mechanism, pose)).empty();
}

// How far the platform gets along a direction, by a random walk from home that only goes on where it is
// reachable.
double FarthestSeen(const Mechanism& mechanism, const Eigen::Vector3d& direction,
                    std::mt19937_64& generator) {
  Eigen::Vector3d place = HomeOf(mechanism).translation;
  for (int i = 0; i < 60000; ++i) {
    const double step_m = 0.1 * std::pow(10, Uniform(generator, -4, 0));
    const Eigen::Vector3d next = place + step_m * UniformVector(generator, -1, 1);
    if (direction.dot(next - place) >= 0 && IsReachable(mechanism, next)) place = next;
  }
  return direction.dot(place);
}

// Of both mechanisms: every reachable place on home's side lies in the ranges, and each of the six sides is
// nearly touched by one.
TEST(ReachableRanges, HoldWhatTheJointRangesAllowAndLittleMore) {
  std::mt19937_64 generator = TestGenerator();
  for (const Mechanism& mechanism : {Mechanism(MerletRobot()), Mechanism(TsaiUpu())}) {
    const auto ranges = ReachableRanges(mechanism, HomeOf(mechanism));
    ASSERT_TRUE(ranges);
    for (int axis = 0; axis < 3; ++axis) {
      const double highest_m = FarthestSeen(mechanism, Eigen::Vector3d::Unit(axis), generator);
      const double lowest_m = -FarthestSeen(mechanism, -Eigen::Vector3d::Unit(axis), generator);
      EXPECT_LE(highest_m, (*ranges)(axis, 1));
      EXPECT_GE(lowest_m, (*ranges)(axis, 0));
      EXPECT_LE((*ranges)(axis, 1) - (*ranges)(axis, 0), 1.4 * (highest_m - lowest_m)) << "axis " << axis;
    }
  }
}

TEST(ReachableRanges, HoldAllOrientationsWithinATurn) {
  std::mt19937_64 generator = TestGenerator();
  const Mechanism mechanism = MerletRobot();
  constexpr double kTurn_rad = 0.4;
  const auto ranges = ReachableRanges(mechanism, HomeOf(mechanism), kTurn_rad);
  ASSERT_TRUE(ranges);
  int reached = 0;
  for (int i = 0; i < 200000; ++i) {
    const Eigen::Vector3d turn =
        Uniform(generator, 0, kTurn_rad) * UniformVector(generator, -1, 1).normalized();
    const Rigid3 pose{
        RotationFromVector(turn),
        {Uniform(generator, -0.5, 0.5), Uniform(generator, -0.5, 0.5), Uniform(generator, 0.2, 0.7)}};
    if (!JointsOutOfRange(mechanism, JointReadingsOf(mechanism, pose)).empty()) continue;
    ++reached;
    EXPECT_TRUE((pose.translation.array() >= ranges->col(0).array()).all() &&
                (pose.translation.array() <= ranges->col(1).array()).all());
  }
  EXPECT_GT(reached, 100);
}

TEST(ReachableRanges, AreNoneWhereNoPlaceSuitsAllLegs) {
  GoughStewart robot = MerletRobot();
  robot.legs[0].joint_range_m = {5, 6};
  EXPECT_FALSE(ReachableRanges(robot, robot.home));
}

TEST(ErrorEvaluator, GivesWhatEachPoseBySelfGives) {
  std::mt19937_64 generator = TestGenerator();
  for (const Mechanism& mechanism : {Mechanism(MerletRobot()), Mechanism(TsaiUpu())}) {
    const WorkspaceErrorOptions options = OptionsFor(JointCountOf(mechanism));
    Eigen::MatrixXd points = Eigen::MatrixXd::Zero(6, 20);
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      points.col(i).head<3>() = HomeOf(mechanism).translation + UniformVector(generator, -0.05, 0.05);
    const BatchValues batch = ErrorEvaluator(mechanism, options)(points);
    PoseAccuracyOptions pose_options;
    pose_options.joint_error_bounds = options.joint_error_bounds;
    pose_options.characteristic_length_m = options.characteristic_length_m;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      ASSERT_EQ(batch.states[static_cast<size_t>(i)], PointState::kInside);
      const PoseAccuracy one =
          QuickAccuracyAt({mechanism, {}, {}, {}}, options.pose_of_point(points.col(i)), pose_options);
      EXPECT_TRUE(AreNear(batch.values.col(i).head<6>(), one.max_error->of_coordinate, 1e-12));
      EXPECT_NEAR(batch.values(kPositionRow, i), one.max_error->position_m(), 1e-12);
      EXPECT_NEAR(batch.values(kRotationRow, i), one.max_error->rotation_rad(), 1e-12);
      EXPECT_NEAR(batch.values(kInverseConditionRow, i) * one.indices->normalized.two, 1, 1e-9);
      EXPECT_NEAR(batch.values(kDeterminantRow, i) / one.indices->determinant, 1, 1e-9);
    }
  }
}

TEST(ErrorEvaluator, LeavesOutWhatIsBeyondJointRangesOrAnotherAspect) {
  const Mechanism mechanism = MerletRobot();
  WorkspaceErrorOptions options = OptionsFor(6);
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(6, 3);
  points.row(2).setConstant(0.53);
  points(2, 1) = 0.9;  // out of reach
  points(5, 2) = 2.5;  // turned past the singularity
  const auto states = [&] { return ErrorEvaluator(mechanism, options)(points).states; };
  EXPECT_EQ(states(), std::vector<PointState>(3, PointState::kInside));
  options.within_joint_ranges = true;
  EXPECT_EQ(states()[1], PointState::kOutside);
  options.within_joint_ranges = false;
  options.in_aspect_of_home = true;
  EXPECT_EQ(states()[2], PointState::kOutside);
  EXPECT_EQ(states()[0], PointState::kInside);
}

TEST(ErrorEvaluator, APoseThatA3UpuCannotTakeIsOutside) {
  WorkspaceErrorOptions options = OptionsFor(3);
  Eigen::MatrixXd points(6, 2);
  points << 0, 0, 0, 0, 0.4, 0.4, 0, 0.1, 0, 0, 0, 0;
  const BatchValues batch = ErrorEvaluator(TsaiUpu(), options)(points);
  EXPECT_EQ(batch.states[0], PointState::kInside);
  EXPECT_EQ(batch.states[1], PointState::kOutside);
  EXPECT_EQ(ErrorEvaluator(SeoulUpu(), options)(points).states[0], PointState::kSingular);
}

}  // namespace
}  // namespace legible
