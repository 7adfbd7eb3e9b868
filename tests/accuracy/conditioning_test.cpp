#include "accuracy/conditioning.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "accuracy/three_point.h"
#include "tests/accuracy/random_hexapod.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

GoughStewart Scaled(GoughStewart robot, double factor) {
  for (Leg& leg : robot.legs) leg.base_joint_m *= factor, leg.platform_joint_m *= factor;
  return robot;
}

TEST(ConditionNumbers, OfADiagonalMatrixAreTheClosedForms) {
  const Eigen::Vector3d d(1, 2, 4);
  const ConditionNumbers found = ConditionNumbersOf(d.asDiagonal());
  EXPECT_NEAR(found.two, 4, 1e-14);
  EXPECT_NEAR(found.infinity, 4, 1e-14);
  EXPECT_NEAR(found.frobenius, std::sqrt(21 * (1 + 1.0 / 4 + 1.0 / 16)), 1e-13);
  EXPECT_NEAR(found.frobenius_of_gram, std::sqrt((1 + 16 + 256) * (1 + 1.0 / 16 + 1.0 / 256)), 1e-12);
}

TEST(ConditionNumbers, OfARotationAreTheirLeastValues) {
  std::mt19937_64 generator = TestGenerator();
  const ConditionNumbers found = ConditionNumbersOf(UniformRotation(generator).toRotationMatrix());
  EXPECT_NEAR(found.two, 1, 1e-14);
  EXPECT_NEAR(found.frobenius, 3, 1e-14);  // the rows' number, not 1 as the paper says
  EXPECT_NEAR(found.frobenius_of_gram, 3, 1e-14);
}

TEST(ConditionNumbers, AreInfiniteWithoutFullRank) {
  Eigen::Matrix3d singular = Eigen::Matrix3d::Identity();
  singular.row(2) = singular.row(1);
  EXPECT_EQ(ConditionNumbersOf(singular).two, std::numeric_limits<double>::infinity());
  EXPECT_THROW(ConditionNumbersOf(Eigen::MatrixXd::Ones(3, 2)), std::invalid_argument);
}

TEST(NaturalLength, NoOtherLengthGivesASmallerConditionNumber) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const HexapodAtPose drawn = RandomHexapod(generator);
    const FullInverseJacobian jacobian = FullInverseJacobianOf(drawn.robot, drawn.pose);
    const CharacteristicLengths natural = NaturalLengths(jacobian);
    const ConditionNumbers least = NormalizedConditionNumbers(jacobian, natural);
    for (double length_m = 1e-3; length_m < 30; length_m *= 1.05) {
      const ConditionNumbers other = NormalizedConditionNumbers(jacobian, {length_m, length_m, length_m});
      EXPECT_LE(least.two, other.two * (1 + 1e-12));
      EXPECT_LE(least.frobenius, other.frobenius * (1 + 1e-12));
      EXPECT_LE(least.infinity, other.infinity * (1 + 1e-12));
    }
  }
}

// --- What a change of the length unit changes, and what it does not.

TEST(LengthUnit, ChangesTheDeterminantByItsCubeAndTheManipulabilityByItsInverseCube) {
  std::mt19937_64 generator = TestGenerator();
  const HexapodAtPose drawn = RandomHexapod(generator);
  const FullInverseJacobian metres = FullInverseJacobianOf(drawn.robot, drawn.pose);
  const FullInverseJacobian millimetres = InLengthUnit(metres, 1e-3);
  EXPECT_NEAR(DeterminantOf(millimetres) / DeterminantOf(metres), 1e9, 1e-2);
  EXPECT_NEAR(ManipulabilityOf(millimetres) / ManipulabilityOf(metres), 1e-9, 1e-20);
}

TEST(LengthUnit, OfTheMatrixIsThatOfARobotWhoseLengthsAreWrittenInIt) {
  std::mt19937_64 generator = TestGenerator();
  const HexapodAtPose drawn = RandomHexapod(generator);
  const Rigid3 pose_mm{drawn.pose.rotation, 1e3 * drawn.pose.translation};
  EXPECT_TRUE(AreNear(InLengthUnit(FullInverseJacobianOf(drawn.robot, drawn.pose), 1e-3).matrix,
                      InverseJacobian(Scaled(drawn.robot, 1e3), pose_mm), 1e-9));
}

TEST(LengthUnit, ChangesPlainConditionNumbersButNoNormalisedAndNoThreePointOnes) {
  std::mt19937_64 generator = TestGenerator();
  const HexapodAtPose drawn = RandomHexapod(generator);
  const FullInverseJacobian metres = FullInverseJacobianOf(drawn.robot, drawn.pose);
  const FullInverseJacobian millimetres = InLengthUnit(metres, 1e-3);
  EXPECT_GT(ConditionNumbersOf(millimetres.matrix).two, 2 * ConditionNumbersOf(metres.matrix).two);
  EXPECT_GT(ConditionNumbersOf(millimetres.matrix).frobenius,
            2 * ConditionNumbersOf(metres.matrix).frobenius);

  const ConditionNumbers given_m = NormalizedConditionNumbers(metres, {0.3, 0.3, 0.3});
  const ConditionNumbers given_mm = NormalizedConditionNumbers(millimetres, {300, 300, 300});
  const ConditionNumbers natural_m = NormalizedConditionNumbers(metres, NaturalLengths(metres));
  const ConditionNumbers natural_mm = NormalizedConditionNumbers(millimetres, NaturalLengths(millimetres));
  for (const auto norm : {&ConditionNumbers::two, &ConditionNumbers::frobenius, &ConditionNumbers::infinity,
                          &ConditionNumbers::frobenius_of_gram}) {
    EXPECT_NEAR(given_mm.*norm / given_m.*norm, 1, 1e-10);
    EXPECT_NEAR(natural_mm.*norm / natural_m.*norm, 1, 1e-7);
  }
  const Rigid3 pose_mm{drawn.pose.rotation, 1e3 * drawn.pose.translation};
  const ThreePointConditions in_m = ThreePointConditionsOf(drawn.robot, drawn.pose);
  const ThreePointConditions in_mm = ThreePointConditionsOf(Scaled(drawn.robot, 1e3), pose_mm);
  EXPECT_NEAR(in_mm.two.largest / in_m.two.largest, 1, 1e-9);
  EXPECT_NEAR(in_mm.frobenius_of_gram.least / in_m.frobenius_of_gram.least, 1, 1e-9);
}

TEST(Frames, ChangeNoIndexOfARobotThatIsDescribedInAnotherBaseFrame) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const HexapodAtPose here = RandomHexapod(generator), there = InAnotherBase(here, generator);
    const auto jacobian_here = FullInverseJacobianOf(here.robot, here.pose);
    const auto jacobian_there = FullInverseJacobianOf(there.robot, there.pose);
    const ConditionNumbers of_here = ConditionNumbersOf(jacobian_here.matrix);
    const ConditionNumbers of_there = ConditionNumbersOf(jacobian_there.matrix);
    EXPECT_NEAR(of_there.two / of_here.two, 1, 1e-9);
    EXPECT_NEAR(of_there.frobenius / of_here.frobenius, 1, 1e-9);
    EXPECT_NEAR(std::abs(DeterminantOf(jacobian_there) / DeterminantOf(jacobian_here)), 1, 1e-9);
    EXPECT_NEAR(ThreePointConditionsOf(there.robot, there.pose).two.largest /
                    ThreePointConditionsOf(here.robot, here.pose).two.largest,
                1, 1e-8);
  }
}

// --- Three points.

TEST(ThreePointJacobian, GivesTheLegSpeedsOfEveryRigidMotionAlsoOfPlatformsThatAreNotFlat) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const HexapodAtPose drawn = RandomHexapod(generator);  // its joints lie up to 5 mm off their plane
    Vector6d twist;
    twist << UniformVector(generator, -1, 1), UniformVector(generator, -1, 1);
    Eigen::Matrix<double, 9, 1> velocities;
    const std::array<int, 3> triplet = {0, 2, 5};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d arm =
          drawn.pose.rotation *
          drawn.robot.legs[static_cast<size_t>(triplet[static_cast<size_t>(k)])].platform_joint_m;
      velocities.segment<3>(3 * k) = twist.head<3>() + twist.tail<3>().cross(arm);
    }
    EXPECT_TRUE(AreNear(ThreePointJacobian(drawn.robot, drawn.pose, triplet) * velocities,
                        InverseJacobian(drawn.robot, drawn.pose) * twist, 1e-12));
  }
}

TEST(ThreePointJacobian, RefusesThreePointsOnALine) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0);
  robot.legs[2].platform_joint_m = (robot.legs[0].platform_joint_m + robot.legs[1].platform_joint_m) / 2;
  EXPECT_THROW(ThreePointJacobian(robot, robot.home, {0, 1, 2}), std::invalid_argument);
  EXPECT_EQ(ThreePointConditionsOf(robot, robot.home).triplets, 19);
}

}  // namespace
}  // namespace legible
