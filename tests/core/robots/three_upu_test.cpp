#include "core/robots/three_upu.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/accuracy/upu_robots.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

// The six constraint equations of the platform displaced by (t, w) from a translation: leg lengths, and that
// both inner axes of each leg, across the leg and across the outer axis in the base and in the platform, stay
// parallel:
// ((u x n) x (R u x n)).n = n.(u x R u) = 0. Nothing of the Jacobian's formula is in here.
Vector6d Constraints(const ThreeUpu& robot, const Eigen::Vector3d& translation_m,
                     const Vector6d& displacement) {
  const Rigid3 pose = Displaced({Eigen::Quaterniond::Identity(), translation_m}, displacement);
  Vector6d values;
  for (int i = 0; i < kUpuLegCount; ++i) {
    const UpuLeg& leg = robot.legs[static_cast<size_t>(i)];
    const Eigen::Vector3d along = pose * leg.platform_joint_m - leg.base_joint_m;
    const Eigen::Vector3d platform_axis = pose.rotation * leg.outer_axis;
    const Eigen::Vector3d n = along.normalized();
    values[i] = along.norm();
    values[3 + i] = leg.outer_axis.cross(n).cross(platform_axis.cross(n)).dot(n);
  }
  return values;
}

// Outer axes in random directions: s1.(s2 x s3) is not 0.
ThreeUpu RandomUpu(std::mt19937_64& generator) {
  ThreeUpu robot = SymmetricUpu(0.9);
  for (UpuLeg& leg : robot.legs) {
    leg.base_joint_m += UniformVector(generator, -0.02, 0.02);
    leg.platform_joint_m += UniformVector(generator, -0.02, 0.02);
    leg.outer_axis = (leg.outer_axis + UniformVector(generator, -0.3, 0.3)).normalized();
    leg.joint_offset_m = Uniform(generator, -0.01, 0.01);
  }
  return robot;
}

TEST(ThreeUpuJacobian, RowsAreThoseOfTheConstraintEquationsByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const ThreeUpu robot = RandomUpu(generator);
    const Eigen::Vector3d at = robot.home.translation + UniformVector(generator, -0.1, 0.1);
    const auto constraints = [&](const Vector6d& displacement) {
      return Constraints(robot, at, displacement);
    };
    const Matrix6d numeric = NumericJacobian(constraints, Vector6d::Zero().eval());
    const auto found = FullInverseJacobianOf(robot, at);
    EXPECT_TRUE(AreNear(found.matrix.topRows(3), numeric.topRows<3>(), 1e-9));
    for (int i = 3; i < 6; ++i) {  // s is a unit vector of either sign
      EXPECT_LT(numeric.row(i).head<3>().norm(), 1e-9);
      const Eigen::Vector3d s = found.matrix.row(i).tail<3>(), by_differences = numeric.row(i).tail<3>();
      EXPECT_NEAR(s.norm(), 1, 1e-14);
      EXPECT_NEAR(std::abs(s.dot(by_differences)) / by_differences.norm(), 1, 1e-9);
    }
  }
}

TEST(ThreeUpuJacobian, LegErrorsMoveThePlatformAsTheConstraintEquationsSay) {
  std::mt19937_64 generator = TestGenerator();
  const ThreeUpu robot = RandomUpu(generator);
  const Eigen::Vector3d at = robot.home.translation + UniformVector(generator, -0.1, 0.1);
  const Eigen::Vector3d leg_errors_m = UniformVector(generator, -1e-4, 1e-4);
  const auto constraints = [&](const Vector6d& displacement) { return Constraints(robot, at, displacement); };
  Vector6d target = constraints(Vector6d::Zero());
  target.head<3>() += leg_errors_m;
  Vector6d displacement = Vector6d::Zero();
  for (int step = 0; step < 8; ++step)
    displacement +=
        NumericJacobian(constraints, displacement).partialPivLu().solve(target - constraints(displacement));
  ASSERT_LT((constraints(displacement) - target).norm(), 1e-14);
  Vector6d joint_errors;
  joint_errors << leg_errors_m, 0, 0, 0;
  const Vector6d linear = FullInverseJacobianOf(robot, at).matrix.inverse() * joint_errors;
  EXPECT_TRUE(AreNear(linear, displacement, 1e-3 * displacement.norm()));
  EXPECT_LT(displacement.tail<3>().norm(), 1e-12);  // a 3-UPU's leg lengths do not turn it
}

TEST(ThreeUpu, ReadingsAreLegLengthsLessOffsets) {
  ThreeUpu robot = SeoulUpu();
  robot.legs[1].joint_offset_m = 0.05;
  const double length_m = std::hypot(0.1, 0.4);
  EXPECT_TRUE(AreNear(InverseKinematics(robot, robot.home.translation),
                      Eigen::Vector3d(length_m, length_m - 0.05, length_m), 1e-15));
}

TEST(ThreeUpuJacobian, ALegAlongItsOuterAxisLeavesItsMomentOpen) {
  ThreeUpu robot = SeoulUpu();
  robot.legs[0].outer_axis =
      (robot.home.translation + robot.legs[0].platform_joint_m - robot.legs[0].base_joint_m).normalized();
  EXPECT_EQ(FullInverseJacobianOf(robot, robot.home.translation).matrix.row(3).norm(), 0);
}

}  // namespace
}  // namespace legible
