#include "core/robots/study_quadrics.h"

#include <gtest/gtest.h>

#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Vector8 = Eigen::Matrix<double, 8, 1>;

Rigid3 RandomMotion(std::mt19937_64& generator) {
  return {UniformRotation(generator), UniformVector(generator, -2, 2)};
}

TEST(StudyCoordinates, LieOnStudysQuadricAndAreOfTheMotion) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    const Rigid3 motion = RandomMotion(generator);
    const Vector8 v = StudyCoordinates(motion);
    EXPECT_NEAR(v.head<4>().norm(), 1, 1e-14);
    EXPECT_NEAR(v.head<4>().dot(v.tail<4>()), 0, 1e-14);
    const Rigid3 again = MotionOf(Uniform(generator, -3, -1) * v);  // every multiple is the same motion
    EXPECT_LT(Displacement(motion, again).norm(), 1e-13);
  }
}

TEST(QuadricOf, IsTheConditionTimesTheSquareOfX) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    const Rigid3 motion = RandomMotion(generator);
    const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
    const Eigen::Vector3d t = motion.translation;
    MotionCondition<double> condition;
    condition.constant = Uniform(generator, -1, 1);
    condition.by_translation = UniformVector(generator, -1, 1);
    condition.by_turned_translation = UniformVector(generator, -1, 1);
    for (double& coefficient : condition.by_rotation.reshaped()) coefficient = Uniform(generator, -1, 1);
    const double expected = t.squaredNorm() + condition.constant + condition.by_translation.dot(t) +
                            condition.by_turned_translation.dot(rotation.transpose() * t) +
                            condition.by_rotation.cwiseProduct(rotation).sum();
    const Vector8 v = 2 * StudyCoordinates(motion);  // |x|^2 = 4
    const Eigen::Matrix<double, 8, 8> quadric = QuadricOf(condition);
    EXPECT_TRUE(AreNear(quadric, quadric.transpose(), 0));
    EXPECT_NEAR(v.dot(quadric * v), 4 * expected, 1e-12);
  }
}

TEST(LegCondition, VanishesAtTheLegsLength) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    const Rigid3 motion = RandomMotion(generator);
    const Eigen::Vector3d a = UniformVector(generator, -1, 1), b = UniformVector(generator, -1, 1);
    const double length = (motion * b - a).norm(), other = length + 0.1;
    const Vector8 v = StudyCoordinates(motion);
    EXPECT_NEAR(v.dot(QuadricOf(LegCondition<double>(a, b, length)) * v), 0, 1e-13);
    EXPECT_NEAR(v.dot(QuadricOf(LegCondition<double>(a, b, other)) * v), length * length - other * other,
                1e-12);
  }
}

}  // namespace
}  // namespace legible
