#include "core/robots/straight_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

struct Way {
  ParallelRobot robot;
  Rigid3 from, to;
};

Way RandomRpsWay(std::mt19937_64& generator, const std::vector<std::string>& chains, double displacement) {
  const RobotAtPose random = RandomSpatialRobot(generator, chains);
  return {random.robot, random.pose, RandomPoseNear(generator, random.robot, random.pose, displacement)};
}

TEST(StraightPath, OfARobotWithoutRpsLegsMovesOnALineAndAboutOneAxis) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
    const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 1);
    const auto poses = StraightPath(random.robot, random.pose, to).Poses(11).value();
    ASSERT_EQ(poses.size(), 11);
    for (size_t i = 0; i < poses.size(); ++i) {
      const Rigid3 expected =
          Displaced(random.pose, static_cast<double>(i) / 10 * Displacement(random.pose, to));
      EXPECT_LT(Displacement(expected, poses[i]).norm(), 1e-12);
    }
  }
}

// From the start to the goal through poses that the R joints allow, with no jump between them.
TEST(StraightPath, OfRpsLegsKeepsThePlatformJointsInTheirPlanes) {
  std::mt19937_64 generator = TestGenerator();
  int arrived = 0;
  for (int n = 0; n < 100; ++n)
    for (const auto& chains : {std::vector<std::string>{"R_PS", "R_PS", "_RPS"},
                               {"R_PS", "U_PS", "_PUS", "R_PS"},
                               {"R_PS", "R_PS", "R_PS", "R_PS"}}) {
      const Way way = RandomRpsWay(generator, chains, 0.1);
      const auto poses = StraightPath(way.robot, way.from, way.to).Poses(201);
      if (!poses) continue;
      EXPECT_LT(Displacement(poses->front(), way.from).norm(), 1e-12);
      double longest_step = 0;
      for (size_t i = 0; i < poses->size(); ++i) {
        for (const RobotLeg& leg : way.robot.legs) {
          if (leg.chain[0].type != JointType::kRevolute) continue;
          const Eigen::Vector3d c = (*poses)[i] * leg.platform_joint_m;
          EXPECT_LT(std::abs(leg.first_axis.dot(c - leg.base_joint_m)), 1e-12);
        }
        if (i > 0) longest_step = std::max(longest_step, Displacement((*poses)[i - 1], (*poses)[i]).norm());
      }
      EXPECT_LT(longest_step, 0.1);
      EXPECT_LT(Displacement(poses->back(), way.to).norm(), 1e-7);
      ++arrived;
    }
  std::cout << arrived << " of 300 arrive\n";
  EXPECT_GT(arrived, 270);
}

// Halfway the straight pose is off the planes by the second order of the way, and so is the correction.
TEST(StraightPath, OfRpsLegsLeavesTheStraightOneInSecondOrder) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const Way way = RandomRpsWay(generator, {"R_PS", "R_PS", "R_PS"}, 0.1);
    const Vector6d twist = Displacement(way.from, way.to);
    const auto off = [&](double part) {
      const Rigid3 to = BackToMotion(way.robot, Displaced(way.from, part * twist));
      const Rigid3 middle = StraightPath(way.robot, way.from, to).Poses(3).value()[1];
      return Displacement(Displaced(way.from, Displacement(way.from, to) / 2), middle).norm();
    };
    EXPECT_GT(off(1e-3), 0);
    EXPECT_NEAR(off(1e-3) / off(1e-4), 100, 10);
  }
}

TEST(StraightPath, DistancesMoveWithTheCorrectionAsByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const Way way = RandomRpsWay(generator, {"R_PS", "R_PS", "R_PS"}, 0.3);
    const StraightPath path(way.robot, way.from, way.to);
    const double s = Uniform(generator, 0, 1);
    const Eigen::Vector3d c = UniformVector(generator, -0.5, 0.5);
    const auto distances_m = [&](const Eigen::Vector3d& at) -> Eigen::Vector3d {
      return path.Distances_m(path.PoseAt<double>(s, at));
    };
    const Eigen::MatrixXd found = path.DistancesByCorrection<double>(
        Eigen::VectorXd(c), path.SidewaysLines(path.PoseAt<double>(s, Eigen::VectorXd(c))));
    EXPECT_TRUE(AreNear(found, NumericJacobian(distances_m, c, 1e-4), 1e-8));
    const auto exact = [&](const auto& at) {
      using T = typename std::decay_t<decltype(at)>::Scalar;
      const StraightPath::Vector<T> any = at;
      Eigen::Matrix<T, 3, 1> distances = path.Distances_m(path.PoseAt<T>(T(s), any));
      return distances;
    };
    EXPECT_TRUE(AreNear(found, JetJacobian(exact, c), 1e-12));
    const Eigen::Matrix3d rotation = path.PoseAt<double>(s, Eigen::VectorXd(c)).rotation;
    EXPECT_TRUE(AreNear(rotation * rotation.transpose(), Eigen::Matrix3d::Identity(), 1e-13));
    EXPECT_NEAR(rotation.determinant(), 1, 1e-13);
  }
}

TEST(StraightPath, IsNothingWhereRpsLegsLetItNotGoOn) {
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS"});
  // One platform joint cannot be in two planes side by side.
  random.robot.legs[1] = random.robot.legs[0];
  random.robot.legs[1].base_joint_m += 0.1 * random.robot.legs[0].first_axis;
  EXPECT_FALSE(StraightPath(random.robot, random.pose, random.pose).Poses(3).has_value());
}

}  // namespace
}  // namespace legible
